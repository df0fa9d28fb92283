// SPDX-License-Identifier: GPL-2.0-or-later
/* The time scale that bounds the time step: the shortest half period of any contact that can occur (vielto_law.h),
   with the settings of the pair_style line; of the law in use (law.h). LIGGGHTS' own
   check/timestep/gran is made for Hertzian contacts. */
#ifndef VIELTO_CRITICAL_TIME_H
#define VIELTO_CRITICAL_TIME_H

namespace LAMMPS_NS {
class LAMMPS;
}

namespace vielto {

// Of grains of one radius (m) and density (kg/m3) and of any two types, on each other and on walls, s.
double shortest_half_period_of(LAMMPS_NS::LAMMPS* lmp, double radius, double density);

// Of the grains that are there, s; 0 if there are none. Collective.
double shortest_half_period_now(LAMMPS_NS::LAMMPS* lmp);

/* Warns at the beginning of a run of any script, when its time step is over a tenth of that time: a contact then gains
   energy or passes in one step, and the grain is gone without a word. The rigs' own limit is half of it. */
class TimeStepWatch {
 public:
  void look(LAMMPS_NS::LAMMPS* lmp);  // once a step; collective at the first of a run

 private:
  long long run_ = -1;
  bool said_ = false;
};

}  // namespace vielto

#endif

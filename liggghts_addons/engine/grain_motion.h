// SPDX-License-Identifier: GPL-2.0-or-later
/* `fix nve/sphere` and `fix gravity` for several grains at once in vector registers (packed_law.h), behind LIGGGHTS'
   own names. The same numbers to the last bit. They fall back to LIGGGHTS' own where dipoles, added mass, clumps or a
   variable gravity are asked for, and with VIELTO_LANES=1. */
#ifndef LMP_VIELTO_GRAIN_MOTION_H
#define LMP_VIELTO_GRAIN_MOTION_H

#include "engine/packed_law.h"
#include "fix_gravity.h"
#include "fix_nve_sphere.h"

namespace LAMMPS_NS {

class FixViEltoIntegrate : public FixNVESphere {
 public:
  FixViEltoIntegrate(class LAMMPS*, int, char**);
  void initial_integrate(int) override;
  void final_integrate() override;

 private:
  bool plain() const;
  vielto::GrainMotion motion() const;

  const vielto::PackedLaw* packed_;
};

class FixViEltoGravity : public FixGravity {
 public:
  FixViEltoGravity(class LAMMPS*, int, char**);
  void post_force(int) override;
  double compute_scalar() override;

 private:
  const vielto::PackedLaw* packed_;
  bool owed_ = false;  // the energy of this step has not been summed
};

}  // namespace LAMMPS_NS

#endif

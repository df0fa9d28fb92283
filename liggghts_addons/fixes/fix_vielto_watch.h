// SPDX-License-Identifier: GPL-2.0-or-later
/* Stops the run when a grain is lost, or its place or velocity is no number any more, and tells which, where it was,
   how fast and the likely cause. LIGGGHTS' own line tells the number of grains only, and only where the log has a row.

     fix ID all vielto/watch every N      looks at every N-th step, and at the start of a run

   Grains are expected to stay: make the fix after they have been inserted. */
#ifdef FIX_CLASS
FixStyle(vielto / watch, FixViEltoWatch)
#else
#ifndef LMP_FIX_VIELTO_WATCH_H
#define LMP_FIX_VIELTO_WATCH_H

#include <map>
#include <string>

#include "fix.h"

namespace vielto {

// The grains of one look, to be compared with those of the next. Collective over all ranks.
class GrainWatch : protected LAMMPS_NS::Pointers {
 public:
  explicit GrainWatch(LAMMPS_NS::LAMMPS* program) : Pointers(program) {}
  // Stops the run if a grain of the last look is gone, or is nowhere; `when` stands in brackets behind the step.
  void look(const std::string& when);
  LAMMPS_NS::bigint grains() const { return grains_; }  // of the last look; -1 before the first

 private:
  struct Place {
    double x[3], v[3], radius;
  };
  void stop(LAMMPS_NS::bigint now, const std::string& when);
  void stop_if_nowhere(const std::string& when);
  void stop_for(int tag, const std::string& what, const std::string& when);
  std::map<int, Place> places_;  // this processor's grains
  LAMMPS_NS::bigint grains_ = -1;
};

}  // namespace vielto

namespace LAMMPS_NS {

class FixViEltoWatch : public Fix {
 public:
  FixViEltoWatch(class LAMMPS*, int, char**);
  int setmask() override;
  void setup(int) override;
  void end_of_step() override;

 private:
  vielto::GrainWatch watch_;
};

}  // namespace LAMMPS_NS
#endif
#endif

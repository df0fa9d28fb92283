// SPDX-License-Identifier: GPL-2.0-or-later
/* Records torque and force of the parts of a rotating machine, and stops the run when its numbers cannot be trusted.

     fix ID all vielto/record every N file F speed n part NAME MESHFIX... [part ...] [keywords]
       every, file, part, standing, dtLimit, header   see record_base.h
       speed n               1/s; the rotation starts when this fix is made. A mesh of a part that moves otherwise
                             than at n about `axis` stops the run, and so does a standing one that moves. One that
                             is no standing part and does not move is named in a warning.
       axis x y z            axis of rotation through `origin`, default 1 0 0
       origin x y z          default 0 0 0
       each NAME             one torque column more for each mesh of that part (NAME without its s, numbered)
       idle T NOISE SEED     torque of the idling model, N m, and the relative standard deviation of its noise per row
       maxTorque T           stop when a part's torque in any step exceeds T, N m; default 0: no limit
       energy on|off         energy accounts (columns work_J ... ); default off
       turns T               length of the run in turns, for the progress line; 0: no progress line

     fix_modify ID until U ROWS [PARTS]    end the run at the first turn after which the mean rotor torque of the steady
   turns is known to the relative standard uncertainty U (postproc/core/stopping_rule.h); a turn has ROWS rows. A
   machine that looks the same after 1/PARTS of a turn may end there, and the record says so (`# turn_parts`). Says at
   the end of a run how well it is known, or why it cannot be.

   Lines `# turning=` and `# standing=` of the file name the parts of both kinds.
   Torque columns: torque that the part exerts on the grains about the axis in the direction of rotation (positive: the
   drive supplies); force columns: force that the part exerts on the grains. Includes rolling and twisting couples.
   Global vector: 1 turn, 2 rotor torque of the last row, 3 torque of the standing parts, 4 greatest overlap so far, 5
   dt over the shortest half period. */
#ifdef FIX_CLASS
FixStyle(vielto / record, FixViEltoRecord)
#else
#ifndef LMP_FIX_VIELTO_RECORD_H
#define LMP_FIX_VIELTO_RECORD_H

#include <memory>

#include "fixes/record_base.h"

namespace vielto {
class StoppingRule;
}

namespace LAMMPS_NS {

class FixViEltoRecord : public FixViEltoRows {
 public:
  FixViEltoRecord(class LAMMPS*, int, char**);
  ~FixViEltoRecord() override;
  int modify_param(int, char**) override;
  void init() override;
  void post_run() override;
  void pre_force(int) override;
  double compute_vector(int) override;

 protected:
  void add_step() override;
  std::string header_end() override;
  std::string row() override;
  void clear_interval() override;
  std::string when() const override;
  std::string progress() override;
  std::vector<double> state() override { return {work_}; }
  void set_state(const double* list) override { work_ = list[0]; }
  void row_stands(const std::string& line) override;
  bool known() override;

 private:
  int read_each(const char* name);
  int read_energy(const std::string& value);
  double gravity_moment() const;
  double potential_energy() const;
  void say(const char* line) const;
  void check_motions();
  void check_motion(const Part&, const Mesh&) const;
  void check_torque(const Part&, double torque) const;
  std::string what_is_known() const;
  double turn() const { return elapsed() * speed_; }

  double speed_ = 0;
  double axis_[3] = {1, 0, 0};
  double origin_[3] = {0, 0, 0};
  double idle_ = 0, idleNoise_ = 0;
  int idleSeed_ = 1;
  double maxTorque_ = 0;
  bool energy_ = false;
  double turns_ = 0;

  double gravity_ = 0;  // sum of samples, N m
  double work_ = 0;     // of the rotor on the grains since the start, J
  double lastRotor_ = 0, lastStanding_ = 0;
  bool motionChecked_ = false;

  int rowsOfPart_ = 0, turnParts_ = 1;  // 0: the run has its length
  int rowsOfPhase_ = 1, rowsInPhase_ = 0;
  double phaseSum_ = 0;
  std::unique_ptr<vielto::StoppingRule> rule_;  // on processor 0
};

}  // namespace LAMMPS_NS
#endif
#endif

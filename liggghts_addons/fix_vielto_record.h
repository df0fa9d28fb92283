// SPDX-License-Identifier: GPL-2.0-or-later
/* Records torque and force of the parts of a rotating machine, and stops the run when its numbers cannot be trusted.

     fix ID all vielto/record every N file F speed n part NAME MESHFIX... [part ...] [keywords]
       every N               rows are means over N steps
       speed n               1/s; the rotation starts when this fix is made
       axis x y z            axis of rotation through `origin`, default 1 0 0
       origin x y z          default 0 0 0
       part NAME IDs...      fixes mesh/surface/stress that make up a part; `drum` as NAME is the static one
       each NAME             one torque column more for each mesh of that part (NAME without its s, numbered)
       idle T NOISE SEED     torque of the idling model, N m, and the relative standard deviation of its noise per row
       maxTorque T           stop when a part's torque in any step exceeds T, N m; default 0: no limit
       dtLimit F             refuse a time step over F times the shortest half period of a contact; default 0.05
       energy on|off         energy accounts (columns work_J ... ); default off
       turns T               length of the run in turns, for the progress line; 0: no progress line
       header KEY VALUE...   one `# KEY=VALUE` line more at the top of the file; repeatable; VALUE ends at the next keyword

   Torque columns: torque that the part exerts on the grains about the axis in the direction of rotation (positive: the
   drive supplies); force columns: force that the part exerts on the grains. Includes rolling and twisting couples.
   A lost grain, a torque over the limit and too large a time step each stop the run with one line.
   A restart written at the end of a row carries the run on as if it had never been broken off (forces, contact history,
   accounts); rows beyond the restart's step are cut off.
   Global vector: 1 turn, 2 rotor torque of the last row, 3 drum torque of it, 4 greatest overlap so far, 5 dt over the
   shortest half period. */
#ifdef FIX_CLASS
FixStyle(vielto/record, FixViEltoRecord)
#else
#ifndef LMP_FIX_VIELTO_RECORD_H
#define LMP_FIX_VIELTO_RECORD_H

#include <string>
#include <utility>
#include <vector>

#include "fix.h"
#include "fix_vielto_watch.h"
#include "vielto_state.h"

namespace LAMMPS_NS {

class FixMeshSurface;
class FixPropertyAtom;
class MeshModuleStress;

class FixViEltoRecord : public Fix {
 public:
  FixViEltoRecord(class LAMMPS*, int, char**);
  ~FixViEltoRecord() override;
  void post_create() override;
  void pre_delete(bool unfixed) override;
  int setmask() override;
  void init() override;
  void setup(int) override;
  void pre_force(int) override;
  void end_of_step() override;
  double compute_vector(int) override;
  void write_restart(FILE*) override;
  void restart(char*) override;

 private:
  struct Mesh {
    std::string id;
    FixMeshSurface* fix = nullptr;
    MeshModuleStress* stress = nullptr;
    double torque = 0;  // sum over the steps of the interval, N m
  };
  struct Part {
    std::string name;
    bool each = false;
    std::vector<Mesh> meshes;
    double torque = 0;
    double force[3] = {0, 0, 0};
  };

  void parse(int narg, char** arg);
  void open_file();
  void cut_file();
  void write_header(FILE*);
  void write_row();
  void clear_interval();
  double add_step();
  double gravity_moment() const;
  void mechanical_energy(double& kinetic, double& potential) const;
  void take_up_forces();
  void check_time_step();
  void check_torque(const Part&, double torque) const;
  void show_progress();
  double elapsed() const;  // since the rotation began, s
  double turn() const;
  double total(double mine) const;

  int every_ = 0;
  std::string path_;
  double speed_ = 0;
  double axis_[3] = {1, 0, 0};
  double origin_[3] = {0, 0, 0};
  std::vector<Part> parts_;
  double idle_ = 0, idleNoise_ = 0;
  int idleSeed_ = 1;
  double maxTorque_ = 0;
  double dtLimit_ = 0.05;
  bool energy_ = false;
  double turns_ = 0;
  std::vector<std::pair<std::string, std::string>> header_;

  FILE* file_ = nullptr;
  bool restarted_ = false;
  bool forcesRead_ = false;
  FixPropertyAtom* forces_ = nullptr;
  bigint start_ = 0;      // step at which the rotation began
  int steps_ = 0;         // steps in the running interval
  int gravitySamples_ = 0;
  double gravity_ = 0;    // sum of samples, N m
  double work_ = 0;       // of the rotor on the grains since the start, J
  double overlapMaxEver_ = 0;
  double dtOverTc_ = 0;
  double lastRotor_ = 0, lastDrum_ = 0;
  double progressStart_ = 0, progressLast_ = 0;
  bigint progressStep_ = 0;
  vielto::GrainWatch watch_;
  vielto::Tally& tally_;
};

}  // namespace LAMMPS_NS
#endif
#endif

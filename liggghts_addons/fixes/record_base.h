// SPDX-License-Identifier: GPL-2.0-or-later
/* What the records of all rigs share: a CSV file of `# key=value` lines, a header and rows that are means over equal
   intervals of steps, forces of parts made of meshes, overlaps, and the stops and restarts that keep a row honest.
   No fix of its own: fix vielto/record (torque) and fix vielto/shear derive from it.

     every N               rows are means over N steps
     file F
     part NAME IDs...      fixes mesh/surface/stress that make up a part
     standing NAME IDs...  the same for a part that stands still; one that is called drum does in any case
     dtLimit F             refuse a time step over F times the shortest half period of a contact; default 0.05
     header KEY VALUE...   one `# KEY=VALUE` line more at the top of the file; repeatable; VALUE ends at the next
   keyword

   A lost grain and too large a time step each stop the run with one line. A restart written at the end of a row carries
   the run on as if it had never been broken off (forces, contact history, accounts); rows beyond the restart's step are
   cut off. */
#ifndef LMP_FIX_VIELTO_ROWS_H
#define LMP_FIX_VIELTO_ROWS_H

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fix.h"
#include "fixes/fix_vielto_watch.h"
#include "vielto_state.h"

namespace LAMMPS_NS {

class FixMeshSurface;
class FixPropertyAtom;
class MeshModuleStress;

class FixViEltoRows : public Fix {
 public:
  FixViEltoRows(class LAMMPS*, int, char**);
  ~FixViEltoRows() override;
  void post_create() override;
  void pre_delete(bool unfixed) override;
  int setmask() override;
  void init() override;
  void setup(int) override;
  void pre_force(int) override;
  void end_of_step() override;
  void post_run() override;
  void write_restart(FILE*) override;
  void restart(char*) override;

 protected:
  struct Mesh {
    std::string id;
    FixMeshSurface* fix = nullptr;
    MeshModuleStress* stress = nullptr;
    double torque = 0;  // sum over the steps of the interval, N m; kept by a record of torques
  };
  struct Part {
    std::string name;
    bool each = false;
    bool stands = false;
    std::vector<Mesh> meshes;
    double torque = 0;
    double force[3] = {0, 0, 0};  // on the grains, sum over the steps of the interval, N
  };

  // Keyword -> reads its values, which begin at arg[i + 1], and returns their number.
  typedef std::map<std::string, std::function<int(int i)>> Keywords;
  // Called by the constructor of a record with its own keywords; those above are added.
  void parse(int narg, char** arg, Keywords own);
  double number(char** arg, int i) const;

  virtual void add_step() = 0;           // add this step to the interval
  virtual std::string header_end() = 0;  // `# key=value` lines of the record, then the line of column names
  virtual std::string row() = 0;         // values after `step`; called by all processors
  virtual void clear_interval();
  virtual std::string when() const = 0;               // "turn 0.25", for messages
  virtual std::string progress() { return ""; }       // line for the screen; empty: none
  virtual std::vector<double> state() { return {}; }  // to be kept in restart files; called by all processors
  virtual void set_state(const double*) {}
  // On processor 0: a line of the file, as it is written and, after a restart, as it stands there already.
  virtual void row_stands(const std::string&) {}
  virtual bool known() { return false; }  // called by all processors after each row; true ends the run

  void add_force(Part&);   // of this step
  double elapsed() const;  // since the fix was made, s
  double total(double mine) const;
  double kinetic_energy() const;
  // overlap_mean,overlap_max,contacts,grains of the interval, in that order
  std::vector<double> overlaps();
  static std::string columns(const std::vector<double>& values);

  int every_ = 0;
  std::string path_;
  std::vector<Part> parts_;
  bigint start_ = 0;  // step at which the fix was made
  int steps_ = 0;     // steps in the running interval
  int samples_ = 0;   // steps in it at which overlaps were measured
  bool sampling() const;
  double overlapMaxEver_ = 0;
  double dtLimit_ = 0.05, dtOverTc_ = 0;
  vielto::GrainWatch watch_;
  bool restarted_ = false;
  vielto::Tally& tally_;

 private:
  int read_part(int i, int narg, char** arg, bool stands);
  void check_name(const std::string& name);
  void open_file();
  void cut_file();
  void take_up_forces();
  void check_time_step();
  void show_progress();
  void end_run();

  std::vector<std::pair<std::string, std::string>> header_;
  FILE* file_ = nullptr;
  bool forcesRead_ = false;
  bool ended_ = false;  // by this record, before its last step
  FixPropertyAtom* forces_ = nullptr;
  double progressStart_ = 0, progressLast_ = 0;
  bigint progressStep_ = 0;
};

}  // namespace LAMMPS_NS
#endif

// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/record_base.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include <algorithm>
#include <fstream>

#include "atom.h"
#include "comm.h"
#include "engine/bodies.h"
#include "engine/critical_time.h"
#include "error.h"
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "force.h"
#include "mesh_module_stress.h"
#include "modify.h"
#include "signal_handling.h"
#include "update.h"
#include "vielto_stop.h"

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

// Overlaps are measured in every tenth step: enough for a mean, cheap.
const int SAMPLE_EVERY = 10;
const double PROGRESS_SECONDS = 5;

}  // namespace

FixViEltoRows::FixViEltoRows(LAMMPS* lammps, int narg, char** arg)
    : Fix(lammps, narg, arg), watch_(lammps), tally_(vielto::tally()) {
  nevery = 1;
  vector_flag = 1;
  global_freq = 1;
  extvector = 0;
  restart_global = 1;
  start_ = update->ntimestep;
  tally_ = vielto::Tally();
}

FixViEltoRows::~FixViEltoRows() {
  if (file_) fclose(file_);
}

// Forces and torques of the last step, kept in restart files only.
void FixViEltoRows::post_create() {
  const std::string name = std::string(id) + "_forces";
  const char* words[] = {
      name.c_str(), "all", "property/atom", name.c_str(), "vector", "yes", "no", "no", "0", "0", "0", "0", "0", "0"};
  forces_ = modify->add_fix_property_atom(14, const_cast<char**>(words), style);
}

void FixViEltoRows::pre_delete(bool unfixed) {
  if (unfixed) modify->delete_fix(forces_->id);
}

double FixViEltoRows::number(char** arg, int i) const { return force->numeric(FLERR, arg[i]); }

void FixViEltoRows::parse(int narg, char** arg, Keywords own) {
  Keywords keywords = own;
  keywords["every"] = [&](int i) { return every_ = force->inumeric(FLERR, arg[i + 1]), 1; };
  keywords["file"] = [&](int i) { return path_ = arg[i + 1], 1; };
  keywords["dtLimit"] = [&](int i) { return dtLimit_ = number(arg, i + 1), 1; };
  keywords["part"] = [&](int i) { return read_part(i, narg, arg, false); };
  keywords["standing"] = [&](int i) { return read_part(i, narg, arg, true); };
  keywords["header"] = [&](int i) {
    if (i + 2 >= narg) error->fix_error(FLERR, this, "header needs a key and a value");
    std::string value = arg[i + 2];
    int n = 2;
    while (i + n + 1 < narg && !keywords.count(arg[i + n + 1])) value += std::string(" ") + arg[i + ++n];
    header_.emplace_back(arg[i + 1], value);
    return n;
  };
  for (int i = 3; i < narg;) {
    const auto keyword = keywords.find(arg[i]);
    if (keyword == keywords.end()) error->fix_error(FLERR, this, (std::string("unknown keyword ") + arg[i]).c_str());
    if (i + 1 >= narg) error->fix_error(FLERR, this, (std::string("keyword ") + arg[i] + " lacks a value").c_str());
    i += 1 + keyword->second(i);
    if (i > narg) error->fix_error(FLERR, this, (keyword->first + " lacks a value").c_str());
  }
  if (every_ < 1) error->fix_error(FLERR, this, "every N with N >= 1 is required");
  if (path_.empty()) error->fix_error(FLERR, this, "file F is required");
  if (parts_.empty()) error->fix_error(FLERR, this, "at least one part is required");
}

int FixViEltoRows::read_part(int i, int narg, char** arg, bool stands) {
  Part part;
  part.name = arg[i + 1];
  part.stands = stands || part.name == "drum";
  check_name(part.name);
  for (int k = i + 2; k < narg && modify->find_fix(arg[k]) >= 0; k++) {
    Mesh mesh;
    mesh.id = arg[k];
    part.meshes.push_back(mesh);
  }
  if (part.meshes.empty())
    error->fix_error(FLERR, this, ("part " + part.name + " names no fix mesh/surface/stress").c_str());
  parts_.push_back(part);
  std::map<std::string, std::string> owner;
  for (const Part& one : parts_)
    for (const Mesh& mesh : one.meshes)
      if (!owner.emplace(mesh.id, one.name).second)
        error->fix_error(FLERR, this,
                         ("mesh " + mesh.id + " stands in part " + owner[mesh.id] + " and again in part " + one.name +
                          ", so that its torque would count twice; name it once")
                             .c_str());
  return 1 + static_cast<int>(part.meshes.size());
}

// A part's name begins the names of its columns.
void FixViEltoRows::check_name(const std::string& name) {
  for (const Part& other : parts_)
    if (other.name == name)
      error->fix_error(FLERR, this,
                       ("part " + name + " is given twice; name its meshes behind one 'part " + name + "'").c_str());
  if (name == "idle" || name == "gravity")
    error->fix_error(FLERR, this, ("part " + name + " has the name of a column of its own; take another").c_str());
  if (name.find_first_of(",#\"'") != std::string::npos)
    error->fix_error(FLERR, this, ("part " + name + ": take a name without commas, quotes and #").c_str());
}

int FixViEltoRows::setmask() { return PRE_FORCE | END_OF_STEP; }

void FixViEltoRows::init() {
  for (Part& part : parts_)
    for (Mesh& mesh : part.meshes) {
      mesh.fix = dynamic_cast<FixMeshSurface*>(modify->find_fix_id(mesh.id.c_str()));
      mesh.stress = mesh.fix ? dynamic_cast<MeshModuleStress*>(mesh.fix->get_module("stress")) : nullptr;
      if (!mesh.stress)
        error->fix_error(FLERR, this, ("fix " + mesh.id + " is no mesh/surface/stress; it records no force").c_str());
    }
  check_time_step();
}

void FixViEltoRows::setup(int) {
  if (!file_) open_file();
  // every grain must be there at every row: a lost one makes the means false
  if (watch_.grains() < 0) watch_.look(when());
  if (forcesRead_) take_up_forces();
  progressStart_ = progressLast_ = MPI_Wtime();
  progressStep_ = update->ntimestep;
}

/* Forces belong to the velocities half a step before; those that LIGGGHTS has just computed belong to the velocities of
   the restart's step, and dashpots make a difference. With the forces of then the run goes on as if never broken off.
 */
void FixViEltoRows::take_up_forces() {
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3; d++) {
      atom->f[i][d] = forces_->array_atom[i][d];
      atom->torque[i][d] = forces_->array_atom[i][d + 3];
    }
  if (auto* clumps = static_cast<FixMultisphere*>(modify->find_fix_style("multisphere", 0))) {
    // it has added up over its bodies what was just computed
    clumps->data().reset_forces(false);
    clumps->comm_correct_force(true);
    clumps->calc_force(true);
  }
  forcesRead_ = false;
}

void FixViEltoRows::check_time_step() {
  const double tc = vielto::shortest_half_period_now(lmp);
  dtOverTc_ = tc > 0 ? update->dt / tc : 0;
  if (dtLimit_ > 0 && dtOverTc_ > dtLimit_ * (1 + 1e-9)) {
    char line[300];
    snprintf(line, sizeof line,
             "vielto: time step %.4g s is %.3g of the shortest half period of a contact (%.4g s), over the limit %.3g; "
             "take at most %.4g s",
             update->dt, dtOverTc_, tc, dtLimit_, dtLimit_ * tc);
    vielto::stop_all(lmp, line);
  }
}

bool FixViEltoRows::sampling() const { return update->ntimestep % SAMPLE_EVERY == 0; }

void FixViEltoRows::pre_force(int) {
  tally_.overlaps = sampling();
  tally_.elastic = 0;
  tally_.wallForce = 0;
  tally_.wallGrain = 0;
}

void FixViEltoRows::add_force(Part& part) {
  for (const Mesh& mesh : part.meshes)
    for (int d = 0; d < 3; d++) part.force[d] -= mesh.stress->f_total(d);
}

void FixViEltoRows::end_of_step() {
  add_step();
  steps_++;
  samples_ += sampling();
  if ((update->ntimestep - start_) % every_ == 0) {
    watch_.look(when());
    const std::string values = row();
    if (file_) {
      const std::string line = std::to_string(update->ntimestep) + values;
      if (fprintf(file_, "%s\n", line.c_str()) < 0 || fflush(file_) != 0)
        vielto::stop_here(lmp, ("vielto: cannot write " + path_ + "; check the space left").c_str());
      row_stands(line);
    }
    clear_interval();
    if (known()) end_run();
  }
  show_progress();
}

/* LIGGGHTS leaves its loop of steps for a signal only; the script goes on because post_run takes the request back. One
   that came from outside stays. */
void FixViEltoRows::end_run() {
  ended_ = !SignalHandler::request_quit;
  SignalHandler::request_quit = true;
}

void FixViEltoRows::post_run() {
  if (ended_) SignalHandler::request_quit = false;
  ended_ = false;
}

double FixViEltoRows::kinetic_energy() const { return total(vielto::kinetic_energy_of(modify, atom)); }

std::vector<double> FixViEltoRows::overlaps() {
  const double contacts = total(tally_.contacts), sum = total(tally_.overlapSum);
  double greatest = 0;
  MPI_Allreduce(&tally_.overlapMax, &greatest, 1, MPI_DOUBLE, MPI_MAX, world);
  overlapMaxEver_ = std::max(overlapMaxEver_, greatest);
  return {contacts > 0 ? sum / contacts : 0, greatest, samples_ ? contacts / samples_ : 0,
          static_cast<double>(watch_.grains())};
}

double FixViEltoRows::elapsed() const { return static_cast<double>(update->ntimestep - start_) * update->dt; }

double FixViEltoRows::total(double mine) const {
  double sum = 0;
  MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

std::string FixViEltoRows::columns(const std::vector<double>& values) {
  std::string text;
  for (double value : values) {
    char field[64];
    snprintf(field, sizeof field, ",%.9g", value);
    text += field;
  }
  return text;
}

void FixViEltoRows::clear_interval() {
  for (Part& part : parts_)
    for (double& f : part.force) f = 0;
  steps_ = samples_ = 0;
  tally_.contacts = tally_.overlapSum = tally_.overlapMax = 0;
}

void FixViEltoRows::open_file() {
  if (comm->me != 0) return;
  if (restarted_) cut_file();
  file_ = fopen(path_.c_str(), restarted_ ? "a" : "w");
  if (!file_) vielto::stop_here(lmp, ("vielto: cannot write " + path_ + "; does its folder exist?").c_str());
  if (restarted_) return;
  for (const auto& line : header_) fprintf(file_, "# %s=%s\n", line.first.c_str(), line.second.c_str());
  fprintf(file_, "# dt=%.10g\n# dt_over_tc=%.6g\n# interval_steps=%d\n%s\n", update->dt, dtOverTc_, every_,
          header_end().c_str());
}

// Rows written after the restart's step belong to a run that was broken off, and so does a last line without an end.
void FixViEltoRows::cut_file() {
  std::ifstream in(path_);
  if (!in)
    vielto::stop_here(lmp, ("vielto: cannot read " + path_ + ", the record which this restart carries on").c_str());
  const std::string cut = path_ + ".partial";
  std::ofstream out(cut);
  std::string line;
  while (std::getline(in, line) && !in.eof()) {
    const bool row = !line.empty() && line[0] >= '0' && line[0] <= '9';
    if (row && atoll(line.c_str()) > update->ntimestep) continue;
    out << line << '\n';
    if (row) row_stands(line);
  }
  out.close();
  if (!out || rename(cut.c_str(), path_.c_str()) != 0)
    vielto::stop_here(lmp, ("vielto: cannot rewrite " + path_).c_str());
}

void FixViEltoRows::show_progress() {
  if (comm->me != 0 || !screen) return;
  const double now = MPI_Wtime();
  const bool last = update->ntimestep == update->laststep;
  if (now - progressLast_ < PROGRESS_SECONDS && !last) return;
  progressLast_ = now;
  const std::string line = progress();
  if (line.empty()) return;
  const double done = static_cast<double>(update->ntimestep - progressStep_);
  const double left = static_cast<double>(update->laststep - update->ntimestep) * (now - progressStart_) / done;
  fprintf(screen, "%s, %d:%02d left\n", line.c_str(), static_cast<int>(left) / 60, static_cast<int>(left) % 60);
  fflush(screen);
}

void FixViEltoRows::write_restart(FILE* fp) {
  // LIGGGHTS writes the pairs' contact history as it was when the neighbour lists were last made: bring it up to date
  for (int i = 0; i < modify->nfix; i++)
    if (strcmp(modify->fix[i]->style, "contacthistory") == 0) modify->fix[i]->setup_pre_exchange();
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3; d++) {
      forces_->array_atom[i][d] = atom->f[i][d];
      forces_->array_atom[i][d + 3] = atom->torque[i][d];
    }
  std::vector<double> list = {static_cast<double>(start_),     overlapMaxEver_,       total(tally_.normalDamping),
                              total(tally_.tangentialDamping), total(tally_.sliding), total(tally_.rolling),
                              total(tally_.twisting)};
  for (double value : state()) list.push_back(value);
  if (comm->me == 0) {
    const int size = static_cast<int>(list.size() * sizeof(double));
    fwrite(&size, sizeof(int), 1, fp);
    fwrite(list.data(), sizeof(double), list.size(), fp);
  }
}

void FixViEltoRows::restart(char* buf) {
  const double* list = reinterpret_cast<const double*>(buf);
  start_ = static_cast<bigint>(list[0]);
  overlapMaxEver_ = list[1];
  if (comm->me == 0) {
    tally_.normalDamping = list[2];
    tally_.tangentialDamping = list[3];
    tally_.sliding = list[4];
    tally_.rolling = list[5];
    tally_.twisting = list[6];
  }
  set_state(list + 7);
  restarted_ = forcesRead_ = true;
  if ((update->ntimestep - start_) % every_ != 0)
    vielto::stop_all(lmp,
                     "vielto: this restart lies inside a row of the record; write restarts every so many whole rows");
}

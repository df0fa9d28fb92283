// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_vielto_record.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_gravity.h"
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "force.h"
#include "mesh_module_stress.h"
#include "modify.h"
#include "update.h"
#include "vielto_critical_time.h"
#include "vielto_stop.h"

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

// Overlaps and the gravity moment are measured in every tenth step: enough for a mean, cheap.
const int SAMPLE_EVERY = 10;
const double PROGRESS_SECONDS = 5;

double dot3(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void cross3(const double* a, const double* b, double* c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

bool is_keyword(const std::string& word) {
  for (const char* known : {"every", "file", "speed", "axis", "origin", "part", "each", "idle", "maxTorque", "dtLimit",
                            "turns", "energy", "header"})
    if (word == known) return true;
  return false;
}

std::string format(const char* pattern, double value) {
  char text[64];
  snprintf(text, sizeof text, pattern, value);
  return text;
}

}  // namespace

FixViEltoRecord::FixViEltoRecord(LAMMPS* lammps, int narg, char** arg) : Fix(lammps, narg, arg), watch_(lammps), tally_(vielto::tally()) {
  nevery = 1;
  vector_flag = 1;
  size_vector = 5;
  global_freq = 1;
  extvector = 0;
  restart_global = 1;
  parse(narg, arg);
  start_ = update->ntimestep;
  tally_ = vielto::Tally();
}

FixViEltoRecord::~FixViEltoRecord() {
  if (file_) fclose(file_);
}

// Forces and torques of the last step, kept in restart files only.
void FixViEltoRecord::post_create() {
  const std::string name = std::string(id) + "_forces";
  const char* words[] = {name.c_str(), "all", "property/atom", name.c_str(), "vector", "yes", "no",
                         "no",         "0",   "0",             "0",          "0",      "0",   "0"};
  forces_ = modify->add_fix_property_atom(14, const_cast<char**>(words), style);
}

void FixViEltoRecord::pre_delete(bool unfixed) {
  if (unfixed) modify->delete_fix(forces_->id);
}

void FixViEltoRecord::parse(int narg, char** arg) {
  int i = 3;
  const auto need = [&](int n) {
    if (i + n >= narg) error->fix_error(FLERR, this, (std::string("keyword ") + arg[i] + " lacks a value").c_str());
  };
  const auto number = [&](int k) { return force->numeric(FLERR, arg[i + k]); };
  while (i < narg) {
    const std::string key = arg[i];
    if (key == "every") {
      need(1), every_ = static_cast<int>(number(1)), i += 2;
    } else if (key == "file") {
      need(1), path_ = arg[i + 1], i += 2;
    } else if (key == "speed") {
      need(1), speed_ = number(1), i += 2;
    } else if (key == "axis" || key == "origin") {
      need(3);
      for (int d = 0; d < 3; d++) (key == "axis" ? axis_ : origin_)[d] = number(d + 1);
      i += 4;
    } else if (key == "part") {
      need(2);
      Part part;
      part.name = arg[i + 1];
      for (i += 2; i < narg && modify->find_fix(arg[i]) >= 0; i++) {
        Mesh mesh;
        mesh.id = arg[i];
        part.meshes.push_back(mesh);
      }
      if (part.meshes.empty())
        error->fix_error(FLERR, this, ("part " + part.name + " names no fix mesh/surface/stress").c_str());
      parts_.push_back(part);
    } else if (key == "each") {
      need(1);
      bool found = false;
      for (Part& part : parts_)
        if (part.name == arg[i + 1]) part.each = found = true;
      if (!found) error->fix_error(FLERR, this, "keyword each names no part given before it");
      i += 2;
    } else if (key == "idle") {
      need(3), idle_ = number(1), idleNoise_ = number(2), idleSeed_ = static_cast<int>(number(3)), i += 4;
    } else if (key == "maxTorque") {
      need(1), maxTorque_ = number(1), i += 2;
    } else if (key == "dtLimit") {
      need(1), dtLimit_ = number(1), i += 2;
    } else if (key == "turns") {
      need(1), turns_ = number(1), i += 2;
    } else if (key == "energy") {
      need(1);
      const std::string value = arg[i + 1];
      if (value != "on" && value != "off") error->fix_error(FLERR, this, "energy takes on or off");
      energy_ = value == "on";
      i += 2;
    } else if (key == "header") {
      need(2);
      std::string value = arg[i + 2];
      const std::string name = arg[i + 1];
      for (i += 3; i < narg && !is_keyword(arg[i]); i++) value += std::string(" ") + arg[i];
      header_.emplace_back(name, value);
    } else {
      error->fix_error(FLERR, this, ("unknown keyword " + key).c_str());
    }
  }
  if (every_ < 1) error->fix_error(FLERR, this, "every N with N >= 1 is required");
  if (path_.empty()) error->fix_error(FLERR, this, "file F is required");
  if (!(speed_ >= 0)) error->fix_error(FLERR, this, "speed n >= 0 is required");
  if (parts_.empty()) error->fix_error(FLERR, this, "at least one part is required");
  const double length = std::sqrt(dot3(axis_, axis_));
  if (!(length > 0)) error->fix_error(FLERR, this, "axis has no length");
  for (double& a : axis_) a /= length;
}

int FixViEltoRecord::setmask() { return PRE_FORCE | END_OF_STEP; }

void FixViEltoRecord::init() {
  for (Part& part : parts_)
    for (Mesh& mesh : part.meshes) {
      mesh.fix = dynamic_cast<FixMeshSurface*>(modify->find_fix_id(mesh.id.c_str()));
      mesh.stress = mesh.fix ? dynamic_cast<MeshModuleStress*>(mesh.fix->get_module("stress")) : nullptr;
      if (!mesh.stress)
        error->fix_error(FLERR, this, ("fix " + mesh.id + " is no mesh/surface/stress; it records no torque").c_str());
    }
  check_time_step();
}

void FixViEltoRecord::setup(int) {
  if (!file_) open_file();
  // every grain must be there at every row: a lost one makes the means false
  if (watch_.grains() < 0) watch_.look(format("turn %.3f", turn()));
  if (forcesRead_) take_up_forces();
  progressStart_ = progressLast_ = MPI_Wtime();
  progressStep_ = update->ntimestep;
}

/* Forces belong to the velocities half a step before; those that LIGGGHTS has just computed belong to the velocities of
   the restart's step, and dashpots make a difference. With the forces of then the run goes on as if never broken off. */
void FixViEltoRecord::take_up_forces() {
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3; d++) {
      atom->f[i][d] = forces_->array_atom[i][d];
      atom->torque[i][d] = forces_->array_atom[i][d + 3];
    }
  forcesRead_ = false;
}

void FixViEltoRecord::check_time_step() {
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

void FixViEltoRecord::pre_force(int) {
  tally_.overlaps = update->ntimestep % SAMPLE_EVERY == 0;
  tally_.energy = energy_;
  tally_.elastic = 0;
  tally_.wallForce = 0;
  tally_.wallGrain = 0;
}

// Torque and force of this step; returns the rotor's torque on the grains.
double FixViEltoRecord::add_step() {
  double rotor = 0;
  for (Part& part : parts_) {
    double partTorque = 0;
    for (Mesh& mesh : part.meshes) {
      double reference[3] = {0, 0, 0};
      auto* point = mesh.fix->triMesh()->prop().getGlobalProperty<VectorContainer<double, 3>>("p_ref");
      if (point) point->get(0, reference);
      double F[3], T[3], arm[3], moved[3];
      for (int d = 0; d < 3; d++) {
        F[d] = mesh.stress->f_total(d);
        T[d] = mesh.stress->torque_total(d);
        arm[d] = reference[d] - origin_[d];
        part.force[d] -= F[d];
      }
      cross3(arm, F, moved);
      const double torque = -(dot3(T, axis_) + dot3(moved, axis_));
      mesh.torque += torque;
      partTorque += torque;
    }
    part.torque += partTorque;
    if (part.name != "drum") rotor += partTorque;
    check_torque(part, partTorque);
  }
  return rotor;
}

void FixViEltoRecord::end_of_step() {
  const double rotor = add_step();
  work_ += rotor * 2 * M_PI * speed_ * update->dt;
  steps_++;
  if (update->ntimestep % SAMPLE_EVERY == 0) {
    gravity_ += gravity_moment();
    gravitySamples_++;
  }
  if ((update->ntimestep - start_) % every_ == 0) {
    watch_.look(format("turn %.3f", turn()));
    write_row();
    clear_interval();
  }
  if (turns_ > 0) show_progress();
}

void FixViEltoRecord::check_torque(const Part& part, double torque) const {
  if (!(maxTorque_ > 0) || std::fabs(torque) <= maxTorque_) return;
  struct {
    double force;
    int grain;
  } mine = {tally_.wallForce, tally_.wallGrain}, most;
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, world);
  char line[400];
  snprintf(line, sizeof line,
           "vielto: step " BIGINT_FORMAT " (turn %.3f): torque of %s is %.4g N m, over the limit of %.4g N m (maxTorque); the "
           "greatest wall force, %.4g N, acts on grain %d",
           update->ntimestep, turn(), part.name.c_str(), torque, maxTorque_, most.force, most.grain);
  vielto::stop_all(lmp, line);
}

double FixViEltoRecord::gravity_moment() const {
  FixGravity* fix = static_cast<FixGravity*>(modify->find_fix_style("gravity", 0));
  if (!fix) return 0;
  double g[3], moment = 0;
  fix->get_gravity(g);
  for (int i = 0; i < atom->nlocal; i++) {
    double arm[3], m[3];
    for (int d = 0; d < 3; d++) arm[d] = atom->x[i][d] - origin_[d];
    cross3(arm, g, m);
    moment += atom->rmass[i] * dot3(m, axis_);
  }
  return moment;
}

void FixViEltoRecord::mechanical_energy(double& kinetic, double& potential) const {
  FixGravity* fix = static_cast<FixGravity*>(modify->find_fix_style("gravity", 0));
  double g[3] = {0, 0, 0};
  if (fix) fix->get_gravity(g);
  kinetic = potential = 0;
  for (int i = 0; i < atom->nlocal; i++) {
    const double m = atom->rmass[i], r = atom->radius[i];
    kinetic += 0.5 * m * (dot3(atom->v[i], atom->v[i]) + 0.4 * r * r * dot3(atom->omega[i], atom->omega[i]));
    potential -= m * dot3(atom->x[i], g);
  }
}

double FixViEltoRecord::elapsed() const { return static_cast<double>(update->ntimestep - start_) * update->dt; }

double FixViEltoRecord::turn() const { return elapsed() * speed_; }

double FixViEltoRecord::total(double mine) const {
  double sum = 0;
  MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

void FixViEltoRecord::clear_interval() {
  for (Part& part : parts_) {
    part.torque = 0;
    for (double& f : part.force) f = 0;
    for (Mesh& mesh : part.meshes) mesh.torque = 0;
  }
  steps_ = gravitySamples_ = 0;
  gravity_ = 0;
  tally_.contacts = tally_.overlapSum = tally_.overlapMax = 0;
}

void FixViEltoRecord::write_header(FILE* out) {
  for (const auto& line : header_) fprintf(out, "# %s=%s\n", line.first.c_str(), line.second.c_str());
  fprintf(out, "# speed=%.10g\n# dt=%.10g\n# dt_over_tc=%.6g\n# interval_steps=%d\n", speed_, update->dt, dtOverTc_,
          every_);
  fprintf(out, "step,time_s,turn,idle_Nm");
  for (const Part& part : parts_) fprintf(out, ",%s_Nm", part.name.c_str());
  for (const Part& part : parts_)
    for (const char* d : {"x", "y", "z"}) fprintf(out, ",%s_F%s_N", part.name.c_str(), d);
  for (const Part& part : parts_) {
    if (!part.each) continue;
    std::string single = part.name;
    if (!single.empty() && single.back() == 's') single.pop_back();
    for (std::size_t k = 1; k <= part.meshes.size(); k++) fprintf(out, ",%s%zu_Nm", single.c_str(), k);
  }
  fprintf(out, ",gravity_Nm,overlap_mean,overlap_max,contacts,grains,kinetic_J");
  if (energy_)
    fprintf(out,
            ",work_J,elastic_J,potential_J,diss_normal_J,diss_tangential_J,diss_sliding_J,diss_rolling_J,"
            "diss_twisting_J");
  fprintf(out, "\n");
}

void FixViEltoRecord::write_row() {
  double kinetic, potential;
  mechanical_energy(kinetic, potential);
  kinetic = total(kinetic);
  const double gravity = gravitySamples_ ? total(gravity_) / gravitySamples_ : 0;
  const double contacts = total(tally_.contacts);
  const double overlapSum = total(tally_.overlapSum);
  double overlapMax = 0;
  MPI_Allreduce(&tally_.overlapMax, &overlapMax, 1, MPI_DOUBLE, MPI_MAX, world);
  overlapMaxEver_ = std::max(overlapMaxEver_, overlapMax);
  lastRotor_ = lastDrum_ = 0;
  for (const Part& part : parts_) (part.name == "drum" ? lastDrum_ : lastRotor_) += part.torque / steps_;

  const std::mt19937::result_type key[2] = {static_cast<std::mt19937::result_type>(idleSeed_),
                                            static_cast<std::mt19937::result_type>(update->ntimestep / every_)};
  std::seed_seq seed(key, key + 2);
  std::mt19937 random(seed);
  const double idle = idle_ * (1 + idleNoise_ * std::normal_distribution<double>()(random));

  std::string row = format("%.0f", static_cast<double>(update->ntimestep));
  const auto add = [&row](double value) { row += "," + format("%.9g", value); };
  add(elapsed());
  add(turn());
  add(idle);
  for (const Part& part : parts_) add(part.torque / steps_);
  for (const Part& part : parts_)
    for (double f : part.force) add(f / steps_);
  for (const Part& part : parts_)
    if (part.each)
      for (const Mesh& mesh : part.meshes) add(mesh.torque / steps_);
  add(gravity);
  add(contacts > 0 ? overlapSum / contacts : 0);
  add(overlapMax);
  add(gravitySamples_ ? contacts / gravitySamples_ : 0);
  add(static_cast<double>(watch_.grains()));
  add(kinetic);
  if (energy_) {
    add(work_);
    add(total(tally_.elastic));
    add(total(potential));
    add(total(tally_.normalDamping));
    add(total(tally_.tangentialDamping));
    add(total(tally_.sliding));
    add(total(tally_.rolling));
    add(total(tally_.twisting));
  }
  if (file_) {
    fprintf(file_, "%s\n", row.c_str());
    fflush(file_);
  }
}

void FixViEltoRecord::open_file() {
  if (comm->me != 0) return;
  if (restarted_) cut_file();
  file_ = fopen(path_.c_str(), restarted_ ? "a" : "w");
  if (!file_) vielto::stop_here(lmp, ("vielto: cannot write " + path_ + "; does its folder exist?").c_str());
  if (!restarted_) write_header(file_);
}

// Rows written after the restart's step belong to a run that was broken off, and so does a last line without an end.
void FixViEltoRecord::cut_file() {
  std::ifstream in(path_);
  if (!in)
    vielto::stop_here(lmp, ("vielto: cannot read " + path_ + ", the record which this restart carries on").c_str());
  const std::string cut = path_ + ".partial";
  std::ofstream out(cut);
  std::string line;
  while (std::getline(in, line) && !in.eof()) {
    const bool row = !line.empty() && line[0] >= '0' && line[0] <= '9';
    if (!row || atoll(line.c_str()) <= update->ntimestep) out << line << '\n';
  }
  out.close();
  if (!out || rename(cut.c_str(), path_.c_str()) != 0)
    vielto::stop_here(lmp, ("vielto: cannot rewrite " + path_).c_str());
}

void FixViEltoRecord::show_progress() {
  if (comm->me != 0) return;
  const double now = MPI_Wtime();
  const bool last = update->ntimestep == update->laststep;
  if (now - progressLast_ < PROGRESS_SECONDS && !last) return;
  progressLast_ = now;
  const double done = static_cast<double>(update->ntimestep - progressStep_);
  const double left = static_cast<double>(update->laststep - update->ntimestep) * (now - progressStart_) / done;
  if (screen)
    fprintf(screen, "turn %.2f of %.2f, rotor %.3f N m, %d:%02d left\n", turn(), turns_, lastRotor_,
            static_cast<int>(left) / 60, static_cast<int>(left) % 60);
  if (screen) fflush(screen);
}

double FixViEltoRecord::compute_vector(int n) {
  const double values[5] = {turn(), lastRotor_, lastDrum_, overlapMaxEver_, dtOverTc_};
  return values[n];
}

void FixViEltoRecord::write_restart(FILE* fp) {
  // LIGGGHTS writes the pairs' contact history as it was when the neighbour lists were last made: bring it up to date
  for (int i = 0; i < modify->nfix; i++)
    if (strcmp(modify->fix[i]->style, "contacthistory") == 0) modify->fix[i]->setup_pre_exchange();
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3; d++) {
      forces_->array_atom[i][d] = atom->f[i][d];
      forces_->array_atom[i][d + 3] = atom->torque[i][d];
    }
  const double list[] = {static_cast<double>(start_), work_, overlapMaxEver_, total(tally_.normalDamping),
                         total(tally_.tangentialDamping), total(tally_.sliding), total(tally_.rolling),
                         total(tally_.twisting)};
  if (comm->me == 0) {
    const int size = static_cast<int>(sizeof list);
    fwrite(&size, sizeof(int), 1, fp);
    fwrite(list, sizeof list, 1, fp);
  }
}

void FixViEltoRecord::restart(char* buf) {
  const double* list = reinterpret_cast<const double*>(buf);
  start_ = static_cast<bigint>(list[0]);
  work_ = list[1];
  overlapMaxEver_ = list[2];
  if (comm->me == 0) {
    tally_.normalDamping = list[3];
    tally_.tangentialDamping = list[4];
    tally_.sliding = list[5];
    tally_.rolling = list[6];
    tally_.twisting = list[7];
  }
  restarted_ = forcesRead_ = true;
  if ((update->ntimestep - start_) % every_ != 0)
    vielto::stop_all(lmp, "vielto: this restart lies inside a row of the record; write restarts every so many whole rows");
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/fix_vielto_record.h"

#include <mpi.h>

#include <cmath>
#include <random>
#include <sstream>

#include "atom.h"
#include "comm.h"
#include "core/stopping_rule.h"
#include "engine/bodies.h"
#include "engine/law.h"
#include "error.h"
#include "fix_gravity.h"
#include "fix_mesh_surface.h"
#include "mesh_module_stress.h"
#include "modify.h"
#include "update.h"
#include "vielto_stop.h"

using namespace LAMMPS_NS;

namespace {

// 1/s; mixers turn at 0.5 to 3, and a speed in 1/min is 30 to 200
const double kFastest = 10;

double dot3(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void cross3(const double* a, const double* b, double* c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

}  // namespace

FixViEltoRecord::FixViEltoRecord(LAMMPS* lammps, int narg, char** arg) : FixViEltoRows(lammps, narg, arg) {
  size_vector = 5;
  const auto three = [&](int i, double* to) {
    if (i + 3 >= narg) error->fix_error(FLERR, this, (std::string(arg[i]) + " takes three numbers").c_str());
    for (int d = 0; d < 3; d++) to[d] = number(arg, i + 1 + d);
    return 3;
  };
  Keywords own;
  own["speed"] = [&](int i) { return speed_ = number(arg, i + 1), 1; };
  own["axis"] = [&](int i) { return three(i, axis_); };
  own["origin"] = [&](int i) { return three(i, origin_); };
  own["each"] = [&](int i) { return read_each(arg[i + 1]); };
  own["idle"] = [&](int i) {
    double values[3];
    three(i, values);
    idle_ = values[0], idleNoise_ = values[1], idleSeed_ = static_cast<int>(values[2]);
    return 3;
  };
  own["maxTorque"] = [&](int i) { return maxTorque_ = number(arg, i + 1), 1; };
  own["turns"] = [&](int i) { return turns_ = number(arg, i + 1), 1; };
  own["energy"] = [&](int i) { return read_energy(arg[i + 1]); };
  parse(narg, arg, own);
  if (!(speed_ >= 0)) error->fix_error(FLERR, this, "speed n >= 0 is required");
  const double length = std::sqrt(dot3(axis_, axis_));
  if (!(length > 0)) error->fix_error(FLERR, this, "axis has no length");
  for (double& a : axis_) a /= length;
}

FixViEltoRecord::~FixViEltoRecord() = default;

int FixViEltoRecord::modify_param(int narg, char** arg) {
  if (std::string(arg[0]) != "until") return 0;
  if (narg < 3) error->fix_error(FLERR, this, "until takes two numbers, an uncertainty and the rows of a turn");
  const double target = number(arg, 1), rows = number(arg, 2), parts = narg > 3 ? number(arg, 3) : 1;
  if (!(target > 0 && target < 1 && rows >= 1 && parts >= 1 && rows == std::floor(rows) && parts == std::floor(parts)))
    error->fix_error(FLERR, this, "until U ROWS [PARTS] needs 0 < U < 1 and whole numbers of rows and of parts");
  if (vielto::kPhases % static_cast<int>(parts) != 0)
    error->fix_error(FLERR, this,
                     "until U ROWS PARTS: PARTS must divide 72, the phases that a turn's torque is kept in");
  // where a row would reach over two parts, whole turns are looked at
  turnParts_ = std::fmod(rows, parts) == 0 ? static_cast<int>(parts) : 1;
  rowsOfPart_ = static_cast<int>(rows) / turnParts_;
  // in phases, as a power is made from: the torque rings from row to row, which would make u twice too large
  const int phases = vielto::kPhases / turnParts_;
  rowsOfPhase_ = rowsOfPart_ % phases == 0 ? rowsOfPart_ / phases : 1;
  const int least = turnParts_ > 1 ? vielto::kLeastPartTurns * turnParts_ : vielto::kLeastAveragedTurns;
  if (comm->me == 0) rule_ = std::make_unique<vielto::StoppingRule>(rowsOfPart_ / rowsOfPhase_, target, least);
  return std::min(narg, 4);
}

// The parts' torques stand after step, time, turn and idle. As printed, so that a resumed run decides alike.
void FixViEltoRecord::row_stands(const std::string& line) {
  if (!rule_) return;
  std::istringstream in(line);
  std::string field;
  for (int k = 0; k < 4; k++) std::getline(in, field, ',');
  double rotor = 0;
  for (const Part& part : parts_) {
    std::getline(in, field, ',');
    if (!part.stands) rotor += atof(field.c_str());
  }
  phaseSum_ += rotor;
  if (++rowsInPhase_ < rowsOfPhase_) return;
  rule_->add(phaseSum_ / rowsOfPhase_);
  phaseSum_ = rowsInPhase_ = 0;
}

bool FixViEltoRecord::known() {
  if (rowsOfPart_ == 0 || (update->ntimestep - start_) / every_ % rowsOfPart_ != 0) return false;
  int done = rule_ && rule_->known();
  MPI_Bcast(&done, 1, MPI_INT, 0, world);
  return done != 0;
}

void FixViEltoRecord::post_run() {
  FixViEltoRows::post_run();
  if (!rule_) return;
  const std::string text = what_is_known() + "\n";
  for (FILE* to : {screen, logfile})
    if (to) fprintf(to, "%s", text.c_str()), fflush(to);
}

std::string FixViEltoRecord::what_is_known() const {
  const vielto::Look& l = rule_->last();
  const double asked = 100 * rule_->target(), known = 100 * l.relative;
  const double parts = turnParts_, turns = rule_->turns() / parts;
  char text[400];
  const auto say = [&](const char* format, auto... values) {
    snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  if (rule_->known())
    return say("mean power known to %.2g %% (asked for: %.2g %%) from the last %g of %g turns", known, asked,
               l.part.count / parts, turns);
  const std::string start = say("Warning: after %g turns the mean power is not known to %.2g %%: ", turns, asked);
  if (l.part.verdict == vielto::Steadiness::too_few_turns) return start + "too few turns; raise turns";
  if (l.part.verdict == vielto::Steadiness::start_up_reaches_limit)
    return start + "the start-up still shows; raise turns";
  if (l.part.verdict == vielto::Steadiness::trend)
    return start + say("the torque still drifts by %+.2g %% of its mean a turn; raise turns",
                       100 * l.part.slope * parts / l.mean.mean);
  if (!(std::fabs(l.mean.mean) > 0)) return start + "it is zero";
  if (l.relative <= rule_->target())
    return start + say("%.2g %%, but on %.0f effective samples, or with a drift, or for one look only; raise turns",
                       known, l.mean.effective_samples);
  return start + say("%.2g %%; some %.0f turns would do", known, std::ceil(l.turns_needed / parts));
}

int FixViEltoRecord::read_each(const char* name) {
  bool found = false;
  for (Part& part : parts_)
    if (part.name == name) part.each = found = true;
  if (!found) error->fix_error(FLERR, this, "keyword each names no part given before it");
  return 1;
}

int FixViEltoRecord::read_energy(const std::string& value) {
  if (value != "on" && value != "off") error->fix_error(FLERR, this, "energy takes on or off");
  energy_ = value == "on";
  return 1;
}

void FixViEltoRecord::init() {
  FixViEltoRows::init();
  // LIGGGHTS writes a number of steps from 1e15 on with an exponent, and reads 1e+15 as 1
  if (turns_ > 0 && !(turns_ / (speed_ * update->dt) < 1e15))
    error->fix_error(FLERR, this, "more steps are asked for than LIGGGHTS can count; lower turns");
  if (!energy_) return;
  const vielto::Law& law = vielto::law_in_use(lmp, "fix vielto/record energy on");
  if (law.energies.empty())
    vielto::stop_all(lmp, ("vielto: law " + law.name + " keeps no energy accounts; leave energy off").c_str());
}

void FixViEltoRecord::pre_force(int vflag) {
  FixViEltoRows::pre_force(vflag);
  tally_.energy = energy_;
}

/* Torque times 2 pi n is a power only for a mesh that turns so: corners of a turning mesh have the velocity
   omega x (r - origin), known to round-off. */
void FixViEltoRecord::check_motion(const Part& part, const Mesh& mesh) const {
  typedef MultiVectorContainer<double, 3, 3> Corners;
  TriMesh* const triangles = mesh.fix->triMesh();
  Corners* const velocities = triangles->prop().getElementProperty<Corners>("v");
  const double omega = 2 * M_PI * speed_;
  double mine[3] = {0, 0, 0}, most[3];  // greatest: speed, speed of a corner that turns as told, difference of both
  const double still[3] = {0, 0, 0};    // a mesh that nothing moves keeps no velocities
  for (int i = 0; i < triangles->sizeLocal(); i++)
    for (int k = 0; k < 3; k++) {
      double r[3], turned[3], off[3];
      triangles->node(i, k, r);
      for (int d = 0; d < 3; d++) r[d] -= origin_[d];
      cross3(axis_, r, turned);
      const double* const v = velocities ? velocities->begin()[i][k] : still;
      for (int d = 0; d < 3; d++) off[d] = v[d] - omega * turned[d];
      mine[0] = std::max(mine[0], std::sqrt(dot3(v, v)));
      mine[1] = std::max(mine[1], omega * std::sqrt(dot3(turned, turned)));
      mine[2] = std::max(mine[2], std::sqrt(dot3(off, off)));
    }
  MPI_Allreduce(mine, most, 3, MPI_DOUBLE, MPI_MAX, world);
  const bool moves = most[0] > 1e-9 * most[1] && most[0] > 0;
  char line[500];
  if (!moves) {
    if (part.stands || !(most[1] > 0)) return;
    snprintf(line, sizeof line,
             "Warning: mesh %s of part %s stands still, but its torque counts as the rotor's; write 'standing %s ...' "
             "for what does not turn\n",
             mesh.id.c_str(), part.name.c_str(), part.name.c_str());
    say(line);
    return;
  }
  if (!part.stands && most[2] <= 1e-3 * most[1]) return;
  if (part.stands)
    snprintf(line, sizeof line,
             "vielto: mesh %s of part %s moves (its fastest corner at %.4g m/s), but %s is a part that stands still; "
             "give it as part with another name than drum",
             mesh.id.c_str(), part.name.c_str(), most[0], part.name.c_str());
  else
    snprintf(line, sizeof line,
             "vielto: mesh %s of part %s does not turn as fix %s says, at speed %.6g 1/s about axis %g %g %g through "
             "origin %g %g %g: its fastest corner moves at %.4g m/s instead of %.4g, and corners differ by up to %.4g "
             "m/s; speed is 1/period of fix move/mesh (turns in a second, not rad/s), and axis and origin are its own",
             mesh.id.c_str(), part.name.c_str(), id, speed_, axis_[0], axis_[1], axis_[2], origin_[0], origin_[1],
             origin_[2], most[0], most[1], most[2]);
  vielto::stop_all(lmp, line);
}

void FixViEltoRecord::say(const char* line) const {
  for (FILE* to : {screen, logfile})
    if (to && comm->me == 0) fprintf(to, "%s", line);
}

void FixViEltoRecord::check_motions() {
  char line[100];
  snprintf(line, sizeof line, "Warning: speed is %.6g 1/s; is that 1/min? Speeds are in 1/s\n", speed_);
  if (speed_ > kFastest) say(line);
  for (const Part& part : parts_)
    for (const Mesh& mesh : part.meshes) check_motion(part, mesh);
  motionChecked_ = true;
}

void FixViEltoRecord::add_step() {
  if (!motionChecked_) check_motions();
  double rotor = 0;
  for (Part& part : parts_) {
    add_force(part);
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
      }
      cross3(arm, F, moved);
      const double torque = -(dot3(T, axis_) + dot3(moved, axis_));
      mesh.torque += torque;
      partTorque += torque;
    }
    part.torque += partTorque;
    if (!part.stands) rotor += partTorque;
    check_torque(part, partTorque);
  }
  work_ += rotor * 2 * M_PI * speed_ * update->dt;
  if (sampling()) gravity_ += gravity_moment();
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
           "vielto: step " BIGINT_FORMAT
           " (turn %.3f): torque of %s is %.4g N m, over the limit of %.4g N m (maxTorque); the "
           "greatest wall force, %.4g N, acts on grain %d",
           update->ntimestep, turn(), part.name.c_str(), torque, maxTorque_, most.force, most.grain);
  vielto::stop_all(lmp, line);
}

double FixViEltoRecord::gravity_moment() const {
  FixGravity* fix = static_cast<FixGravity*>(modify->find_fix_style("gravity", 0));
  if (!fix) return 0;
  double g[3], moment = 0;
  fix->get_gravity(g);
  vielto::each_mass(modify, atom, [&](double mass, const double* x) {
    double arm[3], m[3];
    for (int d = 0; d < 3; d++) arm[d] = x[d] - origin_[d];
    cross3(arm, g, m);
    moment += mass * dot3(m, axis_);
  });
  return moment;
}

double FixViEltoRecord::potential_energy() const {
  FixGravity* fix = static_cast<FixGravity*>(modify->find_fix_style("gravity", 0));
  double g[3] = {0, 0, 0}, sum = 0;
  if (fix) fix->get_gravity(g);
  vielto::each_mass(modify, atom, [&](double mass, const double* x) { sum -= mass * dot3(x, g); });
  return total(sum);
}

std::string FixViEltoRecord::when() const {
  char text[40];
  snprintf(text, sizeof text, "turn %.3f", turn());
  return text;
}

void FixViEltoRecord::clear_interval() {
  FixViEltoRows::clear_interval();
  for (Part& part : parts_) {
    part.torque = 0;
    for (Mesh& mesh : part.meshes) mesh.torque = 0;
  }
  gravity_ = 0;
}

std::string FixViEltoRecord::header_end() {
  char speed[40];
  snprintf(speed, sizeof speed, "# speed=%.10g\n", speed_);
  std::string text = speed;
  if (turnParts_ > 1) text += "# turn_parts=" + std::to_string(turnParts_) + "\n";
  for (const bool stands : {false, true}) {
    std::string names;
    for (const Part& part : parts_)
      if (part.stands == stands) names += (names.empty() ? "" : " ") + part.name;
    if (!names.empty()) text += std::string(stands ? "# standing=" : "# turning=") + names + "\n";
  }
  text += "step,time_s,turn,idle_Nm";
  for (const Part& part : parts_) text += "," + part.name + "_Nm";
  for (const Part& part : parts_)
    for (const char* d : {"x", "y", "z"}) text += "," + part.name + "_F" + d + "_N";
  for (const Part& part : parts_) {
    if (!part.each) continue;
    std::string single = part.name;
    if (!single.empty() && single.back() == 's') single.pop_back();
    for (std::size_t k = 1; k <= part.meshes.size(); k++) text += "," + single + std::to_string(k) + "_Nm";
  }
  text += ",gravity_Nm,overlap_mean,overlap_max,contacts,grains,kinetic_J";
  if (energy_)
    text +=
        ",work_J,elastic_J,potential_J,diss_normal_J,diss_tangential_J,diss_sliding_J,diss_rolling_J,diss_twisting_J";
  return text;
}

std::string FixViEltoRecord::row() {
  lastRotor_ = lastStanding_ = 0;
  for (const Part& part : parts_) (part.stands ? lastStanding_ : lastRotor_) += part.torque / steps_;

  const std::mt19937::result_type key[2] = {static_cast<std::mt19937::result_type>(idleSeed_),
                                            static_cast<std::mt19937::result_type>(update->ntimestep / every_)};
  std::seed_seq seed(key, key + 2);
  std::mt19937 random(seed);
  const double idle = idle_ * (1 + idleNoise_ * std::normal_distribution<double>()(random));

  std::vector<double> values = {elapsed(), turn(), idle};
  for (const Part& part : parts_) values.push_back(part.torque / steps_);
  for (const Part& part : parts_)
    for (double f : part.force) values.push_back(f / steps_);
  for (const Part& part : parts_)
    if (part.each)
      for (const Mesh& mesh : part.meshes) values.push_back(mesh.torque / steps_);
  values.push_back(samples_ ? total(gravity_) / samples_ : 0);
  for (double value : overlaps()) values.push_back(value);
  values.push_back(kinetic_energy());
  if (energy_)
    for (double value :
         {work_, total(tally_.elastic), potential_energy(), total(tally_.normalDamping),
          total(tally_.tangentialDamping), total(tally_.sliding), total(tally_.rolling), total(tally_.twisting)})
      values.push_back(value);
  return columns(values);
}

std::string FixViEltoRecord::progress() {
  if (!(turns_ > 0)) return "";
  char line[100];
  snprintf(line, sizeof line, "turn %.2f of %.2f, rotor %.3f N m", turn(), turns_, lastRotor_);
  return line;
}

double FixViEltoRecord::compute_vector(int n) {
  const double values[5] = {turn(), lastRotor_, lastStanding_, overlapMaxEver_, dtOverTc_};
  return values[n];
}

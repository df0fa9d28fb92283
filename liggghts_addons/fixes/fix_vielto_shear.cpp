// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/fix_vielto_shear.h"

#include <cmath>

#include "atom.h"
#include "error.h"
#include "fixes/fix_vielto_plate.h"
#include "modify.h"

using namespace LAMMPS_NS;

FixViEltoShear::FixViEltoShear(LAMMPS* lammps, int narg, char** arg) : FixViEltoRows(lammps, narg, arg) {
  size_vector = 3;
  Keywords own;
  own["mover"] = [&](int i) { return mover_ = arg[i + 1], 1; };
  own["velocity"] = [&](int i) { return velocity_ = number(arg, i + 1), 1; };
  own["displacement"] = [&](int i) { return whole_ = number(arg, i + 1), 1; };
  own["floor"] = [&](int i) { return floor_ = number(arg, i + 1), 1; };
  own["area"] = [&](int i) { return area_ = number(arg, i + 1), 1; };
  parse(narg, arg, own);
  const char* names[3] = {"lower", "upper", "plate"};
  for (std::size_t k = 0; k < 3; k++)
    if (parts_.size() != 3 || parts_[k].name != names[k])
      error->fix_error(FLERR, this, "takes three parts in this order: lower, upper, plate");
  if (!(velocity_ > 0)) error->fix_error(FLERR, this, "velocity V > 0 is required");
  if (!(area_ > 0)) error->fix_error(FLERR, this, "area A > 0 is required");
}

void FixViEltoShear::init() {
  FixViEltoRows::init();
  plate_ = dynamic_cast<FixViEltoPlate*>(modify->find_fix_id(mover_.c_str()));
  if (!plate_) error->fix_error(FLERR, this, "mover names no fix vielto/plate");
}

void FixViEltoShear::setup(int vflag) {
  // the plate's own setup comes first: its fix is older
  if (!restarted_ && watch_.grains() < 0) startHeight_ = plate_->height();
  FixViEltoRows::setup(vflag);
  double mine = 0;
  for (int i = 0; i < atom->nlocal; i++) mine += 4.0 / 3.0 * M_PI * std::pow(atom->radius[i], 3);
  solids_ = total(mine);
}

void FixViEltoShear::add_step() {
  for (Part& part : parts_) add_force(part);
  heightSum_ += plate_->height();
  velocitySum_ += plate_->velocity();
}

void FixViEltoShear::clear_interval() {
  FixViEltoRows::clear_interval();
  heightSum_ = velocitySum_ = 0;
}

std::string FixViEltoShear::when() const {
  char text[40];
  snprintf(text, sizeof text, "displacement %.4g m", displacement());
  return text;
}

std::string FixViEltoShear::header_end() {
  std::string text = "step,time_s,displacement_m";
  for (const Part& part : parts_)
    for (const char* d : {"x", "y", "z"}) text += "," + part.name + "_F" + d + "_N";
  return text +
         ",plate_position_m,plate_velocity_m_s,dilation_m,porosity,overlap_mean,overlap_max,contacts,grains,kinetic_J";
}

std::string FixViEltoShear::row() {
  lastForce_ = parts_[0].force[0] / steps_;
  const double height = heightSum_ / steps_;
  std::vector<double> values = {elapsed(), displacement()};
  for (const Part& part : parts_)
    for (double f : part.force) values.push_back(f / steps_);
  for (double value : {height, velocitySum_ / steps_, height - startHeight_, 1 - solids_ / (area_ * (height - floor_))})
    values.push_back(value);
  for (double value : overlaps()) values.push_back(value);
  values.push_back(kinetic_energy());
  return columns(values);
}

std::string FixViEltoShear::progress() {
  char line[100];
  snprintf(line, sizeof line, "displacement %.3f of %.3f mm, shear force %.2f N", 1e3 * displacement(), 1e3 * whole_,
           lastForce_);
  return line;
}

double FixViEltoShear::compute_vector(int n) {
  const double values[3] = {displacement(), lastForce_, overlapMaxEver_};
  return values[n];
}

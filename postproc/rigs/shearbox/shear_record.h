// SPDX-License-Identifier: GPL-2.0-or-later
// Record of a direct shear test `shear.csv`, schema 1: lines `# key=value`, a header, then rows of means over equal
// intervals of steps (record_file.h). Forces: what the part exerts on the grains, N; the lower half is driven along +x,
// so that lower_Fx_N is the shear force. displacement_m is the end of the interval, the plate's columns are means.
//
// Errors: BadInput as record_file.h, and for steps that do not follow each other by interval_steps, no rows.
#pragma once

#include <string>
#include <vector>

#include "rigs/run_result.h"

namespace vielto {

struct ShearRecordHeader : RunHeader {
  double normal_stress = 0;   // Pa, weight of the load plate over the area
  double shear_velocity = 0;  // m/s
  double plate_mass = 0;      // kg
  double gravity = 0;         // m/s2
  double area = 0;            // m2
  double density = 0;         // kg/m3, of a grain
  double dt = 0;              // s
  double interval_steps = 0;

  double plate_weight() const { return plate_mass * gravity; }  // N
};

struct ShearRecord {
  std::string path;
  ShearRecordHeader header;
  // One value a row, SI units.
  std::vector<double> displacement, shear_force, upper_force, plate_side_force;  // the last two along x
  std::vector<double> plane_force;  // normal to the shear plane: mean of what both halves carry
  std::vector<double> plate_force;  // of the grains on the plate, upwards
  std::vector<double> plate_velocity, dilation, porosity, overlap_mean, overlap_max;
  double first_grains = 0, last_grains = 0;
};

ShearRecord read_shear_record(const std::string& path);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/shearbox/shear_record.h"

#include <fmt/format.h>

#include "core/bad_input.h"
#include "core/record_file.h"

namespace vielto {
namespace {

ShearRecordHeader parse_header(const Keys& keys) {
  ShearRecordHeader h;
  read_run_header(keys, h);
  h.normal_stress = keys.number("normal_stress", 0, true);
  h.shear_velocity = keys.number("shear_velocity", 0, true);
  h.plate_mass = keys.number("plate_mass", 0, true);
  h.gravity = keys.number("gravity", 0, true);
  h.area = keys.number("area", 0, true);
  h.density = keys.number("density", 0, true);
  h.dt = keys.number("dt", 0, true);
  h.interval_steps = keys.integer("interval_steps", 1);
  return h;
}

}  // namespace

ShearRecord read_shear_record(const std::string& path) {
  RecordFile file(path, "a run folder or its shear.csv");
  const Columns& c = file.columns();
  ShearRecord r;
  r.path = path;
  r.header = parse_header(file.keys());

  const std::size_t step = c.at("step"), grains = c.at("grains");
  const std::size_t lower_z = c.at("lower_Fz_N"), upper_z = c.at("upper_Fz_N"), plate_z = c.at("plate_Fz_N");
  const std::vector<std::pair<std::size_t, std::vector<double>*>> kept = {
      {c.at("displacement_m"), &r.displacement},
      {c.at("lower_Fx_N"), &r.shear_force},
      {c.at("upper_Fx_N"), &r.upper_force},
      {c.at("plate_Fx_N"), &r.plate_side_force},
      {c.at("plate_velocity_m_s"), &r.plate_velocity},
      {c.at("dilation_m"), &r.dilation},
      {c.at("porosity"), &r.porosity},
      {c.at("overlap_mean"), &r.overlap_mean},
      {c.at("overlap_max"), &r.overlap_max}};
  double expected = 0;
  std::vector<double> row;
  while (file.next_row(row)) {
    if (r.displacement.empty()) {
      expected = row[step];
      r.first_grains = row[grains];
    }
    if (row[step] != expected)
      throw BadInput(path, file.line(), "step", fmt::format("is {} where {} follows", row[step], expected),
                     "keep every row, interval_steps apart");
    expected += r.header.interval_steps;
    r.last_grains = row[grains];
    for (const auto& [column, to] : kept) to->push_back(row[column]);
    r.plate_force.push_back(-row[plate_z]);
    r.plane_force.push_back(0.5 * (row[lower_z] - row[upper_z] - row[plate_z]));
  }
  if (r.displacement.empty()) throw BadInput(path, 0, "holds no row", "run the case again");
  return r;
}

}  // namespace vielto

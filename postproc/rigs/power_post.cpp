// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/power_post.h"

#include <cstdio>
#include <optional>

#include "rigs/mixing_power.h"
#include "rigs/mixing_power_output.h"
#include "rigs/rig_picture.h"
#include "rigs/torque_picture.h"
#include "rigs/torque_record.h"

namespace vielto {
namespace {

void draw_grains(const TorqueRecord& record, const std::string& run, const std::string& path) {
  const TurningRotor rotor = turning_rotor(record);
  if (!has_dump(run) || !draw_rig(run, &rotor, path))
    std::fprintf(stderr, "vielto: no picture of the grains: %s holds no vtk/*.vtk or no mesh/*.stl\n",
                 run.empty() ? "the folder" : run.c_str());
}

}  // namespace

PostResult post_power(const PostInput& input) {
  const TorqueRecord loaded = read_torque_record(input.record);
  std::optional<TorqueRecord> idle;
  if (!input.idle.empty()) idle = read_torque_record(input.idle);
  const MixingPower power = mixing_power(loaded, idle ? &*idle : nullptr, input.turns);
  PostResult result;
  result.rows = power_observations(power, input.label_or(default_test_name(power)));
  result.table = power_table(power);
  result.numbers = power_json(power);
  result.files = {{"phase.csv", phase_csv(power)}};
  result.pictures = {
      {"torque.png", [loaded, power](const std::string& path) { draw_torque(loaded, power, path); }},
      {"grains.png", [loaded, run = input.run()](const std::string& path) { draw_grains(loaded, run, path); }}};
  result.film = [rotor = turning_rotor(loaded), run = input.run()](const std::string& path) {
    draw_film(run, &rotor, path);
  };
  result.warnings = power.quality.warnings;
  return result;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Torque record -> power, numbers, phase curves, observation rows, pictures.
#include <cstdio>
#include <optional>

#include "core/csv.h"
#include "post.h"
#include "rigs/mixer/mixer_picture.h"
#include "rigs/mixer/mixing_power.h"
#include "rigs/mixer/mixing_power_output.h"
#include "rigs/mixer/torque_record.h"

namespace vielto {

namespace fs = std::filesystem;

void post_mixer(const fs::path& path, const PostOptions& options) {
  const TorqueRecord loaded = read_torque_record(path.string());
  std::optional<TorqueRecord> idle;
  if (!options.idle.empty()) idle = read_torque_record(record_path(options.idle).string());
  const MixingPower power = mixing_power(loaded, idle ? &*idle : nullptr, options.turns);

  TestLabel label = options.label;
  if (label.test.empty()) label.test = default_test_name(power);
  const fs::path folder = path.parent_path() / "post";
  fs::create_directories(folder);
  const std::string table = power_table(power);
  const std::string json = power_json(power).dump(2) + "\n";
  // First what may still be refused.
  write_observations((folder / "observations.csv").string(), power_observations(power, label));
  write_whole_file((folder / "phase.csv").string(), phase_csv(power));
  write_whole_file((folder / "table.txt").string(), table);
  write_whole_file((folder / "power.json").string(), json);
  if (options.pictures) {
    draw_torque(loaded, power, (folder / "torque.png").string());
    const std::string run = path.parent_path().string();
    const TurningRotor rotor = turning_rotor(loaded);
    const bool grains = has_dump(run) && fs::exists(fs::path(run) / "mesh/drum.stl");
    if (!grains || !draw_rig(run, &rotor, (folder / "grains.png").string()))
      std::fprintf(stderr, "vielto: no picture of the grains: %s holds no vtk/*.vtk or no mesh/drum.stl\n",
                   run.empty() ? "the folder" : run.c_str());
  }
  for (const std::string& warning : power.quality.warnings)
    std::fprintf(stderr, "vielto: WARNING: %s: %s\n", path.string().c_str(), warning.c_str());
  std::fputs((options.json ? json : table).c_str(), stdout);
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// vielto post RUN [--idle IDLERUN]: torque record -> power, numbers, phase curves, observation rows, pictures, in
// RUN/post.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "csv.h"
#include "mixing_power.h"
#include "mixing_power_output.h"
#include "picture.h"
#include "steady_part.h"
#include "torque_record.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

struct PostOptions {
  std::string run, idle;
  int turns = kLeastAveragedTurns;
  bool json = false, pictures = false;
  TestLabel label{"", "fit", "", {}};
};

// A run folder stands for the record in it.
fs::path record_path(const std::string& run) {
  const fs::path path(run);
  return fs::is_directory(path) ? path / "torque.csv" : path;
}

void post(const PostOptions& options) {
  if (options.pictures) need_display();
  const fs::path path = record_path(options.run);
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
    if (!draw_grains(run, loaded, (folder / "grains.png").string()))
      std::fprintf(stderr, "vielto: no picture of the grains: %s holds no vtk/*.vtk or no mesh/drum.stl\n",
                   run.empty() ? "the folder" : run.c_str());
  }
  for (const std::string& warning : power.quality.warnings)
    std::fprintf(stderr, "vielto: WARNING: %s: %s\n", path.string().c_str(), warning.c_str());
  std::fputs((options.json ? json : table).c_str(), stdout);
}

}  // namespace

void add_post_command(CLI::App& app) {
  auto options = std::make_shared<PostOptions>();
  CLI::App* command =
      app.add_subcommand("post", "mixing power, its uncertainty and its numbers from a run's torque record");
  command->add_option("RUN", options->run, "run folder, or its torque.csv")->required();
  command->add_option("--idle", options->idle, "run folder or torque.csv of the empty machine at the same speed");
  command->add_option("--turns", options->turns, "steady whole turns asked for")
      ->check(CLI::Range(kLeastAveragedTurns, 1000000))
      ->capture_default_str();
  command->add_option("--test", options->label.test,
                      "name of the test in observations.csv (default: from speed and fill)");
  command->add_option("--role", options->label.role, "role of the test")
      ->check(CLI::IsMember({"fit", "check"}))
      ->capture_default_str();
  command->add_option("--wall", options->label.wall, "wall, for observations.csv");
  command->add_option("--moisture", options->label.moisture, "moisture (wet basis), for observations.csv")
      ->check(CLI::Range(0.0, 1.0));
  command->add_flag("--pictures", options->pictures, "also draw post/torque.png and post/grains.png");
  command->add_flag("--json", options->json, "print power.json instead of the table");
  command->callback([options] { post(*options); });
}

}  // namespace vielto

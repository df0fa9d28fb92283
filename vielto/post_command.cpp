// SPDX-License-Identifier: GPL-2.0-or-later
// vielto post RUN [--idle IDLERUN]: a run's record -> numbers with uncertainty, observation rows, pictures, in
// RUN/post.
#include <memory>
#include <string>

#include "commands.h"
#include "core/bad_input.h"
#include "core/record_file.h"
#include "core/rig_table.h"
#include "picture/render.h"
#include "post.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

void post(const PostOptions& options) {
  if (options.pictures) need_display();
  const fs::path path = record_path(options.run);
  const std::string rig = record_rig(path.string());
  if (rig != "mixer" && !options.idle.empty())
    throw BadInput("--idle", 0, "is for a mixer; this is a record of rig " + rig, "leave it out");
  if (rig == "mixer")
    post_mixer(path, options);
  else if (rig == "shearbox")
    post_shear(path, options);
  else if (rig == "repose")
    post_repose(path, options);
  else if (rig == "drum")
    post_drum(path, options);
  else
    throw BadInput(path.string(), 0, "the record is of rig '" + rig + "'", "name a record of " + rig_names());
}

}  // namespace

fs::path record_path(const std::string& run) {
  const fs::path path(run);
  if (!fs::is_directory(path)) return path;
  for (const RigDescription& rig : apparatuses())
    if (!rig.record.empty() && fs::exists(path / rig.record)) return path / rig.record;
  throw BadInput(run, 0, "holds no record of a rig", "name a run folder with " + record_names());
}

void add_post_command(CLI::App& app) {
  auto options = std::make_shared<PostOptions>();
  CLI::App* command = app.add_subcommand("post",
                                         "from a run's record: mixing power and its numbers, shear stress and "
                                         "friction, angle of repose or of a bed in a drum");
  command->add_option("RUN", options->run, "run folder, or the record in it (" + record_names() + ")")->required();
  command->add_option("--idle", options->idle, "run folder or torque.csv of the empty machine at the same speed");
  command->add_option("--turns", options->turns, "steady whole turns asked for")
      ->check(CLI::Range(kLeastAveragedTurns, 1000000))
      ->capture_default_str();
  command->add_option("--test", options->label.test,
                      "name of the test in observations.csv (default: from the conditions)");
  command->add_option("--role", options->label.role, "role of the test")
      ->check(CLI::IsMember({"fit", "check"}))
      ->capture_default_str();
  command->add_option("--wall", options->label.wall, "wall, for observations.csv");
  command->add_option("--moisture", options->label.moisture, "moisture (wet basis), for observations.csv")
      ->check(CLI::Range(0.0, 1.0));
  command->add_flag("--pictures", options->pictures, "also draw pictures into post/");
  command->add_flag("--json", options->json, "print the numbers as JSON instead of the table");
  command->callback([options] { post(*options); });
}

}  // namespace vielto

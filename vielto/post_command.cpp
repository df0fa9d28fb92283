// SPDX-License-Identifier: GPL-2.0-or-later
// vielto post RUN [--idle IDLERUN]: a run's record -> numbers with uncertainty, observation rows, pictures, in
// RUN/post.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "core/bad_input.h"
#include "core/record_file.h"
#include "core/rig_table.h"
#include "picture/film.h"
#include "picture/render.h"
#include "rigs/rig_code.h"
#include "row_options.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

struct PostOptions {
  PostInput input;
  bool json = false, pictures = false, film = false;
};

// A run folder stands for the record in it.
std::string record_path(const std::string& run) {
  const fs::path path(run);
  if (!fs::is_directory(path)) return run;
  for (const RigDescription& rig : apparatuses())
    if (!rig.record.empty() && fs::exists(path / rig.record)) return (path / rig.record).string();
  throw BadInput(run, 0, "holds no record of a rig", "name a run folder with " + record_names());
}

void post(const PostOptions& options) {
  if (options.pictures || options.film) need_display();
  if (options.film) need_film_program();
  PostInput input = options.input;
  input.record = record_path(input.record);
  const std::string name = record_rig(input.record);
  const RigDescription* rig = find_rig(name);
  const RigCode* code = find_rig_code(name);
  if (!rig || !code)
    throw BadInput(input.record, 0, "the record is of rig '" + name + "'", "name a record of " + rig_names());
  if (!code->takes_idle && !input.idle.empty())
    throw BadInput("--idle", 0, "is for a mixer; this is a record of rig " + name, "leave it out");
  if (!input.idle.empty()) input.idle = record_path(input.idle);
  const PostResult result = code->post(input);
  write_post(result, *rig, (fs::path(input.run()) / "post").string(), options.pictures);
  if (options.film) result.film((fs::path(input.run()) / "post/grains.webm").string());
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "vielto: WARNING: %s: %s\n", input.record.c_str(), warning.c_str());
  std::fputs((options.json ? result.numbers_text() : result.table).c_str(), stdout);
}

}  // namespace

void add_post_command(CLI::App& app) {
  auto options = std::make_shared<PostOptions>();
  CLI::App* command = app.add_subcommand("post",
                                         "from a run's record: mixing power and its numbers, shear stress and "
                                         "friction, angle of repose or of a bed in a drum");
  command->add_option("RUN", options->input.record, "run folder, or the record in it (" + record_names() + ")")
      ->required();
  command->add_option("--idle", options->input.idle, "run folder or torque.csv of the empty machine at the same speed");
  command
      ->add_option("--turns", options->input.turns,
                   fmt::format("steady whole turns asked for; default {}, and {} of a run that ended when its power "
                               "was known",
                               kLeastAveragedTurns, kLeastPartTurns))
      ->check(CLI::Range(kLeastAveragedTurns, 1000000));
  command->add_option("--test", options->input.label.test,
                      "name of the test in observations.csv (default: from the conditions)");
  add_role_option(command, options->input.label.role);
  command->add_option("--wall", options->input.label.wall, "wall, for observations.csv");
  command->add_option("--moisture", options->input.label.moisture, "moisture (wet basis), for observations.csv")
      ->check(CLI::Range(0.0, 1.0));
  command->add_flag("--pictures", options->pictures, "also draw pictures into post/");
  command->add_flag("--animation", options->film,
                    "also draw every dump of the grains, of a mixer those of the last turn, as a film (needs ffmpeg)");
  command->add_flag("--json", options->json, "print the numbers as JSON instead of the table");
  command->callback([options] { post(*options); });
}

}  // namespace vielto

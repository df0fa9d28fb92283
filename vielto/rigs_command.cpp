// SPDX-License-Identifier: GPL-2.0-or-later
// vielto rigs [--json]: the one table of rigs, what they observe and under which conditions.
#include <cstdio>
#include <memory>

#include "commands.h"
#include "core/rig_table.h"

namespace vielto {

void add_rigs_option(CLI::App* command) {
  command->add_option("--rigs", "table of rigs of your own, in the form of cases/rigs.toml")
      ->type_name("FILE")
      ->each([](const std::string& file) { add_rigs(file); });
}

void add_rigs_command(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("rigs", "the rigs: script, record, conditions with their -var, observables with their units");
  command->add_flag("--json", *json, "print JSON, with the files a run is made from and what it costs");
  add_rigs_option(command);
  command->callback(
      [json] { std::fputs((*json ? rig_table_json().dump(2) + "\n" : rig_table_text()).c_str(), stdout); });
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Options of commands that write rows of an observation table: what a row may be used for, where it goes, and what is
// known of the test.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "core/observation_table.h"

namespace vielto {

inline void add_role_option(CLI::App* command, Role& role, const std::string& what = "role of the test") {
  const auto set = [&role](const std::string& text) { role = *role_of(text); };
  command->add_option_function<std::string>("--role", set, what)
      ->check(CLI::IsMember({text_of(Role::fit), text_of(Role::check)}))
      ->default_str(text_of(role));
}

struct RowOptions {
  std::string out;
  bool append = false;
  Observation row;  // test, role and conditions

  void add_to(CLI::App* command) {
    command->add_option("--out", out, "the observation table to write")->required();
    command->add_flag("--append", append, "keep the rows that it holds already");
    command->add_option("--test", row.test, "name of the test")->required();
    add_role_option(command, row.role);
    command->add_option("--speed", row.speed, "1/s, turns a second")->check(CLI::PositiveNumber);
    command->add_option("--fill", row.fill, "drum loading factor")->check(CLI::Range(0.0, 1.0));
    command->add_option("--moisture", row.moisture, "wet basis")->check(CLI::Range(0.0, 1.0));
    command->add_option("--wall", row.wall, "name of the wall's material");
    command->add_option("--material", row.material, "name of the grain");
  }

  // The rows that the table keeps.
  std::vector<Observation> earlier() const {
    return append && std::filesystem::exists(out) ? read_observations(out) : std::vector<Observation>();
  }
};

}  // namespace vielto

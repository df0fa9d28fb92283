// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of the program `vielto`. Each function adds one subcommand with its options and callback;
// a new command costs one NAME_command.cpp, one declaration here and one line in main.cpp.
#pragma once

#include <CLI/CLI.hpp>

namespace vielto {

void add_geometry_command(CLI::App& app);
void add_post_command(CLI::App& app);
void add_fit_command(CLI::App& app);
void add_predict_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_gap_command(CLI::App& app);
void add_import_command(CLI::App& app);
void add_import_logger(CLI::App& import);
void add_import_surface(CLI::App& import);
void add_report_command(CLI::App& app);
void add_rigs_command(CLI::App& app);

// --rigs FILE of a command that reads observation tables or makes runs.
void add_rigs_option(CLI::App* command);
void add_copy_command(CLI::App& app);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of the program `vielto`: each function adds one subcommand with its options and callback. A new command
// costs NAME_command.cpp and its name in CMakeLists.txt, a new import import_NAME_command.cpp and its name there.
#pragma once

#include <CLI/CLI.hpp>

#include "command_list.h"

namespace vielto {

#define COMMAND(name) void add_##name##_command(CLI::App& app);
VIELTO_COMMANDS
#undef COMMAND

#define IMPORT(name) void add_import_##name(CLI::App& import);
VIELTO_IMPORTS
#undef IMPORT

// --rigs FILE of a command that reads observation tables or makes runs.
void add_rigs_option(CLI::App* command);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// What the script command asks of the program's own command line and of a parameter's words.
#ifndef VIELTO_COMMAND_LINE_H
#define VIELTO_COMMAND_LINE_H

#include <string>
#include <vector>

namespace vielto {

// The whole command line, quoted as a shell reads it back.
std::string command_line();

// Names given with -var (or -v).
std::vector<std::string> names_on_command_line();

// The first name that was given several values with -var: LIGGGHTS would take the first one. Empty if there is none.
std::string several_values_on_command_line();

// The input script: after -in (or -i), or the file on the standard input; empty if there is none.
std::string script_on_command_line();

bool is_number(const std::string& text);

// The words a parameter may take, from its unit field: "off or on", "uniform, alternating or mirrored".
std::vector<std::string> choices(const std::string& unit);

}  // namespace vielto

#endif

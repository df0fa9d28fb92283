// SPDX-License-Identifier: GPL-2.0-or-later
// Another program, started without a shell: no word of a file or of a user is ever read as a command.
#pragma once

#include <string>
#include <vector>

namespace vielto {

struct ProgramPlace {
  std::string folder = {};  // to run in; empty: this one
  std::string log = {};     // what it prints is appended here; empty: to this program's own output
  int keep_open = -1;       // a file that stays open in it, such as a lock
};

// The exit status; 128 + N if signal N ended it, -1 if there is no such program in PATH.
int run_program(const std::vector<std::string>& words, const ProgramPlace& place = {});

}  // namespace vielto

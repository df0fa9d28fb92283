// SPDX-License-Identifier: GPL-2.0-or-later
// The one exception for input a person can mend. Programs print it as a single line and exit 2.
#pragma once

#include <stdexcept>
#include <string>

namespace vielto {

// Purpose: say in one line where the fault is, what it is and how to mend it.
// `line` counts from 1; 0 means that the whole file is at fault. `column` names a CSV column or is empty.
class BadInput : public std::runtime_error {
 public:
  BadInput(const std::string& file, int line, const std::string& what, const std::string& mend);
  BadInput(const std::string& file, int line, const std::string& column, const std::string& what,
           const std::string& mend);
};

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/bad_input.h"

#include <fmt/format.h>

namespace vielto {
namespace {

std::string place(const std::string& file, int line, const std::string& column) {
  std::string text = file;
  if (line > 0) text += fmt::format(", line {}", line);
  if (!column.empty()) text += fmt::format(", column {}", column);
  return text;
}

}  // namespace

BadInput::BadInput(const std::string& file, int line, const std::string& what, const std::string& mend)
    : BadInput(file, line, "", what, mend) {}

BadInput::BadInput(const std::string& file, int line, const std::string& column, const std::string& what,
                   const std::string& mend)
    : std::runtime_error(fmt::format("{}: {}; {}", place(file, line, column), what, mend)) {}

}  // namespace vielto

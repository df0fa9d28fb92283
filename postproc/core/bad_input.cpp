// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/bad_input.h"

#include <fmt/format.h>

#include <string_view>

#include "core/csv.h"

namespace vielto {
namespace {

std::string place(const std::string& file, int line, const std::string& column) {
  std::string text = file;
  if (line > 0) text += fmt::format(", line {}", line);
  if (!column.empty()) text += fmt::format(", column {}", column);
  return text;
}

// A file's bytes are quoted in refusals; one that is no text must not move the terminal's cursor nor make two lines of
// one.
std::string plain(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t length = 1;
    while (length < 4 && i + length < text.size() && (static_cast<unsigned char>(text[i + length]) & 0xc0) == 0x80)
      ++length;
    if (is_plain_utf8(std::string_view(text).substr(i, length))) {
      result.append(text, i, length);
    } else {
      length = 1;
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
    }
    i += length;
  }
  return result;
}

}  // namespace

BadInput::BadInput(const std::string& file, int line, const std::string& what, const std::string& mend)
    : BadInput(file, line, "", what, mend) {}

BadInput::BadInput(const std::string& file, int line, const std::string& column, const std::string& what,
                   const std::string& mend)
    : std::runtime_error(plain(fmt::format("{}: {}; {}", place(file, line, column), what, mend))) {}

}  // namespace vielto

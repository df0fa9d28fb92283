// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/shell_word.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace vielto {

std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) { return c >= 128 || std::isalnum(c) || std::strchr("-_./:=,+@%", c); };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

}  // namespace vielto

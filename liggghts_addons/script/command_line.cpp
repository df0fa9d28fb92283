// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/command_line.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/par_range.h"
#include "core/shell_word.h"

namespace vielto {

std::string command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string text;
  for (std::string word; std::getline(in, word, '\0');) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

std::vector<std::string> names_on_command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> names;
  for (std::string word; std::getline(in, word, '\0');)
    if ((word == "-var" || word == "-v") && std::getline(in, word, '\0')) names.push_back(word);
  return names;
}

std::string several_values_on_command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string name;
  int values = 0;
  for (std::string word; std::getline(in, word, '\0');) {
    if ((word == "-var" || word == "-v") && std::getline(in, name, '\0')) {
      values = 0;
    } else if (word.rfind('-', 0) == 0 && !is_number(word)) {
      name.clear();
    } else if (!name.empty() && ++values == 2) {
      return name;
    }
  }
  return "";
}

std::string script_on_command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  for (std::string word; std::getline(in, word, '\0');)
    if ((word == "-in" || word == "-i") && std::getline(in, word, '\0')) return word;
  const std::filesystem::path input = "/proc/self/fd/0";
  std::error_code none;
  return std::filesystem::is_regular_file(input, none) ? std::filesystem::read_symlink(input).string() : "";
}

bool is_number(const std::string& text) { return parameter_number(text).has_value(); }

std::vector<std::string> choices(const std::string& unit) {
  if (unit.find(" or ") == std::string::npos) return {};
  std::istringstream words(unit);
  std::vector<std::string> list;
  for (std::string word; words >> word;)
    if (word != "or") list.push_back(word.back() == ',' ? word.substr(0, word.size() - 1) : word);
  return list;
}

}  // namespace vielto

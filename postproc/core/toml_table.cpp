// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/toml_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/bad_input.h"

namespace vielto {

TomlTable TomlTable::read(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw BadInput(path, 0, "cannot be read", "name an existing TOML file");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return parse(text.str(), path);
}

TomlTable TomlTable::parse(std::string_view text, const std::string& path) {
  try {
    return TomlTable(path, std::make_shared<const toml::table>(toml::parse(text, path)));
  } catch (const toml::parse_error& error) {
    throw BadInput(path, static_cast<int>(error.source().begin.line), std::string(error.description()),
                   "write it as TOML (toml.io)");
  }
}

void TomlTable::refuse(const std::string& key, const std::string& what, const std::string& mend) const {
  const toml::node* node = table_->get(key);
  const auto line = node ? node->source().begin.line : table_->source().begin.line;
  throw BadInput(path_, static_cast<int>(line), key, what, mend);
}

double TomlTable::number(const std::string& key, double low, double high) const {
  const toml::node* node = table_->get(key);
  if (!node) refuse(key, "is missing", fmt::format("state a number from {} to {}", low, high));
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) refuse(key, "is not a finite number", "write a number without quotes");
  if (*value < low || *value > high)
    refuse(key, fmt::format("{} is out of range", *value), fmt::format("state a number from {} to {}", low, high));
  return *value;
}

double TomlTable::number_or(const std::string& key, double fallback, double low, double high) const {
  return has(key) ? number(key, low, high) : fallback;
}

std::string TomlTable::text(const std::string& key) const {
  const auto value = (*table_)[key].value<std::string>();
  if (!value || value->empty()) refuse(key, has(key) ? "is no text" : "is missing", "state it in quotes");
  return *value;
}

std::vector<std::string> TomlTable::texts(const std::string& key) const {
  std::vector<std::string> result;
  if (!has(key)) return result;
  const toml::array* list = (*table_)[key].as_array();
  if (!list) refuse(key, "is no list of texts", fmt::format("write {} = [\"TEXT\"]", key));
  for (const toml::node& node : *list) {
    result.push_back(node.value_or<std::string>(""));
    if (result.back().empty()) refuse(key, "holds something that is no text", "write texts in quotes only");
  }
  return result;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> places;
  for (const auto& [key, node] : *table_) places.emplace_back(node.source().begin, std::string(key.str()));
  std::sort(places.begin(), places.end());
  std::vector<std::string> names;
  for (auto& place : places) names.push_back(std::move(place.second));
  return names;
}

TomlTable TomlTable::table(const std::string& key) const {
  const toml::table* found = (*table_)[key].as_table();
  if (!found) refuse(key, has(key) ? "is no table" : "is missing", fmt::format("add [{}]", key));
  return TomlTable(path_, std::shared_ptr<const toml::table>(table_, found));
}

void TomlTable::only(std::initializer_list<const char*> known) const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) == known.end())
      refuse(name, "is no key here", fmt::format("use {}", fmt::join(known, ", ")));
  }
}

}  // namespace vielto

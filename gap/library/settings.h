// SPDX-License-Identifier: GPL-2.0-or-later
// The numbers the diagnosis takes as given (libraries/diagnosis.toml says what each means), and how TOML files are read
// here.
//
// Errors: BadInput with file and line for a missing or unknown key, a value of another type or out of its range.
#pragma once

#include <toml++/toml.h>

#include <initializer_list>
#include <string>

namespace vielto::gap {

struct Settings {
  double prior_no_gap = 0, prior_single = 0, prior_pair = 0, prior_unknown = 0;  // sum 1
  double shape_error = 0, interaction = 0;
  double unknown_low = 0, unknown_high = 0, unknown_floor = 0;
  double false_alarm = 0, name_probability = 0, group_probability = 0, unknown_probability = 0, misfit_probability = 0;
  int draws = 0, libraries = 0;
  double group_distance = 0, detectable_distance = 0;
  double false_discovery_rate = 0;

  static Settings read(const std::string& path);
};

// A table of a TOML file with typed access that says where a fault is.
class TomlTable {
 public:
  // Reads the whole file.
  static TomlTable read(const std::string& path);
  TomlTable(std::string path, const toml::table& table) : path_(std::move(path)), table_(table) {}

  bool has(const std::string& key) const { return table_.contains(key); }
  double number(const std::string& key, double low, double high) const;
  double number_or(const std::string& key, double fallback, double low, double high) const;
  std::string text(const std::string& key) const;
  TomlTable table(const std::string& key) const;
  const toml::table& raw() const { return table_; }
  // Refuses every key that is not among `known`.
  void only(std::initializer_list<const char*> known) const;
  [[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& mend) const;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  toml::table table_;
};

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// How TOML files are read: a table with typed access that says where a fault is.
//
// Errors: BadInput with file, line and key for a missing or unknown key, a value of another type or out of its range.
#pragma once

#include <toml++/toml.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vielto {

class TomlTable {
 public:
  // Reads the whole file.
  static TomlTable read(const std::string& path);
  // The same from a text that `path` names in errors.
  static TomlTable parse(std::string_view text, const std::string& path);
  // A copy, which knows no lines: toml++ does not copy places.
  TomlTable(std::string path, const toml::table& table)
      : path_(std::move(path)), table_(std::make_shared<toml::table>(table)) {}

  bool has(const std::string& key) const { return table_->contains(key); }
  double number(const std::string& key, double low, double high) const;
  double number_or(const std::string& key, double fallback, double low, double high) const;
  std::string text(const std::string& key) const;
  // Empty if the key is not there.
  std::vector<std::string> texts(const std::string& key) const;
  TomlTable table(const std::string& key) const;
  // In the order of the file.
  std::vector<std::string> keys() const;
  const toml::table& raw() const { return *table_; }
  // Refuses every key that is not among `known`.
  void only(std::initializer_list<const char*> known) const;
  [[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& mend) const;
  const std::string& path() const { return path_; }

 private:
  TomlTable(std::string path, std::shared_ptr<const toml::table> table)
      : path_(std::move(path)), table_(std::move(table)) {}

  std::string path_;
  std::shared_ptr<const toml::table> table_;  // within the file's
};

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// What the records of all rigs have in common: lines `# key=value`, a line of column names, rows of numbers. Read as a
// stream, with one clear error (BadInput: file, line, column) for a missing key or column, a cut-off line, or a value
// that is not a finite number.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vielto {

// The lines `# key=value`, each asked for by name.
class Keys {
 public:
  explicit Keys(std::string path) : path_(std::move(path)) {}

  void add(std::string_view line, int number);

  bool has(const std::string& key) const { return values_.count(key) > 0; }
  std::string text(const std::string& key) const { return find(key).first; }
  double number(const std::string& key, double least, bool above = false) const;
  int integer(const std::string& key, int least) const;
  std::vector<double> numbers(const std::string& key) const;  // with spaces between them
  int line(const std::string& key) const { return find(key).second; }
  // Errors: BadInput for another one.
  void demand_schema(int schema) const;

 private:
  const std::pair<std::string, int>& find(const std::string& key) const;

  std::string path_;
  std::map<std::string, std::pair<std::string, int>> values_;
};

class Columns {
 public:
  Columns() = default;
  Columns(const std::string& path, int line, const std::string& text);
  std::size_t count() const { return names_.size(); }
  const std::string& name(std::size_t i) const { return names_[i]; }
  bool has(const std::string& name) const { return index_.count(name) > 0; }
  std::size_t at(const std::string& name) const;

 private:
  std::string path_;
  int line_ = 0;
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> index_;
};

class RecordFile {
 public:
  // `kind` tells in the error what to name instead: "a run folder or its torque.csv".
  RecordFile(const std::string& path, const std::string& kind);

  const Keys& keys() const { return keys_; }
  const Columns& columns() const { return columns_; }
  // False at the end of the file.
  bool next_row(std::vector<double>& row);
  int line() const { return line_; }  // of the last row

 private:
  std::string path_;
  std::ifstream in_;
  int line_ = 0;
  Keys keys_;
  Columns columns_;
  std::string text_;
  std::vector<std::string_view> fields_;
};

// The key `rig` of a record. Errors: BadInput if the file cannot be read or states none.
std::string record_rig(const std::string& path);

}  // namespace vielto

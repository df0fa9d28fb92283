// SPDX-License-Identifier: GPL-2.0-or-later
// Parameter files (`*.par`): LIGGGHTS include files of lines
//   variable NAME index VALUE # unit | range | standard uncertainty | source
// read here too, so that a number is stated in one place. The range is that of par_range.h; a line of three fields has
// none. Other lines that LIGGGHTS understands (blank lines, comments) are skipped; anything else is refused.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace vielto {

struct Parameter {
  std::string name;
  std::string value;
  std::string unit;
  std::string range;
  std::string u;
  std::string source;
  int line = 0;
};

class ParFile {
 public:
  // Errors: BadInput for a missing file, a line of another form, a range that is none, or a name stated twice.
  static ParFile read(const std::string& path);

  const std::string& path() const { return path_; }
  const std::vector<Parameter>& all() const { return parameters_; }
  // True if the first line says `provisional`: the card is not calibrated yet.
  bool provisional() const { return provisional_; }

  bool has(const std::string& name) const;
  // A value stated elsewhere (the command line's `-var`) wins over the file, as in LIGGGHTS.
  void override_value(const std::string& name, const std::string& value);

  // Errors: BadInput if the name is missing.
  const Parameter& find(const std::string& name) const;
  // Errors: BadInput if the name is missing or the value is not a finite number.
  double number(const std::string& name) const;
  double number_or(const std::string& name, double fallback) const;
  int integer(const std::string& name) const;
  const std::string& text(const std::string& name) const;

 private:
  std::string path_;
  bool provisional_ = false;
  std::vector<Parameter> parameters_;
  std::map<std::string, std::size_t> index_;
};

}  // namespace vielto

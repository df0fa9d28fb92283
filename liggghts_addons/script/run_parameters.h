// SPDX-License-Identifier: GPL-2.0-or-later
/* Parameters of a run: read from parameter files and the cards of grain and wall, overridden by -var, and checked.

   A value is, in this order: what was given (-var, or a variable that the script has set before); what the first of the
   files that names it says; with the value `card` what the card of the grain says, or for wall_NAME what the wall's
   card says of NAME. The grain's other quantities are parameters too. */
#ifndef VIELTO_RUN_PARAMETERS_H
#define VIELTO_RUN_PARAMETERS_H

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/par_file.h"

namespace vielto {

class RunParameters {
 public:
  // The value a name was given, or nothing.
  using Given = std::function<std::optional<std::string>(const std::string& name)>;

  explicit RunParameters(const Given& given) : given_(given) {}

  // Errors: BadInput as ParFile::read.
  void read(const std::string& par_file);
  // A parameter, unless a file has stated one of its name before.
  void add(const Parameter& stated, const std::string& file);
  // The cards MATERIALS/GRAIN.par and MATERIALS/WALL.par that the parameters grain, wall and materials name.
  // Errors: BadInput for a missing card, or one that lacks a value `card` asks for.
  void read_cards();
  // Puts `value` in the place of what the files say; what was given stays.
  void set(const std::string& name, const std::string& value);

  bool has(const std::string& name) const { return index_.count(name) > 0; }
  // Errors: BadInput if there is no such parameter.
  const std::string& value(const std::string& name) const;

  // Throws BadInput for the first of these names that is no parameter.
  void check_names(const std::vector<std::string>& names) const;
  /* Throws std::invalid_argument for the first value that is no number where one is due, none of the words allowed, or
     out of its range. `derived`: further names for bounds, of the mesh. */
  void check_values(const std::map<std::string, std::string>& derived = {}) const;

  struct Value {
    Parameter stated;  // as the file has it
    std::string file, now;
    bool given = false;
  };
  const std::vector<Value>& all() const { return values_; }
  const std::vector<std::string>& files() const { return files_; }  // parameter files, then the cards
  bool provisional() const { return provisional_; }                 // one of the cards calls itself so

 private:
  std::string card(const std::string& parameter) const;

  Given given_;
  std::vector<Value> values_;
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> files_;
  bool provisional_ = false;
};

}  // namespace vielto

#endif

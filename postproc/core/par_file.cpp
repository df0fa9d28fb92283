// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/par_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/par_range.h"

namespace vielto {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  const auto last = text.find_last_not_of(" \t\r");
  return text.substr(first, last - first + 1);
}

// unit | range | u | source; three fields have no range, and words to choose from stood in the unit's place.
void read_fields(const std::string& comment, Parameter& p) {
  std::vector<std::string> fields;
  std::istringstream in(comment);
  for (std::string field; std::getline(in, field, '|');) fields.push_back(trimmed(field));
  const bool ranged = fields.size() > 3;
  std::string* const targets[] = {&p.unit, &p.range, &p.u, &p.source};
  std::size_t k = 0;
  for (std::string* target : targets)
    if ((ranged || target != &p.range) && k < fields.size()) *target = fields[k++];
  if (!ranged && p.unit.find(" or ") != std::string::npos) {
    p.range = p.unit;
    p.unit = "-";
  }
}

}  // namespace

ParFile ParFile::read(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw BadInput(path, 0, "cannot be read", "name an existing parameter file");
  ParFile file;
  file.path_ = path;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto hash = line.find('#');
    const std::string code = trimmed(line.substr(0, hash));
    const std::string comment = hash == std::string::npos ? "" : line.substr(hash + 1);
    if (number == 1 && comment.find("provisional") != std::string::npos) file.provisional_ = true;
    if (code.empty()) continue;

    std::istringstream words(code);
    std::string keyword, style, rest;
    Parameter p;
    words >> keyword >> p.name >> style;
    std::getline(words, rest);
    p.value = trimmed(rest);
    p.line = number;
    if (keyword != "variable" || style != "index" || p.value.empty())
      throw BadInput(path, number, fmt::format("'{}' is not a parameter", code),
                     "write 'variable NAME index VALUE # unit | range | u | source'");
    read_fields(comment, p);
    try {
      ParRange::parse(p.range);
    } catch (const std::invalid_argument&) {
      throw BadInput(path, number, fmt::format("'{}' is no range of '{}'", p.range, p.name),
                     "write for example '> 0', '0 to 0.5', 'whole >= 1', 'off or on' or '-', or leave the field out");
    }
    if (!file.index_.emplace(p.name, file.parameters_.size()).second)
      throw BadInput(path, number, fmt::format("'{}' is stated twice", p.name), "keep one of the two lines");
    file.parameters_.push_back(p);
  }
  return file;
}

bool ParFile::has(const std::string& name) const { return index_.count(name) > 0; }

void ParFile::override_value(const std::string& name, const std::string& value) {
  const auto found = index_.find(name);
  if (found == index_.end())
    throw BadInput(path_, 0, fmt::format("has no parameter '{}' to override", name), "check the name's spelling");
  parameters_[found->second].value = value;
}

const Parameter& ParFile::find(const std::string& name) const {
  const auto found = index_.find(name);
  if (found == index_.end())
    throw BadInput(path_, 0, fmt::format("'{}' is missing", name),
                   fmt::format("add 'variable {} index VALUE # unit | range | u | source'", name));
  return parameters_[found->second];
}

double ParFile::number(const std::string& name) const {
  const Parameter& p = find(name);
  char* end = nullptr;
  const double value = std::strtod(p.value.c_str(), &end);
  if (end == p.value.c_str() || *end != '\0' || !std::isfinite(value))
    throw BadInput(path_, p.line, fmt::format("'{}' has the value '{}'", name, p.value), "state a finite number");
  return value;
}

double ParFile::number_or(const std::string& name, double fallback) const {
  return has(name) ? number(name) : fallback;
}

int ParFile::integer(const std::string& name) const {
  const double value = number(name);
  if (value != std::floor(value) || std::fabs(value) > 1e9)
    throw BadInput(path_, find(name).line, fmt::format("'{}' has the value '{}'", name, find(name).value),
                   "state a whole number");
  return static_cast<int>(value);
}

const std::string& ParFile::text(const std::string& name) const { return find(name).value; }

}  // namespace vielto

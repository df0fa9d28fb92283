// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/run_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/par_range.h"

namespace vielto {
namespace {

constexpr const char* kFromCard = "card";
const std::string kWall = "wall_";

std::string in_unit(const Parameter& p, const std::string& value) {
  return p.unit.empty() || p.unit == "1" || p.unit == "-" || !parameter_number(value) ? value : value + " " + p.unit;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

void RunParameters::add(const Parameter& stated, const std::string& file) {
  if (!index_.emplace(stated.name, values_.size()).second) return;
  const std::optional<std::string> given = given_(stated.name);
  values_.push_back({stated, file, given.value_or(stated.value), given.has_value()});
}

void RunParameters::read(const std::string& par_file) {
  const ParFile file = ParFile::read(par_file);
  files_.push_back(par_file);
  for (const Parameter& p : file.all()) add(p, par_file);
}

const std::string& RunParameters::value(const std::string& name) const {
  const auto found = index_.find(name);
  if (found == index_.end())
    throw BadInput(files_.empty() ? "setup" : files_.front(), 0, fmt::format("'{}' is missing", name),
                   fmt::format("add 'variable {} index VALUE # unit | range | u | source'", name));
  return values_[found->second].now;
}

std::string RunParameters::card(const std::string& parameter) const {
  return fmt::format("{}/{}.par", value("materials"), value(parameter));
}

void RunParameters::read_cards() {
  const ParFile grain = ParFile::read(card("grain")), wall = ParFile::read(card("wall"));
  provisional_ = grain.provisional() || wall.provisional();
  for (Value& v : values_) {
    if (v.stated.value != kFromCard) continue;
    const bool of_wall = v.stated.name.rfind(kWall, 0) == 0;
    const ParFile& source = of_wall ? wall : grain;
    const Parameter& p = source.find(of_wall ? v.stated.name.substr(kWall.size()) : v.stated.name);
    // the card has the value and its place, the rig's file the range
    v.file = source.path();
    v.stated.line = p.line;
    v.stated.value = p.value;
    if (!v.given) v.now = p.value;
  }
  for (const Parameter& p : grain.all()) add(p, grain.path());
  files_.push_back(grain.path());
  if (wall.path() != grain.path()) files_.push_back(wall.path());
}

void RunParameters::set(const std::string& name, const std::string& value) {
  const auto found = index_.find(name);
  if (found == index_.end()) {
    Parameter p;
    p.name = name;
    p.value = value;
    add(p, "");
  } else if (!values_[found->second].given) {
    values_[found->second].now = values_[found->second].stated.value = value;
  }
}

void RunParameters::check_names(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    if (has(name)) continue;
    for (const Value& v : values_)
      if (lower(v.stated.name) == lower(name))
        throw BadInput("-var " + name, 0, "there is no such parameter", "write " + v.stated.name);
    throw BadInput("-var " + name, 0, "there is no such parameter",
                   fmt::format("see {} for the names", fmt::join(files_, ", ")));
  }
}

void RunParameters::check_values(const std::map<std::string, std::string>& derived) const {
  const ParRange::Lookup lookup = [&](const std::string& name) -> std::optional<double> {
    if (has(name)) return parameter_number(value(name));
    const auto found = derived.find(name);
    return found == derived.end() ? std::nullopt : parameter_number(found->second);
  };
  for (const Value& v : values_) {
    const Parameter& p = v.stated;
    // without a range a value is of the kind that the file states
    const ParRange range = ParRange::parse(p.range.empty() && parameter_number(p.value) ? "any" : p.range);
    const std::optional<std::string> wanted = range.refusal(v.now, p.unit, lookup);
    if (!wanted) continue;
    const bool number = parameter_number(v.now).has_value();
    const std::string what = number && range.is_number() ? in_unit(p, v.now) : "'" + v.now + "'";
    throw std::invalid_argument(v.given ? fmt::format("{} is {}; give {} with -var {} ({}, line {}: {})", p.name, what,
                                                      *wanted, p.name, v.file, p.line, p.value)
                                        : fmt::format("{} is {}; give {} in {}, line {}, or with -var {}", p.name, what,
                                                      *wanted, v.file, p.line, p.name));
  }
}

}  // namespace vielto

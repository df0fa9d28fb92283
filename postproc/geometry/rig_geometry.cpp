// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/rig_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/bad_input.h"

namespace vielto {

constexpr double kLargestLength = 100;

double GeometryInput::number(const std::string& name) {
  const double value = file_.number(name);
  used_.push_back({name, file_.text(name), false});
  // some meshes are cut into pieces of the grain's size, of which there would be too many
  if (file_.find(name).unit == "m" && std::fabs(value) > kLargestLength)
    refuse(name, fmt::format("over {} m", kLargestLength), "state the length in m");
  return value;
}

double GeometryInput::positive(const std::string& name) {
  const double value = number(name);
  if (value <= 0) refuse(name, "not above 0", "state a value above 0");
  return value;
}

double GeometryInput::not_negative(const std::string& name) {
  const double value = number(name);
  if (value < 0) refuse(name, "negative", "state a value of 0 or more");
  return value;
}

int GeometryInput::count(const std::string& name, int least, int most) {
  const int value = file_.integer(name);
  used_.push_back({name, file_.text(name), false});
  if (value < least || value > most) refuse(name, "out of range", fmt::format("state {} to {}", least, most));
  return value;
}

const std::string& GeometryInput::choice(const std::string& name, const std::vector<std::string>& choices) {
  const std::string& value = file_.text(name);
  if (std::find(choices.begin(), choices.end(), value) == choices.end())
    refuse(name, "unknown", fmt::format("state one of: {}", fmt::join(choices, ", ")));
  used_.push_back({name, value, true});
  return value;
}

std::string GeometryInput::file(const std::string& name) const {
  return (std::filesystem::path(file_.path()).parent_path() / file_.text(name)).string();
}

void GeometryInput::refuse(const std::string& name, const std::string& what, const std::string& mend) const {
  int line = 0;
  for (const Parameter& p : file_.all())
    if (p.name == name) line = p.line;
  throw BadInput(file_.path(), line, fmt::format("'{}' {}: {}", name, file_.text(name), what), mend);
}

}  // namespace vielto

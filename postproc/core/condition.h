// SPDX-License-Identifier: GPL-2.0-or-later
// The numeric conditions of an observation: the one list of their names, units and ranges, in the order of the
// observation table's columns. A new condition is a member of Observation and a line here.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/observation_table.h"

namespace vielto {

using ConditionMember = std::optional<double> Observation::*;

struct NamedCondition {
  const char* name;
  ConditionMember member;
  const char* unit;
  double low, high;  // range of a value
  const char* meaning;
};

constexpr std::array<NamedCondition, 6> kConditions = {
    {{"speed", &Observation::speed, "1/s", 0, 1e6, "turns of the shaft or drum a second, as set"},
     {"fill", &Observation::fill, "1", 0, 1, "bulk volume over the drum's volume"},
     {"moisture", &Observation::moisture, "1", 0, 1, "moisture content, wet basis"},
     {"normal_stress", &Observation::normal_stress, "Pa", 0, 1e12, "weight on the shear plane over its area"},
     {"shear_velocity", &Observation::shear_velocity, "m/s", 0, 1e6, "velocity of the moved half of the shear box"},
     {"tilt", &Observation::tilt, "deg", -90, 90, "drum axis from the horizontal"}}};

// Null if there is no such condition.
inline ConditionMember condition_member(const std::string& name) {
  for (const NamedCondition& c : kConditions)
    if (name == c.name) return c.member;
  return nullptr;
}

// "speed 0.48, fill 0.1": the conditions that are stated.
std::string conditions_text(const Observation& row);

}  // namespace vielto

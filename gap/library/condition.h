// SPDX-License-Identifier: GPL-2.0-or-later
// The numeric conditions of an observation by name, and tests matched by conditions.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/observation_table.h"

namespace vielto::gap {

using ConditionMember = std::optional<double> Observation::*;
struct NamedCondition {
  const char* name;
  ConditionMember member;
};
constexpr std::array<NamedCondition, 6> kConditions = {{{"speed", &Observation::speed},
                                                        {"fill", &Observation::fill},
                                                        {"moisture", &Observation::moisture},
                                                        {"normal_stress", &Observation::normal_stress},
                                                        {"shear_velocity", &Observation::shear_velocity},
                                                        {"tilt", &Observation::tilt}}};

// Null if there is no such condition.
inline ConditionMember condition_member(const std::string& name) {
  for (const NamedCondition& c : kConditions)
    if (name == c.name) return c.member;
  return nullptr;
}

// "speed 0.48, fill 0.1": the conditions that are stated.
std::string conditions_text(const Observation& row);

}  // namespace vielto::gap

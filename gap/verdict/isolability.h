// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: which effects can be told apart by a set of tests, before any data,
// and from which strength on.
//
// Equation: the distance of effect a at strength s from effect b,
//   d(a, s; b) = min over t of sqrt(D' C^-1 D),  D = r_a(s) - r_b(t),
// C everything uncertain: C(0) and both effects' emulator and shape errors. The group of a at strength s is a and every
// rival that can stand in for it there, S(a, s) = {b : d(a, s; b) <= 3}: one way, since a gain stands in for every loss
// of the drive, though such a loss does not stand in for every gain. From nothing: d(a, s; 0) = sqrt(r' C^-1 r), C
// without a's shape error (which cannot make an effect vanish); above 4 the effect is detectable at that strength;
// isolable if it is detectable and its group is itself. Both are tables over strength, 0 at s = 0, linear between the
// strengths of a table. Distances depend on conditions, u and covariance of the rows, not on their values.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gap/emulator/table_model.h"
#include "gap/library/settings.h"

namespace vielto::gap {

// Distances of one effect over its strengths, ascending.
struct StrengthTable {
  std::vector<double> strengths, from_nothing;
  std::vector<std::vector<double>> from_rival;  // of each effect in the order of Isolability::effects; own:
                                                // empty

  double at(double strength, const std::vector<double>& distances) const;
};

struct Isolability {
  std::vector<std::string> effects;
  std::vector<StrengthTable> tables;  // of each effect
  double group_distance = 0, detectable_distance = 0;

  bool knows(const std::string& effect) const;
  // The effect first. An effect that is not known is a group of its own and not
  // detectable.
  std::vector<std::string> group_of(const std::string& effect, double strength) const;
  double from_nothing(const std::string& effect, double strength) const;
  bool detectable(const std::string& effect, double strength) const;
  bool isolable(const std::string& effect, double strength) const;
  // The strength of the table farthest from nothing: what these tests can show
  // of the effect at best.
  double farthest(const std::string& effect) const;
  // The strength of the least magnitude from which on, towards `farthest`, it
  // is so; NaN: never.
  double detectable_from(const std::string& effect) const;
  double isolable_from(const std::string& effect) const;
  // The largest distance from a rival over the strengths.
  double separation(std::size_t effect, std::size_t rival) const;
};

Isolability isolability(const TableModel& model, const Settings& settings);

// Distance of effect a at strength s from the nearest strength of b.
double distance(const TableModel& model, const EffectResponse& a, double s, const EffectResponse& b);

// The part of isolability.json that holds the tables, and back. Errors:
// BadInput naming `path` for one without tables.
nlohmann::ordered_json to_json(const Isolability& isolability);
Isolability isolability_of_json(const nlohmann::ordered_json& json, const std::string& path);

std::string isolability_csv(const Isolability& isolability);
std::string isolability_svg(const Isolability& isolability);

}  // namespace vielto::gap

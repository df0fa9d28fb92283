// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: which effects can be told apart by a set of tests, before any data.
//
// Equation: the distance of effect a at strength s from effect b,
//   d(a, s; b) = min over t of sqrt(D' C^-1 D),  D = r_a(s) - r_b(t),
// C everything uncertain: C(0) and both effects' emulator and shape errors. separation(a, b) = max over s of d. Two
// effects share a group if separation(a, b) and separation(b, a) are both at most 3: no strength of one lies farther
// from the other. The group of an effect is itself and those it shares one with; groups overlap (a and c may both be
// near b and far from each other). detectability(a) = max over s of sqrt(r' C^-1 r) with C = C(0)
// + emulator_a(s): above 4 the effect is detectable. Distances depend on conditions, u and covariance of the rows, not
// on their values.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gap/emulator/table_model.h"
#include "gap/library/settings.h"

namespace vielto::gap {

struct Isolability {
  std::vector<std::string> effects;
  Eigen::MatrixXd separation;  // in standard deviations; row a, column b
  Eigen::VectorXd detectability;
  std::vector<std::vector<std::string>> groups;  // of each effect, in the order of `effects`
  double group_distance = 0, detectable_distance = 0;

  std::vector<std::string> group_of(const std::string& effect) const;
  bool detectable(const std::string& effect) const;
};

Isolability isolability(const TableModel& model, const Settings& settings);

// Distance of effect a at strength s from the nearest strength of b.
double distance(const TableModel& model, const EffectResponse& a, double s, const EffectResponse& b);

std::string isolability_csv(const Isolability& isolability);
std::string isolability_svg(const Isolability& isolability);

}  // namespace vielto::gap

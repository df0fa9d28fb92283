// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: two observation tables side by side, A observed and B simulated, say.
//
// Equation: for each pair of rows relative gap = b/a - 1 and z = (b - a)/sqrt(u_a^2 + u_b^2); over all pairs
// chi2 = d' V^-1 d with d = b - a and V the covariance of d from both tables (their covariance files included). Errors
// of A and B are independent of each other.
//
// Pairs: rows of the same apparatus, observable, conditions (numbers to 6 digits), wall and material. Where several
// rows share all that, rows of the same test are paired, and the mean of the rest of A with the mean of the rest of B.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/reduced_table.h"

namespace vielto {

struct ComparedPair {
  Observation a, b;  // value and u of means where rows_a or rows_b is above 1; test: name of the first
  int rows_a = 1, rows_b = 1;
  double gap = 0;  // infinite if a is 0
  double z = 0;
};

struct GapSummary {
  std::string apparatus, observable;
  int pairs = 0;
  double mean_gap = 0, rms_gap = 0, max_gap = 0;  // the last two of its magnitude
  double mean_z = 0, max_z = 0;                   // the last of its magnitude
};

struct Comparison {
  std::vector<ComparedPair> pairs;          // in the order of A
  std::vector<std::string> only_a, only_b;  // "test observable" of rows without partner
  std::vector<GapSummary> summaries;        // one for each observable
  std::optional<double> chi2;               // nothing if V is not positive definite
  double chi2_exceedance = 0;
};

// `ignored`: conditions that need not agree (column names: speed ... tilt, wall, material).
// Errors: BadInput for an unknown column or if no row of A has a partner in B.
Comparison compare(const ReducedTable& a, const ReducedTable& b, const std::set<std::string>& ignored);

// The pairs as CSV, as text for a person.
std::string comparison_csv(const Comparison& comparison);
std::string comparison_text(const Comparison& comparison);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: where the simulation departs from the measurement, with a false-discovery rate over the regions.
//
// Regions: every observable of an apparatus as a whole, and by thirds of the table's speeds and fills ("slow, middle,
// fast", "low, middle, high fill") and likewise of its other conditions ("high tilt") where it has more than one. In a
// region the mean relative gap by generalised least squares,
//   m = (1' V^-1 g)/(1' V^-1 1), z = m sqrt(1' V^-1 1),
// g the relative gap of its rows, above 0 where the simulation shows too much (rows in logarithms: ln(f/y), and
// exp(m) - 1 is told: simulated over measured, less 1), V its covariance without any effect. p = 2 (1 - Phi(|z|)). V is
// a sum, and so is u^2 = a' V a, a = V^-1 1/(1' V^-1 1): what each summand adds tells what to know better for a smaller
// gap to be seen. q value: Benjamini and Hochberg 1995 if the z's are independent, Benjamini and Yekutieli 2001 (factor
// sum 1/i) if any two are correlated by more than 0.1 in magnitude.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gap/emulator/table_model.h"

namespace vielto::gap {

struct Region {
  std::string apparatus, observable, region;
  std::vector<Eigen::Index> rows;
  double relative_gap = 0, u = 0, z = 0, p = 1, q = 1;
  std::vector<std::pair<std::string, double>> u_parts;  // source of uncertainty, its share of u (squares add up to u^2)
};

struct Location {
  std::vector<Region> regions;  // smallest q first
  bool dependent = false;       // Benjamini-Yekutieli
};

// Only the rows (apparatus, observable, conditions) count.
std::vector<Region> regions_of(const std::vector<Observation>& rows);
Location locate(const TableModel& model);

// q values of p values (any order, kept).
std::vector<double> q_values(const std::vector<double>& p, bool dependent);

}  // namespace vielto::gap

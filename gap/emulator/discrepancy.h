// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: law discrepancy, what is left between two contact laws that are calibrated to the same targets.
//
// Equation: the relative difference d = y_law/y_baseline - 1 of an observable is a random function of the conditions c
// (in units of the library's range) with mean 0 and covariance
//   cov(d, d') = sd^2 [w + (1-w) exp(-|c-c'|^2 / 2 l^2)],
// independent from one observable to another. discrepancy.csv: apparatus,observable,sd,common,length,laws
// with sd > 0, w = common from 0 to 1, l = length > 0 and the number of development laws it rests on.
//
// Estimated from development laws (tables of runs with other laws): on a grid of (sd, w, l), given the noise of every
// difference; sd is the root of the posterior mean of sd^2, so that few laws make it larger, not smaller; w and l are
// posterior means. Prior of sd: half normal with a spread of 20 %. Laws that are calibrated to the same targets differ
// by that much in a mixer's power at most (README), so that 40 % is two standard deviations; a prior 1/sd, without a
// scale, made one law's 9 % a 15 % and one that differs by nothing a certainty. Development laws are not used in any
// withheld case.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <utility>
#include <vector>

namespace vielto::gap {

struct Discrepancy {
  double sd = 0, common = 0, length = 1;
  int laws = 0;
  double correlation(double squared_distance) const;
};

struct DiscrepancyEntry {
  std::string apparatus, observable;
  Discrepancy value;
};

// Relative differences of one law at the points `c`, with the covariance of their noise.
struct LawDifference {
  std::vector<Eigen::VectorXd> c;
  Eigen::VectorXd difference;
  Eigen::MatrixXd noise;
};

Discrepancy estimate_discrepancy(const std::vector<LawDifference>& laws);

std::vector<DiscrepancyEntry> read_discrepancies(const std::string& path);
void write_discrepancies(const std::string& path, const std::vector<DiscrepancyEntry>& entries);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/threshold.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/verdict/evidence.h"

namespace vielto::gap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd draw_without_gap(const TableModel& truth, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  MatrixXd covariance = truth.noise + truth.seed + truth.discrepancy + truth.reference;
  VectorXd y = truth.baseline;
  if (truth.family_weights.size() > 0) {
    std::discrete_distribution<Index> member(truth.family_weights.data(),
                                             truth.family_weights.data() + truth.family_weights.size());
    y += truth.family_members.col(member(random));
  }
  covariance.diagonal().array() += 1e-14 * covariance.diagonal().mean();
  const Eigen::LLT<MatrixXd> factor(covariance);
  require_finite(factor.info() == Eigen::Success ? 1 : NAN, "the scatter of a table without a gap", truth);
  VectorXd z(y.size());
  for (double& x : z) x = normal(random);
  return y + factor.matrixL() * z;
}

Threshold bootstrap_threshold(const Emulator& emulator, const TableModel& truth, const Settings& settings,
                              std::uint64_t seed, const std::function<TableModel(const Emulator&)>& judge) {
  std::mt19937_64 random(seed);
  std::vector<double> odds;
  const int each = (settings.draws + settings.libraries - 1) / settings.libraries;
  for (int l = 0; l < settings.libraries; ++l) {
    const TableModel model = judge(emulator.redrawn(random));
    MatrixXd tables(truth.size(), each);
    for (Index b = 0; b < each; ++b) tables.col(b) = draw_without_gap(truth, random);
    const VectorXd found = largest_log_odds(model, settings, tables);
    for (const double x : found) require_finite(x, "the log odds of a table without a gap", truth);
    odds.insert(odds.end(), found.begin(), found.end());
  }
  std::sort(odds.begin(), odds.end());
  const double n = static_cast<double>(odds.size()), p = 1 - settings.false_alarm;
  const auto order = [&](double rank) {
    return odds[static_cast<std::size_t>(std::clamp(std::ceil(rank) - 1, 0.0, n - 1))];
  };
  const double half = 1.96 * std::sqrt(n * p * (1 - p));
  Threshold t;
  t.log_odds = std::max(0.0, order(n * p));
  t.low95 = order(n * p - half);
  t.high95 = order(n * p + half);
  t.draws = static_cast<int>(odds.size());
  t.libraries = settings.libraries;
  t.seed = seed;
  return t;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the one likelihood. How well no gap, each effect, each pair of effects and an unnamed gap explain a table.
//
// Equation: log evidence of a model M with strengths s, prior uniform over the effects' ranges,
//   ln p(y|M) = ln integral p(s) N(y; f + b + r(s), C(s)) ds        (C: table_model.h)
// by the midpoint rule on a grid that closes in on where the integrand is. Two effects where values multiply (relative
// rows) act as r = r_1 + r_2 + r_1 r_2 / f. The unnamed gap: N(y; f + b, C(0) + a^2 D K D), D the effects' usual sizes,
// K one of its shapes (unknown_gap.h), a even in the logarithm between two amplitudes, all as probable. Posterior
// probability of a model: prior times evidence, over the sum; they sum to 1.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "gap/emulator/table_model.h"
#include "gap/library/settings.h"

namespace vielto::gap {

// One node of a model's posterior over its strengths.
struct StrengthNode {
  std::vector<double> strengths;
  double weight = 0;  // sum 1
};

struct Interval {
  double value = 0, low90 = 0, high90 = 0;  // median, 5 % and 95 % quantile
};

struct ModelEvidence {
  std::vector<std::string> effects;  // 0: no gap (or unknown), 1, 2
  bool unknown = false;
  double log_evidence = 0;
  double probability = 0;
  std::vector<StrengthNode> posterior;

  std::string name() const;  // no_gap, unknown, a, a+b
  Interval strength(std::size_t effect) const;
};

// d' C^-1 d. Errors: BadInput naming the table of `model` if C is not positive definite or the result not finite.
double chi_squared(const Eigen::VectorXd& d, const Eigen::MatrixXd& c, const TableModel& model);

double log_normal_density(const Eigen::VectorXd& deviation, const Eigen::MatrixXd& covariance);

// Mean and covariance of y at strengths (of one or two effects of `model`). In
// logarithms the noise is u over the measured value.
Eigen::VectorXd mean_at(const TableModel& model, const std::vector<const EffectResponse*>& effects,
                        const std::vector<double>& strengths);
Eigen::MatrixXd covariance_at(const TableModel& model, const std::vector<const EffectResponse*>& effects,
                              const std::vector<double>& strengths);
// C(0) and the gap's own, for every shape and amplitude it may have; the weights sum to 1.
struct UnknownNode {
  Eigen::MatrixXd covariance;
  double log_weight = 0;
};
std::vector<UnknownNode> unknown_nodes(const TableModel& model, const Settings& settings);

ModelEvidence no_gap_evidence(const TableModel& model);
ModelEvidence unknown_evidence(const TableModel& model, const Settings& settings);
ModelEvidence effect_evidence(const TableModel& model, const std::vector<const EffectResponse*>& effects);

// Errors: BadInput naming the table if a number that a verdict would rest on is not finite.
void require_finite(double value, const std::string& what, const TableModel& model);

// All models, probabilities set. Errors: BadInput for evidence that is not finite. `pairs_of`: pairs among the so many
// best singles only (0: all).
std::vector<ModelEvidence> all_evidence(const TableModel& model, const Settings& settings, int pairs_of = 0);
void set_probabilities(std::vector<ModelEvidence>& models, const TableModel& model, const Settings& settings);

// The statistic of the verdict, max over the rivals of ln p(y|M) - ln p(y|no gap), for each column of `tables` (n x B),
// on a fixed grid of strengths.
Eigen::VectorXd largest_log_odds(const TableModel& model, const Settings& settings, const Eigen::MatrixXd& tables);

}  // namespace vielto::gap

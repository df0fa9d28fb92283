// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of a few rows that can be worked out by hand.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "gap/emulator/table_model.h"
#include "gap/library/settings.h"

namespace vielto::gap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The numbers of a diagnosis, round ones.
inline Settings round_settings() {
  Settings s;
  s.prior_no_gap = 0.5, s.prior_single = 0.3, s.prior_pair = 0.1, s.prior_unknown = 0.1;
  s.unknown_low = 0.3, s.unknown_high = 6;
  s.unknown_probability = 0.5, s.name_probability = 0.8, s.group_probability = 0.9;
  s.misfit_probability = 0.01, s.name_misfit_probability = 0.001;
  s.false_discovery_rate = 0.05, s.group_distance = 3, s.detectable_distance = 4;
  return s;
}

inline VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Linear in the strength, its slope a row's number; certain.
inline EffectResponse effect(const std::string& name, const VectorXd& slope, double low, double high) {
  EffectResponse e;
  e.name = name;
  e.low = low;
  e.high = high;
  e.strengths = vector({std::min(low, -1.0), 0, high});
  e.mean = slope * e.strengths.transpose();
  e.covariance.assign(3, MatrixXd::Zero(slope.size(), slope.size()));
  return e;
}

// Rows of value y over a baseline of 10, independent, each with the variance of the noise.
inline TableModel table(const VectorXd& y, double variance, const std::vector<EffectResponse>& effects = {}) {
  const Eigen::Index n = y.size();
  TableModel m;
  m.source = "table.csv";
  m.rows.resize(static_cast<std::size_t>(n));
  for (Observation& row : m.rows) row.apparatus = "mixer", row.observable = "power", row.test = "t";
  m.observed = y;
  m.baseline = m.scale = VectorXd::Constant(n, 10);
  m.family_shift = m.relative = m.logarithmic = VectorXd::Zero(n);
  m.family_members = MatrixXd::Zero(n, 0);
  m.noise = variance * MatrixXd::Identity(n, n);
  for (auto part : {&TableModel::seed, &TableModel::emulator, &TableModel::family, &TableModel::discrepancy,
                    &TableModel::reference})
    m.*part = MatrixXd::Zero(n, n);
  m.shape_correlation = MatrixXd::Identity(n, n);
  m.unknown = {{1, MatrixXd::Identity(n, n), VectorXd::Ones(n)}};
  m.effects = effects;
  return m;
}

}  // namespace vielto::gap

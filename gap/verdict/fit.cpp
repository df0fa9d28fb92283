// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/fit.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/statistics.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Effects = std::vector<const EffectResponse*>;

constexpr double kOfRange = 1e-3;  // of an effect's range: step of the derivative; closer to an end is at the end
constexpr double kNoise = 1e-9;    // least eigenvalue over the largest that counts as a degree of freedom

std::vector<double> most_probable(const ModelEvidence& m) {
  if (m.posterior.empty()) return {};
  return std::max_element(m.posterior.begin(), m.posterior.end(),
                          [](const StrengthNode& a, const StrengthNode& b) { return a.weight < b.weight; })
      ->strengths;
}

// d mean/d s of the strengths that lie inside their ranges.
MatrixXd jacobian(const TableModel& model, const Effects& effects, const std::vector<double>& s,
                  std::vector<std::size_t>& free) {
  std::vector<VectorXd> columns;
  free.clear();
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const double h = kOfRange * (effects[e]->high - effects[e]->low);
    if (s[e] - h < effects[e]->low || s[e] + h > effects[e]->high) continue;
    std::vector<double> below = s, above = s;
    below[e] -= h;
    above[e] += h;
    columns.push_back((mean_at(model, effects, above) - mean_at(model, effects, below)) / (2 * h));
    free.push_back(e);
  }
  MatrixXd j(model.size(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) j.col(static_cast<Index>(k)) = columns[k];
  return j;
}

double block_probability(const VectorXd& d, const MatrixXd& r) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(r);
  const double least = kNoise * std::max(eigen.eigenvalues().maxCoeff(), 0.0);
  double chi2 = 0;
  int degrees = 0;
  for (Index k = 0; k < d.size(); ++k) {
    if (!(eigen.eigenvalues()[k] > least)) continue;
    const double along = eigen.eigenvectors().col(k).dot(d);
    chi2 += along * along / eigen.eigenvalues()[k];
    ++degrees;
  }
  return degrees > 0 ? chi2_exceedance(chi2, degrees) : 1;
}

}  // namespace

Fit fit_of(const TableModel& model, const ModelEvidence& m) {
  Effects effects;
  for (const std::string& name : m.effects) effects.push_back(model.effect(name));
  std::vector<double> s = most_probable(m);
  const MatrixXd c = covariance_at(model, effects, s);
  const Eigen::LLT<MatrixXd> factor(c);
  std::vector<std::size_t> free;
  const MatrixXd j = jacobian(model, effects, s, free);
  VectorXd d = model.observed - mean_at(model, effects, s);
  MatrixXd r = c;
  if (!free.empty()) {
    const MatrixXd information = j.transpose() * factor.solve(j);
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> inverse(information);
    const VectorXd step = inverse.solve(j.transpose() * factor.solve(d));
    for (std::size_t k = 0; k < free.size(); ++k) {
      const EffectResponse& e = *effects[free[k]];
      s[free[k]] = std::clamp(s[free[k]] + step[static_cast<Index>(k)], e.low, e.high);
    }
    d = model.observed - mean_at(model, effects, s);
    r -= j * inverse.solve(MatrixXd(j.transpose()));
  }
  Fit fit;
  fit.all =
      chi2_exceedance(chi_squared(d, c, model), std::max<double>(1, static_cast<double>(model.size() - j.cols())));
  std::map<std::pair<std::string, std::string>, std::vector<Index>> blocks;
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    blocks[{model.rows[i].apparatus, model.rows[i].observable}].push_back(static_cast<Index>(i));
  for (const auto& [name, rows] : blocks) {
    const double p = block_probability(d(rows), r(rows, rows)) * static_cast<double>(blocks.size());
    if (!fit.observable.empty() && p >= fit.worst) continue;
    fit.worst = std::min(1.0, p);
    fit.apparatus = name.first;
    fit.observable = name.second;
  }
  return fit;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/trends.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/condition.h"
#include "gap/verdict/regions.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Conditions that are stated and positive in all rows, and not the same in all.
std::vector<NamedCondition> varied(const TableModel& model, const std::vector<Index>& rows) {
  std::vector<NamedCondition> found;
  for (const NamedCondition& c : kConditions) {
    std::set<double> values;
    bool usable = true;
    for (const Index i : rows) {
      const auto& value = model.rows[static_cast<std::size_t>(i)].*c.member;
      usable = usable && value && *value > 0;
      if (value) values.insert(*value);
    }
    if (usable && values.size() > 1) found.push_back(c);
  }
  return found;
}

void add_trends(const TableModel& model, const std::vector<Index>& rows, std::vector<Trend>& trends) {
  const auto conditions = varied(model, rows);
  const Index n = static_cast<Index>(rows.size()), unknowns = static_cast<Index>(conditions.size()) + 1;
  if (unknowns < 2 || n <= unknowns || model.logarithmic(rows).minCoeff() <= 0) return;
  MatrixXd x = MatrixXd::Ones(n, unknowns);
  for (Index i = 0; i < n; ++i)
    for (std::size_t c = 0; c < conditions.size(); ++c)
      x(i, static_cast<Index>(c) + 1) =
          std::log(*(model.rows[static_cast<std::size_t>(rows[i])].*conditions[c].member));
  if (Eigen::ColPivHouseholderQR<MatrixXd>(x).rank() < unknowns) return;

  const Eigen::LLT<MatrixXd> factor(model.null_covariance()(rows, rows));
  const MatrixXd covariance = (x.transpose() * factor.solve(x)).inverse();
  const MatrixXd weights = covariance * factor.solve(x).transpose();  // unknowns x n
  const VectorXd b = weights * model.gap()(rows);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    const Index k = static_cast<Index>(c) + 1;
    Trend t;
    const Observation& row = model.rows[static_cast<std::size_t>(rows[0])];
    t.apparatus = row.apparatus;
    t.observable = row.observable;
    t.condition = conditions[c].name;
    t.exponent = b[k];
    t.u = std::sqrt(covariance(k, k));
    t.z = t.exponent / t.u;
    t.p = std::erfc(std::fabs(t.z) / std::sqrt(2.0));
    for (const UncertaintySource& source : kUncertaintySources) {
      if (source.part == &TableModel::reference && model.reference.isZero(0)) continue;
      const double square = weights.row(k) * (model.*source.part)(rows, rows) * weights.row(k).transpose();
      t.u_parts.emplace_back(source.name, std::sqrt(std::max(0.0, square)));
    }
    trends.push_back(t);
  }
}

}  // namespace

std::vector<Trend> trends_of(const TableModel& model) {
  std::map<std::pair<std::string, std::string>, std::vector<Index>> observables;
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    observables[{model.rows[i].apparatus, model.rows[i].observable}].push_back(static_cast<Index>(i));
  std::vector<Trend> trends;
  for (const auto& [name, rows] : observables) add_trends(model, rows, trends);
  std::vector<double> p;
  for (const Trend& t : trends) p.push_back(t.p);
  const std::vector<double> q = q_values(p, true);
  for (std::size_t i = 0; i < q.size(); ++i) trends[i].q = q[i];
  std::stable_sort(trends.begin(), trends.end(), [](const Trend& a, const Trend& b) { return a.q < b.q; });
  return trends;
}

}  // namespace vielto::gap

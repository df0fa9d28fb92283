// SPDX-License-Identifier: GPL-2.0-or-later
#include "table_model.h"

#include <algorithm>
#include <utility>

namespace vielto::gap {
namespace {

// Index of the strength below and the part of the way to the one above.
std::pair<Eigen::Index, double> between(const Eigen::VectorXd& strengths, double s) {
  const double* begin = strengths.data();
  const double* end = begin + strengths.size();
  const Eigen::Index above = std::clamp<Eigen::Index>(std::upper_bound(begin, end, s) - begin, 1, strengths.size() - 1);
  const double low = strengths[above - 1], high = strengths[above];
  return {above - 1, std::clamp((s - low) / (high - low), 0.0, 1.0)};
}

}  // namespace

Eigen::VectorXd EffectResponse::response(double strength) const {
  const auto [i, part] = between(strengths, strength);
  return (1 - part) * mean.col(i) + part * mean.col(i + 1);
}

Eigen::MatrixXd EffectResponse::emulator(double strength) const {
  const auto [i, part] = between(strengths, strength);
  return (1 - part) * covariance[i] + part * covariance[i + 1];
}

const EffectResponse* TableModel::effect(const std::string& name) const {
  for (const EffectResponse& e : effects)
    if (e.name == name) return &e;
  return nullptr;
}

TableModel TableModel::part(const std::vector<Eigen::Index>& keep) const {
  TableModel p = *this;
  p.rows.clear();
  for (const Eigen::Index i : keep) p.rows.push_back(rows[i]);
  for (auto member : {&TableModel::observed, &TableModel::baseline, &TableModel::family_shift, &TableModel::relative,
                      &TableModel::scale, &TableModel::unknown_scale})
    p.*member = (this->*member)(keep).eval();
  for (auto member : {&TableModel::noise, &TableModel::seed, &TableModel::emulator, &TableModel::family,
                      &TableModel::discrepancy, &TableModel::shape_correlation, &TableModel::unknown_correlation})
    p.*member = (this->*member)(keep, keep).eval();
  p.family_members = family_members(keep, Eigen::all).eval();
  for (EffectResponse& e : p.effects) {
    e.mean = e.mean(keep, Eigen::all).eval();
    for (Eigen::MatrixXd& c : e.covariance) c = c(keep, keep).eval();
  }
  return p;
}

TableModel TableModel::without(const std::vector<std::string>& names) const {
  TableModel p = *this;
  p.effects.erase(std::remove_if(p.effects.begin(), p.effects.end(),
                                 [&](const EffectResponse& e) {
                                   return std::find(names.begin(), names.end(), e.name) != names.end();
                                 }),
                  p.effects.end());
  return p;
}

}  // namespace vielto::gap

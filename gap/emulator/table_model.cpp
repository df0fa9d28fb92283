// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/table_model.h"

#include <algorithm>
#include <cmath>
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

Eigen::VectorXd TableModel::over_scale(const Eigen::VectorXd& x) const {
  return (scale.array() > 0).select(x.array() / scale.array(), 0.0);
}

Eigen::MatrixXd UnknownShape::covariance(double amplitude) const {
  const Eigen::VectorXd d = amplitude * size;
  return d.asDiagonal() * correlation * d.asDiagonal();
}

TableModel TableModel::part(const std::vector<Eigen::Index>& keep) const {
  TableModel p = *this;
  p.rows.clear();
  for (const Eigen::Index i : keep) p.rows.push_back(rows[i]);
  for (auto member : {&TableModel::observed, &TableModel::baseline, &TableModel::family_shift, &TableModel::relative,
                      &TableModel::scale, &TableModel::logarithmic})
    p.*member = (this->*member)(keep).eval();
  if (known_change.size() > 0) p.known_change = known_change(keep).eval();
  for (auto member : {&TableModel::noise, &TableModel::seed, &TableModel::emulator, &TableModel::family,
                      &TableModel::discrepancy, &TableModel::reference, &TableModel::shape_correlation})
    p.*member = (this->*member)(keep, keep).eval();
  for (UnknownShape& shape : p.unknown) {
    shape.correlation = shape.correlation(keep, keep).eval();
    shape.size = shape.size(keep).eval();
  }
  p.family_members = family_members(keep, Eigen::all).eval();
  for (EffectResponse& e : p.effects) {
    e.mean = e.mean(keep, Eigen::all).eval();
    for (Eigen::MatrixXd& c : e.covariance) c = c(keep, keep).eval();
  }
  return p;
}

TableModel TableModel::in_logarithms(Values values) const {
  using Eigen::Index;
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  TableModel p = *this;
  VectorXd over_f = VectorXd::Ones(size()), over_noise = over_f;
  for (Index i = 0; i < size(); ++i) {
    if (relative[i] == 0 || (values == Values::measured && observed[i] <= 0)) continue;
    p.logarithmic[i] = p.scale[i] = 1;
    p.relative[i] = 0;  // what multiplied adds up
    over_f[i] = 1 / baseline[i];
    over_noise[i] = values == Values::measured ? 1 / observed[i] : over_f[i];
    p.observed[i] = std::log(observed[i]);
    p.baseline[i] = std::log(baseline[i]);
    p.family_members.row(i) = (family_members.row(i).array() / baseline[i]).log1p();
    for (UnknownShape& shape : p.unknown) shape.size[i] /= baseline[i];
  }
  p.noise = over_noise.asDiagonal() * noise * over_noise.asDiagonal();
  for (auto member : {&TableModel::seed, &TableModel::emulator, &TableModel::family, &TableModel::discrepancy,
                      &TableModel::reference})
    p.*member = over_f.asDiagonal() * (this->*member) * over_f.asDiagonal();
  if (family_weights.size() > 0) {
    // the members' own scatter anew, the emulator's error of them stays
    const auto scatter = [&](const MatrixXd& members, const VectorXd& mean) {
      const MatrixXd centred = members.colwise() - mean;
      return MatrixXd(centred * family_weights.asDiagonal() * centred.transpose());
    };
    p.family -= over_f.asDiagonal() * scatter(family_members, family_shift) * over_f.asDiagonal();
    p.family_shift = p.family_members * family_weights;
    p.family += scatter(p.family_members, p.family_shift);
  }
  for (EffectResponse& e : p.effects)
    for (Index k = 0; k < e.strengths.size(); ++k) {
      VectorXd over = VectorXd::Ones(size());  // f + r
      for (Index i = 0; i < size(); ++i) {
        if (p.logarithmic[i] == 0) continue;
        over[i] = 1 / (baseline[i] + e.mean(i, k));
        e.mean(i, k) = std::log1p(e.mean(i, k) / baseline[i]);
      }
      MatrixXd& c = e.covariance[static_cast<std::size_t>(k)];
      c = (over.asDiagonal() * c * over.asDiagonal()).eval();
    }
  return p;
}

Eigen::MatrixXd TableModel::uncertain(const EffectResponse& e, double strength) const {
  const Eigen::VectorXd r = e.shape_error * e.response(strength);
  Eigen::MatrixXd c = e.emulator(strength) + r.asDiagonal() * shape_correlation * r.asDiagonal();
  if (known_change.size() > 0) {
    const Eigen::VectorXd with_known = interaction * r.cwiseProduct(known_change);
    c += with_known.asDiagonal() * shape_correlation * with_known.asDiagonal();
  }
  return c;
}

TableModel TableModel::with_known(const std::string& name, double strength) const {
  const EffectResponse& known = *effect(name);
  const Eigen::VectorXd r = known.response(strength);
  TableModel p = without({name});
  p.baseline += r;
  const Eigen::VectorXd eta_r = known.shape_error * over_scale(r);
  p.known_change = eta_r.cwiseAbs();
  if (known_change.size() > 0) p.known_change = (known_change.cwiseAbs2() + eta_r.cwiseAbs2()).cwiseSqrt();
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(size());
  for (Eigen::Index i = 0; i < size(); ++i)
    if (relative[i] > 0) factor[i] = p.baseline[i] / baseline[i];
  p.scale = scale.cwiseProduct(factor);
  for (UnknownShape& shape : p.unknown) shape.size = shape.size.cwiseProduct(factor).eval();
  p.family_shift = family_shift.cwiseProduct(factor);
  p.family_members = factor.asDiagonal() * family_members;
  const auto scaled = [&](const Eigen::MatrixXd& c) {
    return Eigen::MatrixXd(factor.asDiagonal() * c * factor.asDiagonal());
  };
  p.emulator = scaled(emulator) + known.emulator(strength);
  for (auto member : {&TableModel::seed, &TableModel::family, &TableModel::discrepancy, &TableModel::reference})
    p.*member = scaled(this->*member);
  for (EffectResponse& e : p.effects) {
    e.mean = factor.asDiagonal() * e.mean;
    for (Eigen::MatrixXd& c : e.covariance) c = scaled(c);
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/unknown_gap.h"

#include <algorithm>
#include <cmath>

#include "core/condition.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kApparatus = 0.2, kObservable = 0.3, kNear = 0.3, kSame = 0.2, kLength = 0.5;
constexpr double kKin = 0.5, kKinNear = 0.3, kKinSame = 0.2;

VectorXd usual_size(const TableModel& model, double floor) {
  VectorXd squares = VectorXd::Zero(model.size());
  for (const EffectResponse& e : model.effects)
    squares += ((e.response(e.low / 2).cwiseAbs2() + e.response(e.high / 2).cwiseAbs2()) / 2);
  const double effects = std::max<double>(1, static_cast<double>(model.effects.size()));
  VectorXd size = (squares / effects).cwiseSqrt().cwiseMax(floor * model.scale.cwiseAbs());
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    if (model.rows[i].apparatus == "bench") size[static_cast<Index>(i)] = 0;
  return size;
}

double smooth(const VectorXd& c, const VectorXd& other) {
  const double distance = (c - other).squaredNorm();
  return kObservable + kNear * std::exp(-distance / (2 * kLength * kLength)) + (distance < 1e-12 ? kSame : 0);
}

// Level and slopes of one size at the ends of the range, where c is 0 or 1.
double level_and_trends(const VectorXd& c, const VectorXd& other) {
  const double slopes = (2 * c.array() - 1).matrix().dot((2 * other.array() - 1).matrix());
  return (1 - kApparatus) * (1 + slopes) / (1 + static_cast<double>(c.size()));
}

bool is_kin_row(const Observation& row, const Settings& settings) {
  return row.apparatus == "bench" && row.observable == settings.unknown_kin;
}

// What of the measurement chain moves a row of the kin's observable.
std::vector<const EffectResponse*> kin_of(const TableModel& model, const Settings& settings) {
  std::vector<const EffectResponse*> kin;
  for (const EffectResponse& e : model.effects)
    for (std::size_t i = 0; i < model.rows.size(); ++i)
      if (e.kind == EffectKind::measurement && is_kin_row(model.rows[i], settings) &&
          !e.mean.row(static_cast<Index>(i)).isZero(0)) {
        kin.push_back(&e);
        break;
      }
  return kin;
}

VectorXd kin_size(const TableModel& model, const Settings& settings) {
  VectorXd size = VectorXd::Zero(model.size());
  const auto kin = kin_of(model, settings);
  double squares = 0;
  int rows = 0;
  for (std::size_t i = 0; i < model.rows.size(); ++i) {
    if (kin.empty() || !is_kin_row(model.rows[i], settings)) continue;
    const Index k = static_cast<Index>(i);
    for (const EffectResponse* e : kin)
      squares += (std::pow(e->response(e->low / 2)[k], 2) + std::pow(e->response(e->high / 2)[k], 2)) / 2 /
                 std::pow(model.scale[k], 2) / static_cast<double>(kin.size());
    ++rows;
  }
  if (rows == 0) return size;
  for (std::size_t i = 0; i < model.rows.size(); ++i) {
    const Index k = static_cast<Index>(i);
    const bool moved =
        std::all_of(kin.begin(), kin.end(), [&](const EffectResponse* e) { return !e->mean.row(k).isZero(0); });
    if (moved || is_kin_row(model.rows[i], settings)) size[k] = std::sqrt(squares / rows) * std::fabs(model.scale[k]);
  }
  return size;
}

UnknownShape kin_shape(const TableModel& model) {
  const Index n = model.size();
  UnknownShape shape;
  shape.kin = true;
  shape.correlation = MatrixXd::Constant(n, n, kKin);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const Observation &a = model.rows[static_cast<std::size_t>(i)], &b = model.rows[static_cast<std::size_t>(j)];
      if (a.speed && b.speed)
        shape.correlation(i, j) += kKinNear * std::exp(-std::pow(std::log2(*a.speed / *b.speed), 2) / 2);
      if (a.apparatus == b.apparatus && a.observable == b.observable && conditions_text(a) == conditions_text(b))
        shape.correlation(i, j) += kKinSame;
    }
  return shape;
}

}  // namespace

void set_unknown_sizes(TableModel& model, const Settings& settings) {
  const VectorXd usual = usual_size(model, settings.unknown_floor), kin = kin_size(model, settings);
  const double share = kin.isZero(0) ? 0 : settings.unknown_kin_share;
  double others = 0;
  for (const UnknownShape& shape : model.unknown) others += shape.kin ? 0 : 1;
  for (UnknownShape& shape : model.unknown) {
    shape.size = shape.kin ? kin : usual;
    shape.weight = shape.kin ? share : (1 - share) / others;
  }
}

void set_unknown_gap(TableModel& model, const std::vector<VectorXd>& conditions, const Settings& settings) {
  const Index n = model.size();
  model.unknown.clear();
  for (const auto within : {smooth, level_and_trends}) {
    UnknownShape shape;
    shape.correlation = MatrixXd::Zero(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const Observation &a = model.rows[static_cast<std::size_t>(i)], &b = model.rows[static_cast<std::size_t>(j)];
        if (a.apparatus != b.apparatus) continue;
        shape.correlation(i, j) = kApparatus;
        if (a.observable == b.observable)
          shape.correlation(i, j) +=
              within(conditions[static_cast<std::size_t>(i)], conditions[static_cast<std::size_t>(j)]);
      }
    model.unknown.push_back(std::move(shape));
  }
  model.unknown.push_back(kin_shape(model));
  set_unknown_sizes(model, settings);
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/unknown_gap.h"

#include <algorithm>
#include <cmath>

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kApparatus = 0.2, kObservable = 0.3, kNear = 0.3, kSame = 0.2, kLength = 0.5;

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

}  // namespace

void set_unknown_scale(TableModel& model, const Settings& settings) {
  model.unknown_scale = usual_size(model, settings.unknown_floor);
}

void set_unknown_gap(TableModel& model, const std::vector<VectorXd>& conditions, const Settings& settings) {
  set_unknown_scale(model, settings);
  const Index n = model.size();
  model.unknown_shapes.clear();
  for (const auto within : {smooth, level_and_trends}) {
    MatrixXd shape = MatrixXd::Zero(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const Observation &a = model.rows[static_cast<std::size_t>(i)], &b = model.rows[static_cast<std::size_t>(j)];
        if (a.apparatus != b.apparatus) continue;
        shape(i, j) = kApparatus;
        if (a.observable == b.observable)
          shape(i, j) += within(conditions[static_cast<std::size_t>(i)], conditions[static_cast<std::size_t>(j)]);
      }
    model.unknown_shapes.push_back(std::move(shape));
  }
}

}  // namespace vielto::gap

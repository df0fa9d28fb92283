// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/channel_response.h"

#include <fmt/format.h>

#include <cmath>

#include "core/bad_input.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStrengthSteps = 24;  // on either side of 0

// Strengths over the prior range, the steps growing with the distance from 0.
VectorXd strengths_of(const Effect& effect) {
  std::vector<double> s;
  for (int i = kStrengthSteps; i > 0 && effect.prior_low < 0; --i)
    s.push_back(effect.prior_low * std::pow(static_cast<double>(i) / kStrengthSteps, 2));
  s.push_back(0);
  for (int i = 1; i <= kStrengthSteps && effect.prior_high > 0; ++i)
    s.push_back(effect.prior_high * std::pow(static_cast<double>(i) / kStrengthSteps, 2));
  return Eigen::Map<VectorXd>(s.data(), static_cast<Index>(s.size()));
}

// Change of the smoothed value and its covariance.
struct Change {
  VectorXd mean;
  MatrixXd covariance;
};

// The difference of the baseline between two conditions: errors of both are correlated.
Change shifted(const Channel& channel, const Transform& transform, const std::vector<Observation>& rows,
               double strength) {
  const Index m = static_cast<Index>(rows.size());
  std::vector<Point> both;
  for (const Observation& row : rows) both.push_back(channel.point(row));
  for (Observation row : rows) {
    auto& condition = row.*condition_member(transform.condition);
    if (!condition) throw BadInput("test " + row.test, 0, fmt::format("has no {}", transform.condition), "state it");
    *condition *= 1 + transform.factor * strength;
    both.push_back(channel.point(row));
  }
  const GaussianProcess::Prediction p = channel.level.process.at(both);
  const MatrixXd& c = p.covariance;
  return {p.mean.tail(m) - p.mean.head(m),
          c.topLeftCorner(m, m) + c.bottomRightCorner(m, m) - c.topRightCorner(m, m) - c.bottomLeftCorner(m, m)};
}

Change simulated(const Channel& channel, const Smooth& smooth, const std::vector<Observation>& rows, double t) {
  std::vector<Point> at;
  for (const Observation& row : rows) at.push_back(channel.point(row));
  for (Point& p : at) p.t = t;
  GaussianProcess::Prediction p = smooth.process.at(at);
  return {std::move(p.mean), std::move(p.covariance)};
}

void fill_change(const Channel& channel, const std::vector<Index>& rows, const TableModel& model, Index k,
                 const Change& change, EffectResponse& response) {
  const Index m = static_cast<Index>(rows.size());
  for (Index a = 0; a < m; ++a) {
    const double f = model.baseline[rows[a]];
    response.mean(rows[a], k) = channel.relative ? f * std::expm1(change.mean[a]) : change.mean[a];
    for (Index b = 0; b < m; ++b) {
      const double scale =
          channel.relative ? f * std::exp(change.mean[a]) * model.baseline[rows[b]] * std::exp(change.mean[b]) : 1;
      response.covariance[k](rows[a], rows[b]) = scale * change.covariance(a, b);
    }
  }
}

}  // namespace

EffectResponse empty_response(const Effect& effect, Index n) {
  EffectResponse response;
  response.name = effect.name;
  response.unit = effect.unit;
  response.kind = effect.kind;
  response.low = effect.prior_low;
  response.high = effect.prior_high;
  response.shape_error = effect.shape_error;
  response.strengths = strengths_of(effect);
  response.mean = MatrixXd::Zero(n, response.strengths.size());
  response.covariance.assign(static_cast<std::size_t>(response.strengths.size()), MatrixXd::Zero(n, n));
  return response;
}

bool is_known(const Channel& channel, const Effect& effect) {
  return !effect.acts_on_rig(channel.apparatus) || effect.transform_of(channel.apparatus, channel.observable) ||
         channel.responses.count(effect.name) > 0;
}

void fill_response(const Channel& channel, const Effect& effect, const std::vector<Index>& rows,
                   const TableModel& model, EffectResponse& response) {
  const Transform* transform = effect.transform_of(channel.apparatus, channel.observable);
  const auto smooth = channel.responses.find(effect.name);
  if (!transform && smooth == channel.responses.end()) return;
  std::vector<Observation> own;
  for (const Index i : rows) own.push_back(model.rows[static_cast<std::size_t>(i)]);
  for (Index k = 0; k < response.strengths.size(); ++k) {
    const double s = response.strengths[k];
    if (s == 0) continue;
    if (transform && transform->operation != Operation::shift) {
      for (std::size_t a = 0; a < own.size(); ++a) {
        const double f = model.baseline[rows[a]];
        response.mean(rows[a], k) = transform->reading(own[a], f, s).value - f;
      }
      continue;
    }
    const Change change = transform ? shifted(channel, *transform, own, s)
                                    : simulated(channel, smooth->second, own, s / largest_strength(effect));
    fill_change(channel, rows, model, k, change, response);
  }
}

}  // namespace vielto::gap

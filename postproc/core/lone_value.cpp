// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/lone_value.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/median.h"

namespace vielto {

namespace {

// Of a value from the median of a signal, in its robust standard deviations; 0 where most values are one and the same.
double deviations(const std::vector<double>& signal, double value) {
  const double centre = median(signal);
  std::vector<double> distances;
  distances.reserve(signal.size());
  for (const double x : signal) distances.push_back(std::fabs(x - centre));
  const double spread = 1.4826 * median(std::move(distances));
  return spread > 0 ? std::fabs(value - centre) / spread : 0;
}

}  // namespace

std::optional<LoneValue> lone_value(const std::vector<double>& signal) {
  if (signal.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(signal.size());
  LoneValue lone;
  lone.mean = std::accumulate(signal.begin(), signal.end(), 0.0) / n;
  const auto farthest = std::max_element(signal.begin(), signal.end(), [&](double a, double b) {
    return std::fabs(a - lone.mean) < std::fabs(b - lone.mean);
  });
  lone.index = static_cast<std::size_t>(farthest - signal.begin());
  lone.without = (lone.mean * n - *farthest) / (n - 1);
  const double moved = std::fabs(lone.mean - lone.without), whole = std::fabs(lone.without);
  const bool named = moved > kMostLoneShare * whole ||
                     (moved > kMostFarShare * whole && deviations(signal, *farthest) > kFarDeviations);
  return named ? std::optional(lone) : std::nullopt;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/lone_value.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vielto {

std::optional<LoneValue> lone_value(const std::vector<double>& signal, double share) {
  if (signal.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(signal.size());
  LoneValue lone;
  lone.mean = std::accumulate(signal.begin(), signal.end(), 0.0) / n;
  const auto farthest = std::max_element(signal.begin(), signal.end(), [&](double a, double b) {
    return std::fabs(a - lone.mean) < std::fabs(b - lone.mean);
  });
  lone.index = static_cast<std::size_t>(farthest - signal.begin());
  lone.without = (lone.mean * n - *farthest) / (n - 1);
  if (!(std::fabs(lone.mean - lone.without) > share * std::fabs(lone.without))) return std::nullopt;
  return lone;
}

}  // namespace vielto

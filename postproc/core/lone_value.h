// SPDX-License-Identifier: GPL-2.0-or-later
// A value that alone moves a mean is a fault of an instrument more often than of a machine.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vielto {

constexpr double kMostLoneShare = 0.05;  // of the mean
constexpr double kFarDeviations = 20;    // no torque of grains lies that far from its median
constexpr double kMostFarShare = 0.01;   // of the mean, moved by such a value

struct LoneValue {
  std::size_t index = 0;
  double mean = 0, without = 0;  // of all values, of all others
};

// The value farthest from the mean, if with it the mean moves from that of the others by more than kMostLoneShare; or
// by more than kMostFarShare, where the value lies over kFarDeviations from the median. A deviation is 1.4826 times the
// median of |x - median|, the standard deviation of normal noise: https://doi.org/10.1080/01621459.1993.10476408 (1.2).
std::optional<LoneValue> lone_value(const std::vector<double>& signal);

}  // namespace vielto

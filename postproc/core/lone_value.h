// SPDX-License-Identifier: GPL-2.0-or-later
// A value that alone moves a mean is a fault of an instrument more often than of a machine.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vielto {

constexpr double kMostLoneShare = 0.05;

struct LoneValue {
  std::size_t index = 0;
  double mean = 0, without = 0;  // of all values, of all others
};

// The value farthest from the mean, if the mean moves by more than `share` of the mean of the others with it.
std::optional<LoneValue> lone_value(const std::vector<double>& signal, double share = kMostLoneShare);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The upper median: of an even number of values the larger one of the middle two. `values` holds at least one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vielto {

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace vielto

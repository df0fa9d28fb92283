// SPDX-License-Identifier: GPL-2.0-or-later
// Place and radius of one grain.
#pragma once

#include <array>

namespace vielto {

struct Grain {
  std::array<double, 3> x{};  // m
  double radius = 0;          // m
};

}  // namespace vielto

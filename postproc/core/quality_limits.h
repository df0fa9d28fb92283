// SPDX-License-Identifier: GPL-2.0-or-later
// What a run must keep to, for its numbers to be reported without a warning.
#pragma once

namespace vielto {

constexpr double kMostDtOverTc = 0.05;                              // time step over the shortest half period
constexpr double kMostOverlapMean = 0.005, kMostOverlapMax = 0.05;  // of the diameter

}  // namespace vielto

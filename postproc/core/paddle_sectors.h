// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the place of a paddle in its turn, in sectors of 60 deg about its lowest point, and what of its torque falls
// into which: the observables paddle_share_* of the table of rigs.
//
// Equation: share_k = sum of the torque over the phases in sector k / sum over the whole turn. A paddle's own angle
// counts from the y axis towards z, so that its lowest point is at 270 deg; sectors count from there in the direction
// of rotation: -60 ... 0 enters the bed's deep side, 60 ... 120 leaves the bed. Units: degrees; shares are 1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vielto {

constexpr std::size_t kSectors = 6;
constexpr double kSectorWidth = 360.0 / kSectors, kLowestPoint = 270;

// Where a sector begins, degrees past the lowest point: -180, -120 ... 120.
constexpr double sector_begin(std::size_t sector) { return kSectorWidth * static_cast<double>(sector) - 180; }

inline std::size_t sector_of(double phase_deg) {
  const double past = std::fmod(phase_deg - kLowestPoint + 540, 360);  // 180 at the lowest point
  return std::min(kSectors - 1, static_cast<std::size_t>(past / kSectorWidth));
}

struct PaddleShare {
  const char* observable;
  std::size_t sector;
};
// What a paddle carries past the top, what it meets, what it lifts; the two sectors that these leave out follow.
constexpr std::array<PaddleShare, 3> kPaddleShares = {
    {{"paddle_share_carried", 1}, {"paddle_share_entering", 2}, {"paddle_share_leaving", 4}}};

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/round_surface.h"

#include <algorithm>
#include <cmath>

#include "core/mixing_numbers.h"

namespace vielto {

std::vector<std::vector<double>> surface_strips(const std::vector<Grain>& grains, const std::array<double, 2>& axis,
                                                double d, int strips) {
  double reach = 0;
  for (const Grain& g : grains) reach = std::max(reach, std::hypot(g.x[0] - axis[0], g.x[1] - axis[1]));
  const std::size_t cells = static_cast<std::size_t>(reach / d) + 1;
  std::vector<std::vector<double>> top(static_cast<std::size_t>(strips), std::vector<double>(cells, kNoGrain));
  for (std::size_t s = 0; s < top.size(); ++s) {
    const double azimuth = 2 * kPi * static_cast<double>(s) / strips;
    for (const Grain& g : grains) {
      const double x = g.x[0] - axis[0], y = g.x[1] - axis[1];
      const double along = x * std::cos(azimuth) + y * std::sin(azimuth);
      const double across = y * std::cos(azimuth) - x * std::sin(azimuth);
      if (along < 0 || std::fabs(across) > d) continue;
      double& cell = top[s][std::min(cells - 1, static_cast<std::size_t>(along / d))];
      cell = std::max(cell, g.x[2] + g.radius);
    }
  }
  return top;
}

double RadialLine::angle() const { return std::atan(slope) * 180 / kPi; }

RadialLine line_through(const std::vector<SurfacePoint>& points) {
  double r = 0, z = 0, rr = 0, rz = 0;
  const double n = static_cast<double>(points.size());
  for (const SurfacePoint& p : points) r += p.r / n, z += p.z / n;
  for (const SurfacePoint& p : points) rr += (p.r - r) * (p.r - r), rz += (p.r - r) * (p.z - z);
  return {z - rz / rr * r, -rz / rr};
}

AzimuthMean azimuth_mean(const std::vector<double>& of_strips) {
  AzimuthMean result;
  const double n = static_cast<double>(of_strips.size());
  for (const double value : of_strips) result.mean += value / n;
  double squares = 0;
  for (const double value : of_strips) squares += (value - result.mean) * (value - result.mean);
  result.spread = std::sqrt(squares / (n - 1));
  result.u = result.spread / std::sqrt(n);
  return result;
}

}  // namespace vielto

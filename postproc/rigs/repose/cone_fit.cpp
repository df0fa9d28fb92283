// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/cone_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/bad_input.h"

namespace vielto {
namespace {

constexpr std::ptrdiff_t kSummitRank = 10;

// Where the heap stands: the middle of its uppermost part, each place weighted by how far it reaches into that.
std::array<double, 2> summit(const Heap& heap) {
  const double d = heap.header.grain_diameter;
  std::map<std::pair<long, long>, double> top;  // of the cells d x d
  for (const Grain& g : heap.grains) {
    double& cell = top.emplace(std::pair(std::lround(g.x[0] / d), std::lround(g.x[1] / d)), kNoGrain).first->second;
    cell = std::max(cell, g.x[2] + g.radius);
  }
  std::vector<double> heights;
  for (const auto& [place, height] : top) heights.push_back(height);
  // not the very highest, which may be a single grain on top of others
  const auto high = heights.end() - std::min<std::ptrdiff_t>(kSummitRank, static_cast<std::ptrdiff_t>(heights.size()));
  std::nth_element(heights.begin(), high, heights.end());
  const double floor = kFlankTop * *high;
  double x = 0, y = 0, weight = 0;
  for (const auto& [place, height] : top) {
    const double w = std::max(0.0, height - floor);
    x += w * static_cast<double>(place.first) * d, y += w * static_cast<double>(place.second) * d, weight += w;
  }
  return weight > 0 ? std::array{x / weight, y / weight} : std::array{0.0, 0.0};
}

}  // namespace

ConeFit cone_fit(const Heap& heap) {
  const double d = heap.header.grain_diameter;
  ConeFit result;
  const std::array<double, 2> middle_of_heap = summit(heap);
  result.off_axis = std::hypot(middle_of_heap[0], middle_of_heap[1]);
  result.about_summit = result.off_axis > kOnAxis * d;
  const auto top =
      surface_strips(heap.grains, result.about_summit ? middle_of_heap : std::array{0.0, 0.0}, d, kConeStrips);
  const auto radius = [&](std::size_t cell) { return (static_cast<double>(cell) + 0.5) * d; };
  // A cell without a grain is bare base.
  for (std::size_t c = 0; c < top[0].size(); ++c) {
    double sum = 0;
    for (const auto& strip : top) {
      sum += std::max(strip[c], 0.0);
      if (strip[c] > kNoGrain) result.surface.push_back({radius(c), strip[c]});
    }
    result.profile.push_back({radius(c), sum / kConeStrips});
    result.height = std::max(result.height, sum / kConeStrips);
  }

  // From the highest place outwards: first cell below the top's share, last one before the foot's.
  std::size_t from = 0;
  while (result.profile[from].z < result.height) ++from;
  while (from < result.profile.size() && result.profile[from].z > kFlankTop * result.height) ++from;
  std::size_t to = from;
  while (to < result.profile.size() && result.profile[to].z > kFlankFoot * result.height) ++to;
  if (to - from < kLeastFlank)
    throw BadInput(
        heap.path, 0,
        fmt::format("the heap's flank is {} cells of a diameter long, {} are needed", to - from, kLeastFlank),
        "run with smaller or more grains");
  result.flank_from = static_cast<double>(from) * d;
  result.flank_to = static_cast<double>(to) * d;

  const double middle = 0.5 * (result.flank_from + result.flank_to);
  std::vector<SurfacePoint> all, upper, lower;
  for (const auto& strip : top) {
    std::vector<SurfacePoint> flank;
    for (std::size_t c = from; c < to; ++c) {
      if (strip[c] == kNoGrain) continue;
      flank.push_back({radius(c), strip[c]});
      (radius(c) < middle ? upper : lower).push_back(flank.back());
    }
    all.insert(all.end(), flank.begin(), flank.end());
    // a strip that is mostly bare has no flank to speak of
    if (static_cast<int>(flank.size()) >= kLeastFlank - 1) result.strip_angles.push_back(line_through(flank).angle());
  }
  if (result.strip_angles.size() < kConeStrips / 2)
    throw BadInput(heap.path, 0, "the heap covers less than half of the azimuths", "run with more grains");
  const RadialLine line = line_through(all);
  result.intercept = line.intercept;
  result.slope = line.slope;
  double squares = 0;
  for (const SurfacePoint& p : all) squares += std::pow(p.z - (line.intercept - line.slope * p.r), 2);
  result.off_cone = std::sqrt(squares / static_cast<double>(all.size()));
  if (result.off_cone > kMostOffCone * result.height)
    result.warnings.push_back(
        fmt::format("the flank lies {:.2g} mm off a cone, {:.0f} % of the height, limit {:.0f} %: look at the picture",
                    1e3 * result.off_cone, 100 * result.off_cone / result.height, 100 * kMostOffCone));
  result.curvature = line_through(upper).angle() - line_through(lower).angle();

  const AzimuthMean mean = azimuth_mean(result.strip_angles);
  result.angle = mean.mean;
  result.spread = mean.spread;
  result.u = mean.u;
  return result;
}

}  // namespace vielto

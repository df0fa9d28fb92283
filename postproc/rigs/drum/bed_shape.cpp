// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/bed_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/mean_uncertainty.h"
#include "core/mixing_numbers.h"

namespace vielto {
namespace {

constexpr double kStripRadii = 3;
constexpr int kLeastStrips = 4;
constexpr int kGrid = 16;  // points across a sphere that the box cuts

// The part of a sphere that lies in the box.
double part_inside(const Grain& g, const std::array<double, 6>& box) {
  bool whole = true;
  for (std::size_t d = 0; d < 3; ++d) {
    if (g.x[d] + g.radius <= box[2 * d] || g.x[d] - g.radius >= box[2 * d + 1]) return 0;
    whole = whole && g.x[d] - g.radius >= box[2 * d] && g.x[d] + g.radius <= box[2 * d + 1];
  }
  if (whole) return 1;
  const auto at = [](int i) { return (2.0 * i + 1) / kGrid - 1; };  // -1 ... 1
  int in_sphere = 0, in_both = 0;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j)
      for (int k = 0; k < kGrid; ++k) {
        const std::array<double, 3> q = {at(i), at(j), at(k)};
        if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] > 1) continue;
        ++in_sphere;
        bool in = true;
        for (std::size_t d = 0; d < 3; ++d) {
          const double p = g.x[d] + g.radius * q[d];
          in = in && p >= box[2 * d] && p < box[2 * d + 1];
        }
        in_both += in;
      }
  return static_cast<double>(in_both) / in_sphere;
}

constexpr double kDegree = 180 / kPi;

// The highest point of a grain in the plane that is looked at.
struct Top {
  double across, height;
};

struct Line {
  double slope, u_slope, height;  // at the middle of its points
};

double mean_radius(const std::vector<Grain>& grains) {
  double radius = 0;
  for (const Grain& g : grains) radius += g.radius / static_cast<double>(grains.size());
  return radius;
}

// Least squares through the highest tops of strips three radii wide.
Line surface_line(const std::vector<Top>& tops, double radius, std::pair<double, double> window) {
  // a window of whole strips has them whatever the rounding
  const auto strips = static_cast<std::size_t>((window.second - window.first) / (kStripRadii * radius) + 1e-9);
  std::vector<const Top*> highest(strips, nullptr);
  const double width = (window.second - window.first) / static_cast<double>(std::max<std::size_t>(strips, 1));
  for (const Top& t : tops) {
    const double place = (t.across - window.first) / width;
    if (place < 0 || place >= static_cast<double>(strips)) continue;
    const Top*& best = highest[static_cast<std::size_t>(place)];
    if (!best || t.height > best->height) best = &t;
  }
  double n = 0, h = 0, v = 0;
  for (const Top* t : highest)
    if (t) ++n, h += t->across, v += t->height;
  if (n < kLeastStrips)
    throw std::invalid_argument("the surface in the window is less than four strips of three radii wide");
  h /= n;
  v /= n;
  double hh = 0, hv = 0, vv = 0;
  for (const Top* t : highest) {
    if (!t) continue;
    const double dh = t->across - h, dv = t->height - v;
    hh += dh * dh;
    hv += dh * dv;
    vv += dv * dv;
  }
  const double slope = hv / hh;
  return {slope, std::sqrt(std::max(0.0, vv - slope * hv) / (n - 2) / hh), v};
}

}  // namespace

Estimate surface_angle(const std::vector<Grain>& grains, BedAxes axes,
                       std::optional<std::pair<double, double>> window) {
  std::vector<Top> tops;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Grain& g : grains) {
    tops.push_back({g.x[axes.across], g.x[axes.up] + g.radius});
    low = std::min(low, g.x[axes.across]);
    high = std::max(high, g.x[axes.across]);
  }
  if (!window) window = {0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high};
  const Line line = surface_line(tops, mean_radius(grains), *window);
  return {kDegree * std::atan(std::fabs(line.slope)), kDegree * line.u_slope / (1 + line.slope * line.slope)};
}

Estimate drum_surface_angle(const std::vector<Grain>& grains, double drum_radius) {
  double y = 0, z = 0;
  for (const Grain& g : grains) y += g.x[1], z += g.x[2];
  const double from_axis = std::hypot(y, z);
  if (!(from_axis > 0))
    throw std::invalid_argument("the bed lies evenly about the drum's axis, it has no free surface");
  // unit vectors from the bed through the axis, and along the chord
  const double up[2] = {-y / from_axis, -z / from_axis}, along[2] = {up[1], -up[0]};
  std::vector<Top> tops;
  for (const Grain& g : grains)
    tops.push_back({along[0] * g.x[1] + along[1] * g.x[2], up[0] * g.x[1] + up[1] * g.x[2] + g.radius});
  const double radius = mean_radius(grains);
  Line line{0, 0, 0};
  double half = drum_radius / 2;
  // the second time over the middle half of the chord that the first found
  for (int pass = 0; pass < 2; ++pass) {
    line = surface_line(tops, radius, {-half, half});
    half = 0.5 * std::sqrt(std::max(0.0, drum_radius * drum_radius - line.height * line.height));
  }
  const double angle = std::atan2(along[1], along[0]) + std::atan(line.slope);
  return {kDegree * std::fabs(std::remainder(angle, kPi)), kDegree * line.u_slope / (1 + line.slope * line.slope)};
}

Estimate bulk_density(const std::vector<Grain>& grains, double grain_density, const std::array<double, 6>& box) {
  double mean = 0, squares = 0;
  for (int eighth = 0; eighth < 8; ++eighth) {
    std::array<double, 6> part{};
    double volume = 1;
    for (std::size_t d = 0; d < 3; ++d) {
      const double middle = 0.5 * (box[2 * d] + box[2 * d + 1]);
      const bool upper = (eighth >> d) & 1;
      part[2 * d] = upper ? middle : box[2 * d];
      part[2 * d + 1] = upper ? box[2 * d + 1] : middle;
      volume *= part[2 * d + 1] - part[2 * d];
    }
    double mass = 0;
    for (const Grain& g : grains)
      mass += grain_density * 4.0 / 3.0 * kPi * g.radius * g.radius * g.radius * part_inside(g, part);
    if (mass == 0) throw std::invalid_argument("a corner of the box holds no grain");
    mean += mass / volume / 8;
    squares += mass / volume * (mass / volume) / 8;
  }
  return {mean, std::sqrt(std::max(0.0, squares - mean * mean) / 7)};
}

Estimate over_time(const std::vector<Estimate>& snapshots) {
  if (snapshots.size() == 1) return snapshots[0];
  std::vector<double> values;
  double own = 0;
  bool moves = false;
  for (const Estimate& e : snapshots) {
    values.push_back(e.value);
    own += e.u * e.u / static_cast<double>(snapshots.size());
    moves = moves || std::fabs(e.value - snapshots[0].value) > 1e-9 * std::fabs(e.value);
  }
  if (!moves) return {snapshots[0].value, std::sqrt(own)};  // a bed at rest: the same look again tells nothing new
  const MeanUncertainty time = mean_uncertainty(values, 1);
  return {time.mean, std::sqrt(time.u * time.u + own / std::clamp(time.effective_samples, 1.0, double(values.size())))};
}

}  // namespace vielto

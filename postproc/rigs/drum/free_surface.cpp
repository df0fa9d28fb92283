// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/free_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/mixing_numbers.h"

namespace vielto {
namespace {

constexpr std::size_t kLeastPoints = 5;
constexpr double kLeastReach = 0.8;  // of a window

// Degrees by which the least-squares line through the points between `from` and `to` falls.
double fall(const std::vector<SurfacePoint>& points, const SurfaceWindow& window, double radius) {
  const double from = window.from * radius, to = window.to * radius;
  std::vector<SurfacePoint> inside;
  for (const SurfacePoint& p : points)
    if (p.x >= from - 1e-9 * radius && p.x <= to + 1e-9 * radius) inside.push_back(p);
  const auto [left, right] =
      std::minmax_element(inside.begin(), inside.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  if (inside.size() < kLeastPoints || right->x - left->x < kLeastReach * (to - from))
    throw std::invalid_argument(
        fmt::format("{} of the surface: {} points between x = {:.3g} and {:.3g} m, {} across at least {} of them are "
                    "needed",
                    window.observable, inside.size(), from, to, kLeastPoints, kLeastReach));
  const double n = static_cast<double>(inside.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const SurfacePoint& p : inside) x += p.x / n, y += p.y / n;
  for (const SurfacePoint& p : inside) xx += (p.x - x) * (p.x - x), xy += (p.x - x) * (p.y - y);
  return -std::atan(xy / xx) * 180 / kPi;
}

}  // namespace

SurfaceAngles surface_angles(const std::vector<SurfacePoint>& points, double drum_radius) {
  SurfaceAngles angles;
  for (const SurfaceWindow& window : kSurfaceWindows) angles.*window.angle = fall(points, window, drum_radius);
  return angles;
}

Silhouette::Silhouette(double drum_radius) : radius_(drum_radius), dark_(kColumns * kLevels, 0) {}

void Silhouette::add_look(const std::vector<Grain>& grains) {
  ++looks_;
  const double width = 2 * radius_ / kColumns, height = 2 * radius_ / kLevels;
  std::vector<int> last_look(dark_.size(), 0);  // a cell that several grains hide is dark once
  // first cell whose middle is not below `place`
  const auto cell = [&](double place, double size, std::size_t cells) {
    return static_cast<std::size_t>(std::clamp(std::ceil((place + radius_) / size - 0.5), 0.0, double(cells)));
  };
  for (const Grain& g : grains) {
    const double x = -g.x[1], y = g.x[2];
    const std::size_t end = cell(x + g.radius, width, kColumns);
    for (std::size_t column = cell(x - g.radius, width, kColumns); column < end; ++column) {
      const double off = (static_cast<double>(column) + 0.5) * width - radius_ - x;
      const double half = std::sqrt(std::max(0.0, g.radius * g.radius - off * off));
      const std::size_t top = cell(y + half, height, kLevels);
      for (std::size_t level = cell(y - half, height, kLevels); level < top; ++level)
        last_look[column * kLevels + level] = 1;
    }
  }
  for (std::size_t i = 0; i < dark_.size(); ++i) dark_[i] += last_look[i];
}

double Silhouette::darkness(std::size_t column, std::size_t level) const {
  return level < kLevels ? static_cast<double>(dark_[column * kLevels + level]) / looks_ : 0;
}

std::vector<SurfacePoint> Silhouette::surface() const {
  std::vector<SurfacePoint> points;
  const double width = 2 * radius_ / kColumns, height = 2 * radius_ / kLevels;
  for (std::size_t column = 0; column < kColumns; ++column) {
    std::size_t levels = kLevels;
    while (levels > 0 && darkness(column, levels - 1) < 0.5) --levels;
    if (levels == 0) continue;
    const double below = darkness(column, levels - 1), above = darkness(column, levels);
    const double place = static_cast<double>(levels) - 0.5 + (below - 0.5) / (below - above);
    points.push_back({(static_cast<double>(column) + 0.5) * width - radius_, place * height - radius_});
  }
  return points;
}

double Silhouette::dark_area() const {
  const auto dark = std::count_if(dark_.begin(), dark_.end(), [&](int n) { return 2 * n >= looks_; });
  return static_cast<double>(dark) * 4 / (kPi * kColumns * kLevels);
}

}  // namespace vielto

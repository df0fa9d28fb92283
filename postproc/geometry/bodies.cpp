// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/bodies.h"

#include <cmath>
#include <utility>

namespace vielto {

Bodies::Bodies(Triangles closed) : triangles_(std::move(closed)), surface_(triangles_) {
  if (triangles_.empty()) return;
  const Measure extent = measure(triangles_);
  low_ = extent.low, high_ = extent.high;
}

double Bodies::winding_number(const Point& p) const {
  double half_angles = 0;
  for (const Triangle& t : triangles_) {
    const Point a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2 * kPi);
}

bool Bodies::hold(const Point& p) {
  if (triangles_.empty() || (p.array() < low_.array()).any() || (p.array() > high_.array()).any()) return false;
  if (!asked_ || surface_.between(last_, p)) held_ = winding_number(p) > 0.5;
  asked_ = true, last_ = p;
  return held_;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/repose_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vielto {

RigGeometry repose_geometry(GeometryInput& input) {
  const double diameter = input.positive("cylinderDiameter");
  const double height = input.positive("cylinderHeight");
  const int segments = input.count("cylinderSegments", 3, 360);
  const std::string& shape = input.choice("baseShape", {"square", "disc"});
  const double base_width = input.positive("baseWidth");
  const int base_segments = input.count("baseSegments", 3, 360);
  if (base_width * std::cos(kPi / base_segments) <= diameter)
    input.refuse("baseWidth", "the base does not carry the cylinder", "state a baseWidth well above cylinderDiameter");

  const double chord = diameter * std::sin(kPi / segments);
  auto circle = arc(diameter / 2, 0, 2 * kPi, segments);
  std::reverse(circle.begin(), circle.end());  // normals inward
  const auto outline =
      shape == "disc" ? arc(base_width / 2, 0, 2 * kPi, base_segments) : rectangle(base_width, base_width);

  RigGeometry g;
  g.parts = {
      {"base", "plate", false, triangulate(upright({plate(outline, 0, true)}))},
      {"cylinder", "drum", true, triangulate(upright(sweep(circle, true, 0, height, strip_pieces(height, chord))))}};
  g.derived = {{"cylinderRadius", fmt::format("{:.12g}", diameter / 2 * std::cos(kPi / segments))}};
  return g;
}

}  // namespace vielto

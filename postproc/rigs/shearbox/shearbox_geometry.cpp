// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/shearbox/shearbox_geometry.h"

#include <fmt/format.h>

#include <algorithm>

namespace vielto {
namespace {

// Flange in the plane z on one side along x (`side` +1 or -1), sharing its inner edge with the wall.
Face flange(double side, double length, double width, double reach, double z, bool up) {
  const double inner = side * length / 2, outer = side * (length / 2 + reach);
  return plate({{inner, -width / 2}, {outer, -width / 2}, {outer, width / 2}, {inner, width / 2}}, z, up);
}

}  // namespace

RigGeometry shearbox_geometry(GeometryInput& input) {
  const double length = input.positive("boxLength");
  const double width = input.positive("boxWidth");
  const double height = input.positive("boxHeight");
  const double split = input.positive("splitHeight");
  const double freeboard = input.not_negative("freeboard");
  const double reach = input.positive("flangeLength");
  const double split_gap = input.positive("splitGap");
  const double plate_gap = input.positive("plateGap");
  const double plate_thickness = input.positive("plateThickness");

  const double top = height - split + freeboard;
  const double plate_length = length - 2 * plate_gap, plate_width = width - 2 * plate_gap;
  if (split >= height)
    input.refuse("splitHeight", "the split lies above the box", "state a splitHeight below boxHeight");
  if (split_gap >= height - split)
    input.refuse("splitGap", "the gap is as high as the upper half", "state a splitGap well below a grain diameter");
  if (plate_length <= 0 || plate_width <= 0)
    input.refuse("plateGap", "no load plate is left between the gaps", "state a plateGap well below a grain diameter");
  if (plate_thickness >= top - split_gap)
    input.refuse("plateThickness", "the load plate is thicker than the upper half is high",
                 "state a thinner plate or more freeboard");

  auto outline = rectangle(length, width);
  std::reverse(outline.begin(), outline.end());  // normals towards the grains
  Surface lower = sweep(outline, true, -split, 0, 1);
  lower.push_back(plate(outline, -split, true));
  Surface upper = sweep(outline, true, split_gap, top, 1);
  for (const double side : {-1.0, 1.0}) {
    lower.push_back(flange(side, length, width, reach, 0, true));
    upper.push_back(flange(side, length, width, reach, split_gap, false));
  }
  const Surface load_plate = box({0, 0, top - plate_thickness / 2}, {plate_length / 2, 0, 0}, {0, plate_width / 2, 0},
                                 {0, 0, plate_thickness / 2});

  RigGeometry g;
  g.parts = {{"lower", "drum", true, triangulate(upright(lower))},
             {"upper", "drum", true, triangulate(upright(upper))},
             {"plate", "plate", true, triangulate(load_plate)}};
  g.derived = {{"boxBottom", fmt::format("{:.12g}", -split)},
               {"boxTop", fmt::format("{:.12g}", top)},
               {"plateBottom", fmt::format("{:.12g}", top - plate_thickness)},
               {"boxArea", fmt::format("{:.12g}", length * width)},
               {"maxShearDisplacement", fmt::format("{:.12g}", reach)}};
  g.notes.push_back(fmt::format("no grain above {:.2f} mm diameter escapes up to a shear displacement of {:.2f} mm",
                                std::max(split_gap, plate_gap) * 1e3, reach * 1e3));
  return g;
}

}  // namespace vielto

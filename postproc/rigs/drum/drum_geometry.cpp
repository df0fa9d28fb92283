// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/drum_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vielto {

RigGeometry drum_geometry(GeometryInput& input) {
  const double radius = input.positive("drumDiameter") / 2;
  const double length = input.positive("drumLength");
  const int segments = input.count("drumSegments", 3, 360);

  auto circle = arc(radius, 0, 2 * kPi, segments);
  std::reverse(circle.begin(), circle.end());  // normals inward
  const double chord = 2 * radius * std::sin(kPi / segments);
  const Surface mantle = sweep(circle, true, 0, length, strip_pieces(length, chord));
  // Two triangles do for an end: the corners lie outside the mantle, where no grain comes.
  const Surface ends{plate(rectangle(2 * radius, 2 * radius), 0, true),
                     plate(rectangle(2 * radius, 2 * radius), length, false)};

  Surface closed = mantle;
  append(closed, {plate(circle, 0, true), plate(circle, length, false)});
  const double volume = -measure(triangulate(closed)).volume;  // inward normals
  RigGeometry g;
  g.parts = {{"drum", "drum", true, triangulate(mantle)}, {"ends", "drum", true, triangulate(ends)}};
  g.derived = {{"drumRadius", fmt::format("{:.12g}", radius)}, {"meshedDrumVolume", fmt::format("{:.9g}", volume)}};
  g.notes.push_back(fmt::format("drum {:.5f} dm3 in {} chords, cylinder {:.5f} dm3", volume * 1e3, segments,
                                kPi * radius * radius * length * 1e3));
  return g;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Narrow triangles, as CAD programs cut plane faces and long strips, made wider while the surface stays as it is.
//
// First the common edge of two triangles in one plane is flipped where that makes the smallest of their angles greater
// (Lawson 1977: what Delaunay triangles have). What is narrow then gets a point in the middle of an edge: of a strip
// its longer side, else the one at the end of the path of longest edges from the narrow triangle (Rivara 1997, Int. J.
// for Numerical Methods in Engineering 40:3313). Then edges are flipped again.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/surface.h"

namespace vielto {

// Triangles by their corners' places in `points`, so that neighbours are known.
struct Indexed {
  std::vector<Point> points;
  std::vector<std::array<int, 3>> faces;

  Triangle triangle(const std::array<int, 3>& f) const { return {points[f[0]], points[f[1]], points[f[2]]}; }
};

double smallest_angle(const Triangle& t);  // rad
double height(const Triangle& t);          // m, over the longest edge

// Until no angle is below `least` (rad), or `most` triangles are there. Needs one orientation a shell and no edge with
// more than two triangles. A corner between two edges of a body that is sharper than `least` stays. Triangles no higher
// than `flat` (m) are flipped, not divided; corners that far from a plane lie in it.
void widen(Indexed& mesh, double least, double flat, std::size_t most);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Surfaces made of convex plane faces: building them, cutting them for a periodic box, and turning them into few good
// triangles.
//
// Lengths in m. Faces are counterclockwise seen from the side their normal points to: outward for solid bodies,
// towards the grains for containers. Two faces that touch share their whole edge (no vertex lies inside another face's
// edge), because LIGGGHTS finds neighbours by equal end points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/pi.h"

namespace vielto {

using Point = Eigen::Vector3d;
using Face = std::vector<Point>;
using Surface = std::vector<Face>;
using Triangle = std::array<Point, 3>;
using Triangles = std::vector<Triangle>;

// Box with half edges u, v, w, right-handed (u x v along w); six faces, normals outward. Volume 8 u.(v x w).
// The largest faces come last: LIGGGHTS gives a sharp edge to the later of its two triangles, and a grain on the other
// face within sqrt(2 R overlap) of the edge feels face and edge at once. So the large faces are free of that.
Surface box(const Point& centre, const Point& u, const Point& v, const Point& w);

// Faces swept along x from x0 to x1 in `pieces` equal lengths from a line of points (y, z); counterclockwise in the y-z
// plane gives normals away from the enclosed area, clockwise towards it. `closed` joins the last point to the first.
Surface sweep(const std::vector<Eigen::Vector2d>& line, bool closed, double x0, double x1, int pieces);

// Lengthwise pieces for strips of this width: as few as keep the triangles' smallest angle above 1.4 degrees (LIGGGHTS
// complains below 0.5). One in most periodic slices, which is also best at the periodic seam (see README.md).
int strip_pieces(double length, double width);

// Points (y, z) on a circle about the origin, counterclockwise, the first at angle `from` (rad), `segments` chords over
// `angle`; a whole turn has no last point equal to the first.
std::vector<Eigen::Vector2d> arc(double radius, double from, double angle, int segments);

// Corners of -width/2..width/2 by -height/2..height/2 in the y-z plane, counterclockwise.
std::vector<Eigen::Vector2d> rectangle(double width, double height);

// The x axis becomes the z axis, y becomes x, z becomes y.
Surface upright(Surface surface);

// Convex polygon in the plane x = const, from (y, z) points; normal along +x if `up`, else along -x. Either order of
// points.
Face plate(std::vector<Eigen::Vector2d> outline, double x, bool up);

// Cuts every face at x = 0 and x = length (and further periods) and moves each piece into 0 <= x <= length.
// Cuts are left open (a cap would be a wall inside the bed). Vertices nearer than 1e-9 m to a plane are put on it.
Surface wrap(const Surface& surface, double length);

// Each face cut into triangles between its own vertices such that the smallest angle is as large as it can be.
Triangles triangulate(const Surface& surface);

struct Measure {
  std::size_t triangles = 0;
  long open_edges = 0;     // edges with one triangle
  long crowded_edges = 0;  // edges with more than two triangles, or two triangles of opposite orientation
  double volume =
      0;            // m3, divergence theorem; positive for outward normals; the enclosed volume only if no edge is open
  double area = 0;  // m2
  double smallest_angle = 0;  // rad
  Point low, high;            // bounding box
};
Measure measure(const Triangles& triangles);

// Largest distance of any vertex from the x axis.
double largest_radius(const Triangles& triangles);

// Whether two convex bodies, each given by its faces, share a point (separating axes).
bool overlap(const Surface& a, const Surface& b);

Surface moved(Surface surface, const Point& by);
void append(Surface& surface, const Surface& more);

}  // namespace vielto

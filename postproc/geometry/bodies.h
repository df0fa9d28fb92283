// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a point lies inside a closed body: the winding number, the solid angles of all triangles seen from the point
// over 4 pi, is the number of bodies around it (van Oosterom and Strackee 1983, IEEE Trans. Biomed. Eng. 30:125).
// Bodies may run into one another, and there may be many; each is closed, with its normals outward.
#pragma once

#include "geometry/room.h"
#include "geometry/surface.h"

namespace vielto {

class Bodies {
 public:
  explicit Bodies(Triangles closed);

  // For a point off the surfaces. If no surface lies between it and the point asked for before, the answer is the same,
  // so that points asked for row by row take little time.
  bool hold(const Point& p);

 private:
  double winding_number(const Point& p) const;

  Triangles triangles_;
  SurfaceDistance surface_;
  Point low_, high_, last_ = Point::Constant(0);
  bool asked_ = false, held_ = false;
};

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// A measured free surface of a drum's bed: columns x and y of a text (column_text.h), such as a contour read off a
// picture -> points in the frame of free_surface.h.
//
// A row whose y is empty or nan has no surface there and is left out: one file may hold several surfaces over one x.
//
// Errors: BadInput with file, line and column as column_text.h; for a row whose x is not given, an x that is there
// twice, a point outside the drum (lengths in mm, most often), and for too few points (surface_angles).
#pragma once

#include <string>
#include <vector>

#include "rigs/drum/free_surface.h"

namespace vielto {

struct SurfaceColumns {
  std::string x, y;           // names of the columns
  double length_factor = 1;   // times the columns is m
  bool uphill_right = false;  // the bed is carried up at positive x: turned round
};

struct MeasuredSurface {
  std::vector<SurfacePoint> points;  // along x
  SurfaceAngles angles;              // deg
};

MeasuredSurface read_surface(const std::string& path, const SurfaceColumns& columns, double drum_radius);

}  // namespace vielto

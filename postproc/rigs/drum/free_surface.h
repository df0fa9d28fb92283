// SPDX-License-Identifier: GPL-2.0-or-later
// The free surface of a drum's bed across its axis, measured or simulated, and the three slopes that tell its shape.
//
// Frame: origin on the drum's axis, x horizontal across it, y up; the drum carries the bed up at negative x, so that
// the surface falls along x. A drum that turns from +y to +z about its axis x, as in cases/drum, has x = -y and y = z.
//
// Slopes: the straight line of least squares through the points of a window of x, its ends with it, as a fall in
// degrees from the horizontal, for a drum of radius R:
//   angle_mid    abs(x) < 0.5 R
//   angle_upper  -0.62 R < x < -0.24 R
//   angle_lower  0.24 R < x < 0.62 R
// On y = -a x + b x^3 (the S of a fast drum) the line of the window from c - h to c + h falls by a - 3 b c^2 - 3/5 b
// h^2.
//
// Simulated looks are seen as a camera with a lamp behind the drum sees them: a place is dark in a look if any grain
// along the axis hides it. The surface is where it is dark in half of the looks, the 50 % grey contour of their mean
// picture, met first from above in each of kColumns columns.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "rigs/grain.h"

namespace vielto {

struct SurfacePoint {
  double x = 0, y = 0;  // m
};

struct SurfaceAngles {
  double mid = 0, upper = 0, lower = 0;  // deg
};

struct SurfaceWindow {
  const char* observable;  // angle_mid ...
  double SurfaceAngles::*angle;
  double from, to;  // over R
};

constexpr SurfaceWindow kSurfaceWindows[] = {{"angle_mid", &SurfaceAngles::mid, -0.5, 0.5},
                                             {"angle_upper", &SurfaceAngles::upper, -0.62, -0.24},
                                             {"angle_lower", &SurfaceAngles::lower, 0.24, 0.62}};

// In any order. Errors: std::invalid_argument that names the window where there are less than five points, or points
// that reach across less than 0.8 of it.
SurfaceAngles surface_angles(const std::vector<SurfacePoint>& points, double drum_radius);

// The mean picture of looks at a drum's bed.
class Silhouette {
 public:
  static constexpr std::size_t kColumns = 84, kLevels = 840;  // across the drum's diameter, both ways

  explicit Silhouette(double drum_radius);
  void add_look(const std::vector<Grain>& grains);

  // The contour at half, of the columns that have one, along x.
  std::vector<SurfacePoint> surface() const;
  // Part of the drum's section that is dark in half of the looks.
  double dark_area() const;

 private:
  double darkness(std::size_t column, std::size_t level) const;  // 0 to 1

  double radius_;
  int looks_ = 0;
  std::vector<int> dark_;  // looks in which the middle of a cell was dark; levels of one column stand together
};

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Angle of repose of a heap: a cone fitted over all azimuths.
//
// 1. Surface. In kConeStrips strips from the axis, by cells of a grain diameter (round_surface.h).
// 2. Flank. The mean profile is the mean over the strips at each radius; the flank is where it lies between kFlankTop
// and
//    kFlankFoot of its greatest height: the rounded top and the thin foot are no cone. It is chosen by radius, never by
//    the height of a single cell, which would cut off high and low ones and tilt the line.
// 3. Line. z = a - b r by least squares through the flank's cells of each strip; the angle of a strip is atan b.
//    The angle is the mean over strips, u their standard deviation over the square root of their number: azimuths are
//    the repetitions. A heap off its axis by a little is steeper on one side and flatter on the other, which cancels;
//    one whose summit is further off than kOnAxis diameters is measured about its summit (about_summit), the middle of
//    the part above kFlankTop of its height.
//
// Limits: a constant angle on the flank is assumed; `curvature` tells how much steeper the upper half is than the
// lower, `off_cone` how far the flank's cells lie from the mean cone. Beyond kMostOffCone of the height (two heaps, a
// half of one, a step in it) the angle is no slope of anything, and a warning says so. Tested on synthetic cones of
// known angle (tests/rigs/cone_fit_test.cpp). Errors: BadInput if the flank is shorter than kLeastFlank cells: the heap
// has too few grains.
#pragma once

#include <string>
#include <vector>

#include "rigs/repose/heap.h"
#include "rigs/round_surface.h"

namespace vielto {

constexpr int kConeStrips = 24;
constexpr double kFlankTop = 0.8, kFlankFoot = 0.2;  // of the greatest height
constexpr int kLeastFlank = 4;                       // cells
constexpr double kOnAxis = 2;                        // diameters
constexpr double kMostOffCone = 0.15;                // of the height

struct ConeFit {
  double angle = 0, u = 0;              // deg
  double spread = 0;                    // deg, standard deviation over the azimuth
  double curvature = 0;                 // deg, angle of the flank's upper half less that of its lower half
  double height = 0;                    // m, of the mean profile
  double flank_from = 0, flank_to = 0;  // m, radii
  double intercept = 0, slope = 0;      // mean line z = intercept - slope r, m and 1
  double off_axis = 0;                  // m, of the heap's summit from the cylinder's axis
  double off_cone = 0;                  // m, root mean square of the flank's cells from the mean line
  bool about_summit = false;            // the strips go from the summit, not from the axis
  std::vector<double> strip_angles;     // deg
  std::vector<SurfacePoint> profile;    // mean over the strips
  std::vector<SurfacePoint> surface;    // all cells
  std::vector<std::string> warnings;    // limits violated
};

ConeFit cone_fit(const Heap& heap);

}  // namespace vielto

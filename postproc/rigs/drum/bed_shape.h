// SPDX-License-Identifier: GPL-2.0-or-later
// What a bed of spheres shows: the slope of its free surface and its bulk density.
//
// Surface: along the horizontal coordinate across the axis, the window is cut into strips three mean radii wide; the
// top of the highest grain of each is a point of the surface. The slope is that of the least-squares line through these
// points, its standard error that of the line, from their scatter about it. Default window: the middle half of
// the grains' extent.
// Drum: the same line in a frame that is turned with the bed. Its upward axis points from the bed's centroid to the
// drum's axis, so that it is normal to the chord of a circular segment; the window is the middle half of that chord. So
// neither a steep surface nor a bed of more than half the circle, whose highest grains lie along the mantle, bends it.
// Bulk density: grain density times the volume of grains in a box (that of a sphere the box cuts from a grid of points
// in it; an overlap counts twice, as the grains' mass does). Its standard error is the scatter of the box's eighths
// over sqrt(8). The box should lie inside the bed, a few grains off walls and surface.
//
// Errors: std::invalid_argument saying what is wrong: fewer than four strips that hold grains, no grain in an eighth, a
// bed evenly about the drum's axis.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "rigs/grain.h"

namespace vielto {

struct Estimate {
  double value = 0, u = 0;
};

struct BedAxes {
  int across = 1, up = 2;  // 0 x, 1 y, 2 z
};

// deg, positive whichever way the surface falls.
Estimate surface_angle(const std::vector<Grain>& grains, BedAxes axes, std::optional<std::pair<double, double>> window);

// deg; the drum's axis is x, through y = z = 0; `drum_radius` in m.
Estimate drum_surface_angle(const std::vector<Grain>& grains, double drum_radius);

// kg/m3; box: x from, to, y from, to, z from, to.
Estimate bulk_density(const std::vector<Grain>& grains, double grain_density, const std::array<double, 6>& box);

// Of snapshots of one bed, in their order: the mean, with the autocorrelated scatter over time and the snapshots' own
// uncertainty over the number of independent ones.
Estimate over_time(const std::vector<Estimate>& snapshots);

}  // namespace vielto

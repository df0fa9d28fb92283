// SPDX-License-Identifier: GPL-2.0-or-later
// The surface of a bed of grains about a vertical axis: a heap, a crater.
//
// From the axis go strips, each 2 d wide, evenly over the azimuth; each is cut into cells d long. The surface of a cell
// is the top z + R of its highest grain. All cells have the same area: with sectors, an outer cell would hold more
// grains, its highest would lie higher, and a slope would come out too small.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "rigs/grain.h"

namespace vielto {

struct SurfacePoint {
  double r = 0, z = 0;  // m
};

constexpr double kNoGrain = -std::numeric_limits<double>::infinity();

// Top of the highest grain in each cell, [strip][cell]; kNoGrain where there is none. `axis`: x and y, m.
std::vector<std::vector<double>> surface_strips(const std::vector<Grain>& grains, const std::array<double, 2>& axis,
                                                double d, int strips);

// z = intercept - slope r by least squares.
struct RadialLine {
  double intercept = 0, slope = 0;
  double angle() const;  // deg, positive where it falls outwards
};
RadialLine line_through(const std::vector<SurfacePoint>& points);

// Mean over the strips with its standard uncertainty: azimuths are the repetitions.
struct AzimuthMean {
  double mean = 0, spread = 0, u = 0;
};
AzimuthMean azimuth_mean(const std::vector<double>& of_strips);

}  // namespace vielto

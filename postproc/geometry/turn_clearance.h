// SPDX-License-Identifier: GPL-2.0-or-later
// The least distance between what stands and what turns, over a whole turn.
//
// A point at the axial place s and the radius r from the axis passes every angle, so that over a turn two points come
// as near as they lie in the half plane (s, r). Both surfaces are cut into pieces whose image there is no wider than d
// in s or in r; a piece hangs together, so that it takes every value in its other direction, and samples d/2 apart
// along it lie within 1.12 d of all of it. Of samples in one cell of d x d one is kept, of pieces with the same box to
// d one is sampled, 1.42 d each. Pieces farther away than the least distance between samples and the error of both
// sides, 8 d, are left out, and the others are cut anew with a smaller d.
#pragma once

#include "geometry/surface.h"

namespace vielto {

struct TurnAxis {
  Point origin = Point::Zero();
  Point direction = Point::UnitX();  // of length 1
};

struct TurnClearance {
  double distance = 0;   // m, off by at most `tolerance`
  double tolerance = 0;  // m
  double s = 0, r = 0;   // m, where
};

// Needs triangles in both.
TurnClearance turn_clearance(const Triangles& standing, const Triangles& turning, const TurnAxis& axis,
                             double tolerance);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The least distance between what stands and what turns, over a whole turn.
//
// A point at the axial place s and the radius r from the axis passes every angle, so that over a turn two points come
// as near as they lie in the half plane (s, r). Each surface is a set of triangles with the box of its image there, and
// is halved again and again; of all pairs of such sets the one whose boxes are nearest is halved next, until the two
// nearest boxes are small. No pair is nearer than its boxes, and each box holds a point of its surface.
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

// SPDX-License-Identifier: GPL-2.0-or-later
// Rotating drum: axis along x, 0 <= x <= drumLength, normals inward; parts drum (mantle) and ends (squares around
// the circle). A tilt of the axis is left to the
// direction of gravity: (-sin tilt, 0, -cos tilt) puts the bed on the end x = 0.
#pragma once

#include "geometry/rig_geometry.h"

namespace vielto {

RigGeometry drum_geometry(GeometryInput& input);

}  // namespace vielto

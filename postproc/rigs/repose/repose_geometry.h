// SPDX-License-Identifier: GPL-2.0-or-later
// Angle of repose by a lifted cylinder: base (square or disc, normal up) in z = 0, cylinder (open, normals inward)
// standing on it.
#pragma once

#include "geometry/rig_geometry.h"

namespace vielto {

RigGeometry repose_geometry(GeometryInput& input);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Mixer: shaft axis along x through y = z = 0, gravity -z, drum half circle below z = 0, open top at z = drumHeight -
// R. Angles count from +y towards +z, positive rotation about +x; a positive inclination pushes the grains towards +x.
// Parts: drum, shaft, stems, paddle_1 ... A slice (slicePaddles >= 2) is periodic in x, 0 <= x <= slicePaddles *
// drumLength / paddleCount; slicePaddles = 0 is the whole drum with both end walls. The drum's chords are inscribed:
// its vertices lie on the circle.
#pragma once

#include "geometry/rig_geometry.h"

namespace vielto {

RigGeometry mixer_geometry(GeometryInput& input);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Direct shear box: split plane z = 0, shear along x, centre x = y = 0, normals towards the grains. The upper half
// stands splitGap above the lower: were the side walls flush, a grain at the split would be counted by both meshes.
// Parts: lower, upper (each with flanges of flangeLength at the split on both sides along x), plate (closed, normals
// outward) at the top of the upper half.
#pragma once

#include "geometry/rig_geometry.h"

namespace vielto {

RigGeometry shearbox_geometry(GeometryInput& input);

}  // namespace vielto

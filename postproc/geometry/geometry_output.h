// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto geometry` leaves in a folder: one STL a part, geometry.par for LIGGGHTS, .vtp files and a picture for
// people; inputs.json, file -> SHA-256, if it was made from other files than a parameter file.
#pragma once

#include <string>

#include "geometry/rig_geometry.h"

namespace vielto {

// The text of geometry.par: derived numbers, and for every parameter the mesh depends on its value and a check that
// stops a run whose value (from -var or a parameter file included before) differs. A text is compared through a
// variable named after it, NAME_VALUE, because LIGGGHTS' `if` knows numbers only: 1 for the mesh's value, and an index
// variable that exists keeps its value, so that the run's own value makes a new one, 0, only if it differs.
std::string geometry_par(const RigGeometry& geometry, const GeometryInput& input);

// Writes all files into `folder` (made if missing); geometry.par goes first and comes back last, so that a folder with
// it is whole. Paddle files of an earlier, larger mesh are removed. Errors: std::runtime_error if a file cannot be
// written.
void write_geometry(const RigGeometry& geometry, const GeometryInput& input, const std::string& folder);

// A rendered view (PNG), containers translucent. Needs a display or xvfb-run.
void write_picture(const RigGeometry& geometry, const std::string& path);

}  // namespace vielto

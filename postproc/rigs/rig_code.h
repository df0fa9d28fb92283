// SPDX-License-Identifier: GPL-2.0-or-later
// The code of a rig: its meshes, and what is made of its record. Each rig of cases/rigs.toml defines NAME_rig() in
// postproc/rigs/NAME; CMake makes the list of them from that table.
#pragma once

#include <string>

#include "geometry/rig_geometry.h"
#include "rigs/post.h"

namespace vielto {

struct RigCode {
  RigGeometry (*geometry)(GeometryInput& input);
  PostResult (*post)(const PostInput& input);
  bool takes_idle = false;  // `post` makes use of a record of the empty machine
};

// Null if there is no such rig, or it is one of a user's own.
const RigCode* find_rig_code(const std::string& rig);

// The meshes of the rig named by the parameter `rig`. Errors: BadInput also for a triangle that LIGGGHTS would refuse.
RigGeometry rig_geometry(GeometryInput& input);

}  // namespace vielto

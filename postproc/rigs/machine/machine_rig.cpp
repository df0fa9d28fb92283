// SPDX-License-Identifier: GPL-2.0-or-later
// A machine of a user's own: meshes from STL files; its record is that of a rotor.
#include "rigs/machine/machine_geometry.h"
#include "rigs/power_post.h"
#include "rigs/rig_code.h"

namespace vielto {

RigCode machine_rig() { return {machine_geometry, post_power, true}; }

}  // namespace vielto

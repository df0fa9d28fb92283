// SPDX-License-Identifier: GPL-2.0-or-later
// The paddle mixer: its meshes; its record is that of a rotor.
#include "rigs/mixer/mixer_geometry.h"
#include "rigs/power_post.h"
#include "rigs/rig_code.h"

namespace vielto {

RigCode mixer_rig() { return {mixer_geometry, post_power, true}; }

}  // namespace vielto

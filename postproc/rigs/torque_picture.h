// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a mixer's run, for people.
#pragma once

#include <string>

#include "rigs/mixing_power.h"
#include "rigs/rig_picture.h"

namespace vielto {

// Torque of the grains on the whole shaft (slice torque times N/k) over time, its turn means, and the averaged turns
// shaded. Errors: std::runtime_error if the file cannot be written.
void draw_torque(const TorqueRecord& record, const MixingPower& power, const std::string& path);

// The rotor of a record, for the picture of its rig.
TurningRotor turning_rotor(const TorqueRecord& record);

}  // namespace vielto

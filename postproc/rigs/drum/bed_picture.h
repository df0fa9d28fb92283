// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "rigs/drum/bed_angle.h"

namespace vielto {

// The angle of the bed in a drum at each look.
// Errors: std::runtime_error if the file cannot be written.
void draw_bed(const BedAngle& bed, const std::string& path);

}  // namespace vielto

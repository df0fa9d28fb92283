// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto post` writes of a rotating drum: drum.json and table.txt (the numbers, bed_angle.h), looks.csv (the
// angle at each look), observations.csv (`angle`, and angle_mid, angle_upper, angle_lower where there is a surface),
// surface.csv (its contour, in the frame of free_surface.h). SI units, angles in degrees; *_u: standard uncertainty
// (k = 1).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "rigs/drum/bed_angle.h"

namespace vielto {

nlohmann::ordered_json bed_json(const BedAngle& bed);
std::string bed_table(const BedAngle& bed);
std::string bed_looks_csv(const BedAngle& bed);
std::string bed_surface_csv(const BedSurface& surface);
std::vector<Observation> bed_observations(const BedAngle& bed, const TestLabel& label);

}  // namespace vielto

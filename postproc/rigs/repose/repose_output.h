// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto post` writes of a heap: repose.json and table.txt (the numbers, cone_fit.h), profile.csv (mean profile),
// observations.csv (one row, `angle`). SI units, angles in degrees; *_u: standard uncertainty (k = 1).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "rigs/repose/cone_fit.h"

namespace vielto {

nlohmann::ordered_json repose_json(const Heap& heap, const ConeFit& fit);
std::string repose_table(const Heap& heap, const ConeFit& fit);
std::string repose_profile_csv(const ConeFit& fit);
std::vector<Observation> repose_observations(const Heap& heap, const ConeFit& fit, const TestLabel& label);

}  // namespace vielto

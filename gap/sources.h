// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the source within the run. Which part of the mixer (paddles, stems, shaft; drum: what its wall takes back)
// carries the torque in the baseline, and where an effect acts on it, from the library's own runs: the measurement
// knows their sum only.
//
// sources.csv in the library's folder: test,source,torque_Nm, torques on the grains about the axis, of the whole drum.
// Shares and changes are parts of the rotor's torque (paddles + stems + shaft) in the baseline under the same
// conditions; u from the scatter of the baseline's seeds, which an effect's single run has too.
//
// Errors: BadInput with file and line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "library.h"

namespace vielto::gap {

// [{speed, fill, source, share, u, effects: [{name, strength, change, u}]}]; empty without sources.csv. `effects`:
// those that are shown, at the largest strength that was run.
nlohmann::ordered_json sources_json(const Library& library, const std::vector<std::string>& effects);

}  // namespace vielto::gap

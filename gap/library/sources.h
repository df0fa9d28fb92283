// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the source within the run. What carries the torque in the baseline, and where an effect acts on it, from the
// library's own runs: the measurement knows the sum only. Three ways of dividing it (`kind`):
//   part   paddles, stems, shaft; drum: what its wall takes back. Of a machine of one's own the parts that turn
//   standing   of such a machine those that stand, by their names
//   phase  the paddles' torque by the place of a paddle in its turn: sectors of 60 deg about the lowest point, in the
//          direction of rotation ("0 to 60 deg": rising from the lowest point); not for the whole drum
//   loss   where the work goes: normal and tangential dashpot, sliding, rolling, twisting; where runs kept accounts
//
// sources.csv in the library's folder: test,kind,source,torque_Nm, torques on the grains about the axis, of the whole
// drum; a loss P as the torque P/(2 pi n).
// Shares and changes are parts of the rotor's torque (all parts that turn) in the baseline under the same
// conditions; u from the scatter of the baseline's seeds, which an effect's single run has too.
//
// The paddles' torque by sector is an observable too (paddle_sectors.h): runs of before that was so have it from here.
//
// Errors: BadInput with file and line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gap/library/library.h"

namespace vielto::gap {

constexpr const char* kSourcesHeader = "test,kind,source,torque_Nm\n";

// The rows of one run, from its power.json and its phase.csv, if that is there.
std::string sources_of_run(const std::string& test, const nlohmann::json& power, const std::string& phase_file);

// Adds the paddle_share_* of every run of the mixer that sources.csv holds and whose tables do not state them.
void add_paddle_shares(Library& library);

// [{speed, fill, kind, source, share, u, effects: [{name, strength, change, u}]}]; empty without sources.csv.
// `effects`: those that are shown, at the largest strength that was run.
nlohmann::ordered_json sources_json(const Library& library, const std::vector<std::string>& effects);

}  // namespace vielto::gap

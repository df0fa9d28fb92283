// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto post` writes: power.json and table.txt (the numbers), phase.csv (torque over the phase of the turn),
// observations.csv (rows of the observation table). SI units; a torque or power is the whole drum's.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "rigs/mixing_power.h"

namespace vielto {

// power.json. Units end the key (_W, _Nm, _kg); speed in 1/s, all else is a number. *_u: standard uncertainty (k = 1);
// *_u95: half width of the 95 % interval; null: not recorded or not asked for. Beside what mixing_power.h defines:
//   turns_total, turns_averaged  whole turns recorded and averaged; turn_first: turns done when the average begins
//   drift_per_turn, drift_probability  slope of the averaged turn means over their mean, and its chance in steady noise
//   torque_ripple_noise          what noise alone would show as ripple (whole_shaft.h)
//   N_P ... Fr_M                 null: the record states no lever, bulk density or bulk cohesion
//   thesis_power_W, relative_gap null: not the mixer of the thesis
//   thesis_in_range              fill and speed lie where the published equation was fitted
//   quality                      ok is false if a limit is violated: `warnings` says which; `notes` violate none
nlohmann::ordered_json power_json(const MixingPower& power);

// For people: aligned, with units.
std::string power_table(const MixingPower& power);

// phase_deg (middle of the phase), paddle_Nm (one paddle against its own angle; empty for the whole drum), then the
// whole drum against the angle of the shaft: paddles_Nm, stems_Nm, shaft_Nm, rotor_Nm and its standard uncertainty,
// drum_Nm. Of a machine no paddle_Nm, and its own parts, those that turn before the rotor.
std::string phase_csv(const MixingPower& power);

// Rows for power_loaded and power_idle, or power without an idling record, for torque_ripple, and of a slice for the
// shares of a paddle's torque by its place.
std::vector<Observation> power_observations(const MixingPower& power, const TestLabel& label);

// Such as n1.21-l0.15.
std::string default_test_name(const MixingPower& power);

}  // namespace vielto

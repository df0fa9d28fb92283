// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: what is meant by a gap that is none of the library's effects, the model `unknown`.
//
// Equation: y = f + b + z, z normal with covariance a^2 Q K Q. Amplitudes a: unknown.amplitude_low to amplitude_high of
// diagnosis.toml, even in the logarithm, all as probable (evidence.h).
//   Q = diag(q), q_i the effects' usual size at row i: root of the mean over effects of (r(low/2)^2 + r(high/2)^2)/2,
//     at least unknown.floor of the value; 0 for bench rows: a shaft that turns slowly is a slip by definition. What a
//     bench shows has a name, and none of it is unknown, but for the kin below
//   K one of two correlations, as probable as each other, between rows at conditions c, c' in units of the library's
//   range:
//     smooth            0.2 + [same observable] (0.3 + 0.3 exp(-|c-c'|^2 / 2 0.5^2) + 0.2 [same conditions])
//     level and trends  0.2 + [same observable] 0.8 (1 + sum_k (2 c_k - 1)(2 c'_k - 1)) / (1 + number of conditions)
//   so that a gap may be alike in all that an apparatus shows, smooth within an observable, or a level and a slope with
//   each condition, all of one size at the ends of the range. Nothing is shared between apparatuses.
//
// Kin: a loss of the drive that the library does not hold moves the dead weight's reading (unknown.kin) and the power
// by one factor, as those that it holds do, and goes with the speed in a way of its own. With the part
// unknown.kin_share of the unknown's probability, which is about that of one effect, z is 0 but on the rows of that
// observable and on those that all effects of the measurement chain on it move, with
//   q_i  what these effects usually do to the bench's rows, root of the mean square over effects and rows, relative
//   K    0.5 + 0.3 exp(-ln(n/n')^2 / 2 ln(2)^2) + 0.2 [same observable, same conditions], n the shaft's speed
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "gap/emulator/table_model.h"
#include "gap/library/settings.h"

namespace vielto::gap {

// Sets the sizes alone, of the effects that are there now.
void set_unknown_sizes(TableModel& model, const Settings& settings);
// Sets `unknown` of a model whose effects and scale are there. `conditions`: c of each row.
void set_unknown_gap(TableModel& model, const std::vector<Eigen::VectorXd>& conditions, const Settings& settings);

}  // namespace vielto::gap

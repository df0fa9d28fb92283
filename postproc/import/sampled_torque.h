// SPDX-License-Identifier: GPL-2.0-or-later
// Torque samples at any times, from a script of one's own -> means over the phases of the turn, as a torque record
// holds them (torque_record.h), so that the steady part and the uncertainty come from the same code.
//
// Between samples the torque is taken as linear; the phase means are its exact means. Turns count from `start`; a last
// turn that the samples do not cover whole is left out, no sample inside is.
//
// Errors: BadInput with file, line and column for times that do not rise, a value that is not finite, a gap between
// samples of over an eighth of a turn (a paddle passes unseen), samples that begin after `start`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/column_text.h"

namespace vielto {

struct TorqueColumns {
  std::string time, torque;                   // names of the columns
  double time_factor = 1, torque_factor = 1;  // to s and N m; the torque's sign: positive if the drive supplies
  std::optional<double> start;                // s, when the rotation began; default: the first sample
  bool skip_nan = false;                      // leave out rows without a torque instead of refusing them
};

struct SampledTorque {
  std::vector<double> signal;  // N m, kPhases values a turn
  int turns = 0;
  double samples_per_turn = 0;
};

SampledTorque sampled_torque(const ColumnText& text, const TorqueColumns& columns, double speed);

}  // namespace vielto

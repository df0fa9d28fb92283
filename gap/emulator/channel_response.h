// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the response of one channel's rows to an effect over its strengths: by a transform of the baseline where the
// effect's file has one for the observable, by the baseline at shifted conditions, or by the library's runs.
// Errors: BadInput for a row that lacks the condition which an effect shifts.
#pragma once

#include <vector>

#include "gap/emulator/channel.h"
#include "gap/emulator/table_model.h"

namespace vielto::gap {

// No response yet: strengths over the prior range, closer together near 0, for n rows.
EffectResponse empty_response(const Effect& effect, Eigen::Index n);

// Whether an effect that acts on the channel's rig is known there.
bool is_known(const Channel& channel, const Effect& effect);

// Fills the rows of `channel`; the model's rows and baseline are there.
void fill_response(const Channel& channel, const Effect& effect, const std::vector<Eigen::Index>& rows,
                   const TableModel& model, EffectResponse& response);

}  // namespace vielto::gap

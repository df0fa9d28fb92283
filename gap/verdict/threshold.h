// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: how large the best rival's log odds against no gap may get by chance, for the verdict's false-alarm rate.
//
// Bootstrap: tables without a gap are drawn from the emulator as if it were the truth (noise, seeds, a member of the
// calibrated family, law discrepancy) and judged with libraries redrawn with fresh seed noise. The threshold is the
// quantile 1 - false_alarm of the largest log odds (evidence.h), at least 0.
#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "gap/emulator/emulator.h"

namespace vielto::gap {

struct Threshold {
  double log_odds = 0;
  double low95 = 0, high95 = 0;  // of the quantile, by order statistics
  int draws = 0, libraries = 0;
  std::uint64_t seed = 0;
};

// One table without a gap.
Eigen::VectorXd draw_without_gap(const TableModel& truth, std::mt19937_64& random);

// `judge` gives the same rows' model by a redrawn emulator.
Threshold bootstrap_threshold(const Emulator& emulator, const TableModel& truth, const Settings& settings,
                              std::uint64_t seed, const std::function<TableModel(const Emulator&)>& judge);

}  // namespace vielto::gap

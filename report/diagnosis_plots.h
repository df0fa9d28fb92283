// SPDX-License-Identifier: GPL-2.0-or-later
// Measured against simulated, from the `points` of a diagnosis: over each condition, row by row where no condition
// takes three values, and as a map over speed and fill.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/plot.h"

namespace vielto::gap {

struct ComparisonPlots {
  std::string over;  // the condition; empty: row by row
  std::vector<Plot> plots;
};

// `with_effect` names the points after it. The first is over the condition with the most values. `name` begins the
// names of the files.
std::vector<ComparisonPlots> comparison_plots(const nlohmann::json& points, const std::string& name,
                                              const std::string& with_effect);

// Simulated over measured, less 1, in per cent; before and, if there is one, after the effect. Of observables with two
// speeds and two fills or more.
std::vector<Plot> gap_maps(const nlohmann::json& points, const std::string& name, const std::string& with_effect);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// The numbers the diagnosis takes as given (libraries/diagnosis.toml says what each means).
//
// Errors: BadInput with file and line for a missing or unknown key, a value of another type or out of its range.
#pragma once

#include <string>

#include "core/toml_table.h"

namespace vielto::gap {

struct Settings {
  double prior_no_gap = 0, prior_single = 0, prior_pair = 0, prior_unknown = 0;  // sum 1
  double shape_error = 0, interaction = 0;
  double unknown_low = 0, unknown_high = 0, unknown_floor = 0, unknown_kin_share = 0;
  std::string unknown_kin;
  double false_alarm = 0, name_probability = 0, group_probability = 0, unknown_probability = 0, misfit_probability = 0,
         name_misfit_probability = 0;
  int draws = 0, libraries = 0;
  double group_distance = 0, detectable_distance = 0;
  double false_discovery_rate = 0;

  static Settings read(const std::string& path);
};

}  // namespace vielto::gap

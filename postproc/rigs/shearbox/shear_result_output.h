// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto post` writes of a direct shear test: shear.json and table.txt (the numbers, shear_result.h), curve.csv
// (block means), observations.csv (rows of the observation table). SI units; *_u: standard uncertainty (k = 1).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "rigs/shearbox/shear_result.h"

namespace vielto {

nlohmann::ordered_json shear_json(const ShearResult& result);
std::string shear_table(const ShearResult& result);
std::string shear_curve_csv(const ShearResult& result);
std::vector<Observation> shear_observations(const ShearResult& result, const TestLabel& label);

// Such as shear-19610Pa-0.05.
std::string default_test_name(const ShearResult& result);

}  // namespace vielto

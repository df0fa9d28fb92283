// SPDX-License-Identifier: GPL-2.0-or-later
// A diagnosis of the gap as a page: the verdict in a sentence, measured against simulated, a map of the gap, the
// ranking, how far the gap closes, the next test, and the details folded. Reads what diagnosis.json says; computes no
// result of its own. Points, strengths of every effect and a reference state are shown where the file has them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/page.h"

namespace vielto::gap {

bool is_diagnosis(const nlohmann::json& j);

// Adds sentence, key figures and sections. `name` begins the names of its plots' files.
// Errors: BadInput naming `path` for a file that lacks what every diagnosis has.
void add_diagnosis(const nlohmann::json& diagnosis, const std::string& path, const std::string& name, Page& page);

// The page alone, as `vielto gap diagnose` writes it; without plots where the plotting library is not installed.
std::string diagnosis_page(const nlohmann::ordered_json& diagnosis, const std::string& title);

}  // namespace vielto::gap

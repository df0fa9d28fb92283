// SPDX-License-Identifier: GPL-2.0-or-later
// The page a person reads: the verdict in one sentence, the map of the gap, the ranking, before and after, the next
// test. One HTML file that needs nothing else. Made from diagnosis.json, so that page and file cannot disagree.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vielto::gap {

std::string diagnosis_page(const nlohmann::ordered_json& diagnosis, const std::string& title);

}  // namespace vielto::gap

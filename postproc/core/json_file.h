// SPDX-License-Identifier: GPL-2.0-or-later
// JSON files, which anyone may have written.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/bad_input.h"

namespace vielto {

// Whoever walks through JSON calls himself for each level; no file of ours has more than a few.
constexpr int kMostJsonLevels = 100;

// Errors: BadInput for a file that cannot be read, is no JSON, or nests deeper than kMostJsonLevels.
template <class Json = nlohmann::json>
Json read_json_file(const std::string& path, const std::string& mend) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path, 0, "cannot be read", mend);
  const auto shallow = [&](int depth, typename Json::parse_event_t, Json&) {
    if (depth > kMostJsonLevels)
      throw BadInput(path, 0, fmt::format("nests deeper than {} levels", kMostJsonLevels), mend);
    return true;
  };
  try {
    return Json::parse(in, shallow);
  } catch (const typename Json::exception& error) {
    throw BadInput(path, 0, fmt::format("is no JSON ({})", error.what()), mend);
  }
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/json_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace vielto {
namespace {

using nlohmann::json;

constexpr std::size_t kMostJsonRows = 300;

void flatten(const json& value, const std::string& key, Table& table) {
  if (table.rows.size() == kMostJsonRows) return;
  const auto plain = [](const json& v) {
    return v.is_string()         ? v.get<std::string>()
           : v.is_number_float() ? fmt::format("{:.6g}", v.get<double>())
                                 : v.dump();
  };
  if (value.is_object()) {
    for (const auto& [name, inner] : value.items()) flatten(inner, key.empty() ? name : key + "." + name, table);
  } else if (value.is_array() &&
             std::any_of(value.begin(), value.end(), [](const json& v) { return v.is_structured(); })) {
    for (std::size_t i = 0; i < value.size(); ++i) flatten(value[i], fmt::format("{}[{}]", key, i), table);
  } else if (value.is_array()) {
    std::string text;
    for (const json& v : value) text += (text.empty() ? "" : ", ") + plain(v);
    table.rows.push_back({key, text});
  } else {
    table.rows.push_back({key, plain(value)});
  }
}

}  // namespace

Table json_table(const json& value) {
  Table table{"", {"key", "value"}, {}};
  flatten(value, "", table);
  if (table.rows.size() == kMostJsonRows) table.caption = fmt::format("The first {} values", kMostJsonRows);
  return table;
}

}  // namespace vielto

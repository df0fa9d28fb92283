// SPDX-License-Identifier: GPL-2.0-or-later
// How the library's own CSV files are read: a header of known columns, then any others, rows of as many fields.
// Errors: BadInput with file and line.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto::gap {

// A CSV file whose header begins with `first` columns; calls use(line, fields) for each row, returns the other columns.
template <class Use>
std::vector<std::string> read_columns(const std::string& path, const std::vector<std::string>& first, Use use) {
  std::ifstream in;
  std::string line = open_table(in, path);
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  const std::vector<std::string> header(fields.begin(), fields.end());
  if (header.size() < first.size() || !std::equal(first.begin(), first.end(), header.begin()))
    throw BadInput(path, 1, "has another header", fmt::format("begin it with '{}'", fmt::join(first, ",")));
  int number = 1;
  while (std::getline(in, line)) {
    split_fields(line, fields);
    ++number;
    if (fields.size() != header.size())
      throw BadInput(path, number, fmt::format("has {} fields instead of {}", fields.size(), header.size()),
                     "write one value a column, without blank lines");
    use(number, fields);
  }
  if (number == 1) throw BadInput(path, 0, "holds no row below its header", "add at least one row");
  return {header.begin() + static_cast<std::ptrdiff_t>(first.size()), header.end()};
}

inline double column_number(const std::string& path, int line, const std::string& column, std::string_view field) {
  const auto value = finite_number(field);
  if (!value)
    throw BadInput(path, line, column, fmt::format("'{}' is not a finite number", field), "write a decimal number");
  return *value;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/column_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto {
namespace {

std::vector<std::string> fields_of(std::string_view line) {
  const bool separated = line.find_first_of(",;") != std::string_view::npos;
  std::vector<std::string> fields;
  std::string field;
  const auto end_field = [&] {
    if (separated || !field.empty()) fields.push_back(field);
    field.clear();
  };
  for (const char c : line) {
    const bool blank = c == ' ' || c == '\t' || c == '\r';
    if (separated ? c == ',' || c == ';' : blank)
      end_field();
    else if (!blank)
      field += c;
  }
  end_field();
  return fields;
}

std::optional<double> number_or_nan(const std::string& field) {
  if (field == "nan" || field == "NaN" || field == "-nan") return std::numeric_limits<double>::quiet_NaN();
  return finite_number(field);
}

// `#format x_y_z_r` is how Yade's export.text names its columns.
std::vector<std::string> names_of(std::string line) {
  line.erase(0, line.find_first_not_of("# \t"));
  const std::string format = "format ";
  if (line.rfind(format, 0) == 0) {
    line.erase(0, format.size());
    std::replace(line.begin(), line.end(), '_', ' ');
  }
  return fields_of(line);
}

}  // namespace

std::size_t ColumnText::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw BadInput(path, 0, fmt::format("has no column '{}'", name),
                   fmt::format("choose from {}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

ColumnText read_column_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path, 0, "cannot be read", "name an existing file");
  ColumnText text;
  text.path = path;
  std::string line;
  int number = 0;
  while (std::getline(in, line)) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::string plain = line;
    std::replace(plain.begin(), plain.end(), '\t', ' ');
    if (!is_plain_utf8(plain))
      throw BadInput(path, number, "is no text", "unpack it first if it is packed (.bz2, .gz)");
    const auto begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos) continue;
    const bool comment = line[begin] == '#';
    if (comment && !text.rows.empty()) continue;
    std::vector<std::string> fields;
    if (!comment) fields = fields_of(line);
    std::vector<double> row;
    for (const std::string& field : fields) {
      // between commas nothing may stand where a program had no value, as nan may
      const bool empty = field.empty() && !text.names.empty();
      const auto value = empty ? std::numeric_limits<double>::quiet_NaN() : number_or_nan(field);
      if (value) {
        row.push_back(*value);
      } else if (text.rows.empty() && row.empty()) {
        break;  // still the line of names
      } else {
        throw BadInput(path, number, text.names.size() > row.size() ? text.names[row.size()] : "",
                       fmt::format("'{}' is not a finite number", field), "write decimal numbers");
      }
    }
    if (row.empty()) {
      text.names = names_of(line);
      continue;
    }
    if (text.names.empty())
      throw BadInput(path, number, "begins with numbers", "put a line with the names of the columns before them");
    if (row.size() != text.names.size())
      throw BadInput(path, number, fmt::format("has {} numbers for {} columns", row.size(), text.names.size()),
                     "write one number a column; a name must not hold blanks");
    text.rows.push_back(std::move(row));
    text.lines.push_back(number);
  }
  if (text.rows.empty()) throw BadInput(path, 0, "holds no numbers", "save the record after the run, not before");
  return text;
}

}  // namespace vielto

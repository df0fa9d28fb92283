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

// How a file divides its columns: the line of names says so, and every row keeps to it.
enum class Separator { blank, comma, semicolon };

Separator separator_of(std::string_view names) {
  if (names.find(';') != std::string_view::npos) return Separator::semicolon;
  return names.find(',') != std::string_view::npos ? Separator::comma : Separator::blank;
}

std::vector<std::string> fields_of(std::string_view line, Separator separator) {
  const bool by_blank = separator == Separator::blank;
  const char mark = separator == Separator::semicolon ? ';' : ',';
  std::vector<std::string> fields;
  std::string field;
  const auto end_field = [&] {
    if (!by_blank || !field.empty()) fields.push_back(field);
    field.clear();
  };
  for (const char c : line) {
    const bool blank = c == ' ' || c == '\t' || c == '\r';
    if (by_blank ? blank : c == mark)
      end_field();
    else if (!blank)
      field += c;
  }
  end_field();
  return fields;
}

// Numbers of one file: with decimal points or with decimal commas, never both. A comma that divides the columns is
// none.
class Numbers {
 public:
  explicit Numbers(std::string path) : path_(std::move(path)) {}

  // `comma`: a comma in the field would be a decimal one. Nothing for a field that is no number.
  std::optional<double> read(const std::string& field, bool comma, int line) {
    if (field == "nan" || field == "NaN" || field == "-nan") return std::numeric_limits<double>::quiet_NaN();
    const auto mark = comma ? field.find(',') : std::string::npos;
    if (mark == std::string::npos) {
      const auto value = finite_number(field);
      if (value && field.find('.') != std::string::npos) see(points_, commas_, line);
      return value;
    }
    std::string pointed = field;
    pointed[mark] = '.';
    // "1,234.5" and "1,234,567" group thousands and are no numbers here
    if (field.find('.') != std::string::npos || field.find(',', mark + 1) != std::string::npos) return std::nullopt;
    const auto value = finite_number(pointed);
    if (value) see(commas_, points_, line);
    return value;
  }

 private:
  void see(int& mine, int other, int line) const {
    if (other != 0)
      throw BadInput(path_, line, fmt::format("mixes decimal commas and decimal points (other kind in line {})", other),
                     "write all numbers with decimal points, or all with decimal commas");
    if (mine == 0) mine = line;
  }

  std::string path_;
  int points_ = 0, commas_ = 0;  // line of the first of each kind
};

// `#format x_y_z_r` is how Yade's export.text names its columns.
std::string names_line(std::string line) {
  line.erase(0, std::min(line.size(), line.find_first_not_of("# \t")));
  const std::string format = "format ";
  if (line.rfind(format, 0) == 0) {
    line.erase(0, format.size());
    std::replace(line.begin(), line.end(), '_', ' ');
  }
  return line;
}

bool is_names(const std::vector<std::string>& fields, Numbers numbers, bool comma, int line) {
  return std::any_of(fields.begin(), fields.end(), [](const std::string& field) { return !field.empty(); }) &&
         std::none_of(fields.begin(), fields.end(),
                      [&](const std::string& field) { return numbers.read(field, comma, line).has_value(); });
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
  Numbers numbers(path);
  Separator separator = Separator::blank;
  std::string line;
  int number = 0;
  while (std::getline(in, line)) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::string plain = line;
    std::replace(plain.begin(), plain.end(), '\t', ' ');
    if (!is_plain_utf8(plain))
      throw BadInput(path, number, "is no text", "unpack it first if it is packed (.bz2, .gz), save UTF-16 as UTF-8");
    const auto begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos) continue;
    const bool comment = line[begin] == '#';
    if (comment && !text.rows.empty()) continue;
    const bool comma = separator != Separator::comma;
    if (text.rows.empty() && (comment || is_names(fields_of(line, separator_of(line)), numbers, comma, number))) {
      const std::string names = names_line(line);
      separator = separator_of(names);
      text.names = fields_of(names, separator);
      continue;
    }
    if (text.names.empty())
      throw BadInput(path, number, "begins with numbers", "put a line with the names of the columns before them");
    std::vector<double> row;
    for (const std::string& field : fields_of(line, separator)) {
      // between marks nothing may stand where a program had no value, as nan may
      const auto value = field.empty() ? std::numeric_limits<double>::quiet_NaN() : numbers.read(field, comma, number);
      if (!value)
        throw BadInput(path, number, text.names.size() > row.size() ? text.names[row.size()] : "",
                       fmt::format("'{}' is not a finite number", field),
                       field.find(':') == std::string::npos
                           ? "write decimal numbers, their columns divided as the names are"
                           : "clock times are read by vielto import logger");
      row.push_back(*value);
    }
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/record_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto {
namespace {

std::string trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return std::string(text);
}

}  // namespace

void Keys::add(std::string_view line, int number) {
  line.remove_prefix(1);
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return;  // a remark
  const std::string key = trimmed(line.substr(0, equals));
  if (!values_.emplace(key, std::pair(trimmed(line.substr(equals + 1)), number)).second)
    throw BadInput(path_, number, fmt::format("key '{}' is stated twice", key), "keep one of the two lines");
}

double Keys::number(const std::string& key, double least, bool above) const {
  const auto& [value, line] = find(key);
  const auto parsed = finite_number(value);
  if (!parsed || *parsed < least || (above && *parsed == least))
    throw BadInput(path_, line, fmt::format("key '{}' has the value '{}'", key, value),
                   fmt::format("state a number {} {}", above ? "above" : "of at least", least));
  return *parsed;
}

void Keys::demand_schema(int schema) const {
  if (integer("schema", 0) != schema)
    throw BadInput(path_, line("schema"), fmt::format("the schema is not {}", schema),
                   "write the record with this package's own version");
}

int Keys::integer(const std::string& key, int least) const {
  const double value = number(key, least);
  if (value != std::floor(value) || value > 1e9)
    throw BadInput(path_, line(key), fmt::format("key '{}' has the value {}", key, value), "state a whole number");
  return static_cast<int>(value);
}

std::vector<double> Keys::numbers(const std::string& key) const {
  const auto& [value, line] = find(key);
  std::vector<double> list;
  for (std::string_view rest = value; !rest.empty();) {
    const auto space = std::min(rest.find(' '), rest.size());
    if (space > 0) {
      const auto parsed = finite_number(rest.substr(0, space));
      if (!parsed)
        throw BadInput(path_, line, fmt::format("key '{}' holds '{}'", key, rest.substr(0, space)),
                       "state numbers with spaces between them");
      list.push_back(*parsed);
    }
    rest.remove_prefix(std::min(space + 1, rest.size()));
  }
  return list;
}

const std::pair<std::string, int>& Keys::find(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end())
    throw BadInput(path_, 0, fmt::format("lacks the key '{}'", key), fmt::format("add a line '# {}=VALUE'", key));
  return found->second;
}

Columns::Columns(const std::string& path, int line, const std::string& text) : path_(path), line_(line) {
  std::vector<std::string_view> fields;
  split_fields(text, fields);
  names_.assign(fields.begin(), fields.end());
  for (std::size_t i = 0; i < names_.size(); ++i)
    if (!index_.emplace(names_[i], i).second)
      throw BadInput(path, line, names_[i], "is there twice", "keep one of the two columns");
}

std::size_t Columns::at(const std::string& name) const {
  const auto found = index_.find(name);
  if (found == index_.end()) throw BadInput(path_, line_, name, "is missing from the header", "record this column too");
  return found->second;
}

RecordFile::RecordFile(const std::string& path, const std::string& kind)
    : path_(path), in_(path, std::ios::binary), keys_(path) {
  if (!in_) throw BadInput(path, 0, "cannot be read", "name " + kind);
  while (std::getline(in_, text_) && text_.rfind("#", 0) == 0) keys_.add(text_, ++line_);
  if (!in_) throw BadInput(path, 0, line_ == 0 ? "is empty" : "has no header line", "run the case again");
  columns_ = Columns(path, ++line_, text_);
}

bool RecordFile::next_row(std::vector<double>& row) {
  if (!std::getline(in_, text_)) return false;
  ++line_;
  split_fields(text_, fields_);
  if (in_.eof() || fields_.size() != columns_.count())
    throw BadInput(path_, line_,
                   in_.eof() ? "is cut off: the last line does not end"
                             : fmt::format("has {} values for {} columns", fields_.size(), columns_.count()),
                   "remove the broken line, or run the case again");
  row.resize(fields_.size());
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const auto value = finite_number(fields_[i]);
    if (!value)
      throw BadInput(path_, line_, columns_.name(i), fmt::format("'{}' is not a finite number", fields_[i]),
                     "run the case again; a record with such a value has no mean");
    row[i] = *value;
  }
  return true;
}

std::string record_rig(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path, 0, "cannot be read", "name a run folder or its record");
  if (in.peek() == std::ifstream::traits_type::eof()) throw BadInput(path, 0, "is empty", "run the case again");
  Keys keys(path);
  std::string text;
  for (int line = 1; std::getline(in, text) && text.rfind("#", 0) == 0; ++line) keys.add(text, line);
  return keys.text("rig");
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/csv.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "core/bad_input.h"

namespace vielto {

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  fields.clear();
  for (std::size_t comma; (comma = line.find(',')) != std::string_view::npos; line.remove_prefix(comma + 1))
    fields.push_back(line.substr(0, comma));
  fields.push_back(line);
}

std::string open_table(std::ifstream& in, const std::string& path) {
  if (std::filesystem::is_directory(path)) throw BadInput(path, 0, "is a folder", "name a file in it");
  in.open(path, std::ios::binary);
  if (!in) throw BadInput(path, 0, "cannot be read", "name an existing file");
  std::string line;
  if (!std::getline(in, line)) throw BadInput(path, 0, "is empty", "write a header line and rows below it");
  if (line.compare(0, 3, "\xEF\xBB\xBF") == 0)
    throw BadInput(path, 1, "begins with a byte-order mark", "save it as UTF-8 without one");
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

namespace {

std::vector<std::string> split_names(std::string_view line, char separator) {
  std::vector<std::string> names(1);
  for (const char c : line)
    if (c == separator)
      names.emplace_back();
    else
      names.back() += c;
  return names;
}

// Without what spreadsheets and people add around a name: quotes, blanks, capitals.
std::vector<std::string> bare(std::vector<std::string> names, std::string_view added, bool lower = false) {
  for (std::string& name : names) {
    while (!name.empty() && added.find(name.back()) != std::string_view::npos) name.pop_back();
    while (!name.empty() && added.find(name.front()) != std::string_view::npos) name.erase(0, 1);
    if (lower) std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  }
  return names;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

struct Difference {
  std::string what, mend;
};

Difference difference(std::string_view line, std::string_view header) {
  if (line.substr(0, 2) == "\xFF\xFE" || line.substr(0, 2) == "\xFE\xFF") return {"is UTF-16 text", "save it as UTF-8"};
  if (line.substr(0, 4) == "sep=") return {"names a separator for a spreadsheet", "leave this line out"};
  const std::vector<std::string> wanted = split_names(header, ',');
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}, {'|', "bars"}})
    if (bare(split_names(line, separator), " \"\t", true) == wanted)
      return {fmt::format("is separated by {}", name),
              "save it separated by commas, with a decimal point in its numbers (not a decimal comma)"};
  const std::vector<std::string> there = split_names(line, ',');
  if (line.size() > header.size() && line.substr(0, header.size()) == header &&
      line.find_first_not_of(',', header.size()) == std::string_view::npos)
    return {"has columns without a name", "save the table without what stands empty beside it"};
  if (bare(there, "\"") == wanted) return {"has quotes around its names", "save it without quotes"};
  if (bare(there, " \t\"") == wanted)
    return {"has blanks around its names", "write commas with nothing before or behind them"};
  if (bare(there, " \t\"", true) == wanted) return {"has capital letters in its names", "write them in small letters"};
  std::string lacking, unknown;
  for (const std::string& name : wanted)
    if (!has(there, name)) lacking += (lacking.empty() ? "" : ", ") + name;
  for (const std::string& name : there)
    if (!has(wanted, name)) unknown += fmt::format("{}'{}'", unknown.empty() ? "" : ", ", name);
  const std::string mend = fmt::format("write exactly '{}'", header);
  if (!lacking.empty() && lacking.size() < header.size() / 2)
    return {fmt::format("lacks {}{}", lacking, unknown.empty() ? "" : " and has " + unknown), mend};
  if (lacking.empty() && !unknown.empty())
    return {fmt::format("has {} beside the columns of this table", unknown), mend};
  if (lacking.empty() && there.size() == wanted.size()) return {"has its columns in another order", mend};
  return {"has another header", mend};
}

}  // namespace

void expect_header(const std::string& path, std::string_view line, std::string_view header) {
  if (line == header) return;
  const Difference found = difference(line, header);
  throw BadInput(path, 1, found.what, found.mend);
}

std::optional<double> finite_number(std::string_view field) {
  double value = 0;
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool is_plain_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x20 || lead == 0x7f) return false;
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if ((lead >= 0x80 && lead < 0xc2) || lead > 0xf4 || i + length > text.size()) return false;
    // a longer form than needed, half of a pair of UTF-16, beyond the last character
    const unsigned char second = length > 2 ? static_cast<unsigned char>(text[i + 1]) : 0;
    if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) || (lead == 0xf0 && second < 0x90) ||
        (lead == 0xf4 && second > 0x8f))
      return false;
    for (std::size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    i += length;
  }
  return true;
}

std::string number_text(double value) { return fmt::format("{}", value); }

void write_whole_file(const std::string& path, const std::string& text) {
  // of this process alone: two may write the same file at the same time
  const std::string partial = fmt::format("{}.{}.partial", path, ::getpid());
  std::ofstream out(partial, std::ios::binary);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(partial, path, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw std::runtime_error(fmt::format("{}: cannot be written; check the folder and the space left", path));
  }
}

}  // namespace vielto

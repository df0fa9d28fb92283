// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/csv.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

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
    for (std::size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    i += length;
  }
  return true;
}

std::string number_text(double value) { return fmt::format("{}", value); }

void write_whole_file(const std::string& path, const std::string& text) {
  const std::string partial = path + ".partial";
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

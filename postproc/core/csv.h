// SPDX-License-Identifier: GPL-2.0-or-later
// What the CSV files of this project share: comma separated, no quotes, decimal point, UTF-8.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vielto {

// Splits one line at its commas; an empty line is one empty field. A trailing '\r' is not part of the last field.
// The views point into `line`.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);

// Opens a text table and reads its header line, without the line's end.
// Errors: BadInput for what is no readable file, a folder, an empty file, or one that begins with a byte-order mark.
std::string open_table(std::ifstream& in, const std::string& path);

// Refuses a header line that is not `header`: BadInput that says what differs (separator, quotes, blanks, case, a
// column that lacks, is unknown or out of order) instead of both lines.
void expect_header(const std::string& path, std::string_view line, std::string_view header);

// A finite decimal number that fills the whole field (1, -2.5, 3e-4), whatever the locale; otherwise nothing.
std::optional<double> finite_number(std::string_view field);

// True if `text` is well-formed UTF-8 without control characters.
bool is_plain_utf8(std::string_view text);

// The shortest text that reads back as the same double.
std::string number_text(double value);

// Writes PATH.partial and renames it, so that a reader never sees half a file.
// Errors: std::runtime_error if the file cannot be written; the partial file is removed.
void write_whole_file(const std::string& path, const std::string& text);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Any CSV file of a result folder: lines `# key=value`, a header, rows. Read as a stream; of long files the first rows
// are kept as text, and all rows as means over blocks of rows.
//
// Errors: BadInput for a file that cannot be read, is not plain UTF-8, or has a row of another length than its header.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vielto {

constexpr std::size_t kShownRows = 60, kMostPoints = 1024;

struct DataFile {
  std::vector<std::pair<std::string, std::string>> keys;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> first_rows;  // at most kShownRows
  std::size_t rows = 0;

  // For each column of which every row holds a finite number: means over blocks of rows, at most kMostPoints; empty for
  // the others.
  std::vector<std::vector<double>> values;
  std::size_t rows_per_block = 1;

  // The column's position, or -1.
  int find(const std::string& column) const;
};

DataFile read_data_file(const std::string& path);

}  // namespace vielto

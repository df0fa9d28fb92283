// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/data_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto {
namespace {

// Means over blocks of rows; when there are too many blocks, two become one.
class Blocks {
 public:
  void start(std::size_t columns) {
    sums_.assign(columns, 0);
    means_.resize(columns);
    numeric_.assign(columns, true);
  }
  void add(const std::vector<std::string_view>& fields) {
    for (std::size_t c = 0; c < fields.size(); ++c) {
      if (!numeric_[c]) continue;
      const auto value = finite_number(fields[c]);
      numeric_[c] = value.has_value();
      sums_[c] += value.value_or(0);
    }
    if (++rows_ < size_) return;
    close();
    if (++blocks_ < kMostPoints) return;
    for (auto& column : means_) {
      if (column.size() < blocks_) continue;
      for (std::size_t i = 0; i < blocks_ / 2; ++i) column[i] = 0.5 * (column[2 * i] + column[2 * i + 1]);
      column.resize(blocks_ / 2);
    }
    blocks_ /= 2;
    size_ *= 2;
  }
  void finish(DataFile& file) {
    if (rows_ > 0) close();
    for (std::size_t c = 0; c < means_.size(); ++c)
      if (!numeric_[c]) means_[c].clear();
    file.values = std::move(means_);
    file.rows_per_block = size_;
  }

 private:
  void close() {
    for (std::size_t c = 0; c < sums_.size(); ++c) {
      if (numeric_[c]) means_[c].push_back(sums_[c] / static_cast<double>(rows_));
      sums_[c] = 0;
    }
    rows_ = 0;
  }
  std::vector<double> sums_;
  std::vector<std::vector<double>> means_;
  std::vector<bool> numeric_;
  std::size_t rows_ = 0, size_ = 1, blocks_ = 0;
};

}  // namespace

int DataFile::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

DataFile read_data_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path, 0, "cannot be read", "check its permissions");
  DataFile file;
  Blocks blocks;
  std::string line;
  std::vector<std::string_view> fields;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!is_plain_utf8(line))
      throw BadInput(path, number, "holds bytes that are no plain UTF-8", "write it as plain text");
    if (file.columns.empty() && line.rfind('#', 0) == 0) {
      const auto equals = line.find('=');
      const auto from = std::min(line.find_first_not_of("# "), line.size());
      if (equals != std::string::npos && equals > from)
        file.keys.emplace_back(line.substr(from, equals - from), line.substr(equals + 1));
      continue;
    }
    split_fields(line, fields);
    if (file.columns.empty()) {
      file.columns.assign(fields.begin(), fields.end());
      blocks.start(fields.size());
      continue;
    }
    if (fields.size() != file.columns.size())
      throw BadInput(path, number, fmt::format("has {} fields for {} columns", fields.size(), file.columns.size()),
                     "remove the broken line, or make the file again");
    if (file.rows++ < kShownRows) file.first_rows.emplace_back(fields.begin(), fields.end());
    blocks.add(fields);
  }
  if (file.columns.empty()) throw BadInput(path, 0, "is empty", "make the file again");
  blocks.finish(file);
  return file;
}

}  // namespace vielto

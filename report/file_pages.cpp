// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/file_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>

#include "core/bad_input.h"
#include "core/json_file.h"
#include "core/reduced_table.h"
#include "core/statistics.h"
#include "report/data_file.h"
#include "report/equation_pages.h"
#include "report/json_table.h"

namespace vielto {
namespace {

using nlohmann::json;

constexpr std::size_t kMostPlots = 8, kMostSeries = 8, kMostPowerRows = 2000;

std::string file_name(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return text;
}

// "shaft_Nm" -> "Nm"; "" without one.
std::string unit_of(const std::string& column) {
  const auto underscore = column.rfind('_');
  return underscore == std::string::npos ? "" : column.substr(underscore + 1);
}

Table text_table(const DataFile& file, std::size_t rows) {
  Table table;
  table.caption =
      file.rows > rows ? fmt::format("The first {} of {} rows", rows, file.rows) : fmt::format("{} rows", file.rows);
  std::vector<std::size_t> kept;  // a column that is empty throughout says nothing
  for (std::size_t c = 0; c < file.columns.size(); ++c)
    if (std::any_of(file.first_rows.begin(), file.first_rows.end(), [c](const auto& row) { return !row[c].empty(); }))
      kept.push_back(c);
  for (const std::size_t c : kept) table.columns.push_back(file.columns[c]);
  for (std::size_t r = 0; r < std::min(rows, file.first_rows.size()); ++r) {
    table.rows.emplace_back();
    for (const std::size_t c : kept) table.rows.back().push_back(file.first_rows[r][c]);
  }
  return table;
}

// Columns of numbers over the first one, a plot for each unit.
std::vector<Plot> column_plots(const DataFile& file, const std::string& name) {
  std::vector<std::size_t> numeric;
  for (std::size_t c = 0; c < file.columns.size(); ++c)
    if (!file.values[c].empty()) numeric.push_back(c);
  if (numeric.size() < 2 || file.values[numeric[0]].size() < 3) return {};
  std::size_t x = numeric[0];
  if (const int time = file.find("time_s"); time >= 0 && !file.values[static_cast<std::size_t>(time)].empty())
    x = static_cast<std::size_t>(time);
  const bool ordered = std::is_sorted(file.values[x].begin(), file.values[x].end());
  std::map<std::string, Plot> by_unit;
  for (const std::size_t c : numeric) {
    if (c == x || file.columns[c] == "step") continue;
    const std::string unit = unit_of(file.columns[c]);
    Plot& plot = by_unit[unit];
    if (plot.series.size() == kMostSeries) continue;
    Series series{file.columns[c],
                  ordered ? Series::Look::line : Series::Look::points,
                  static_cast<int>(plot.series.size()),
                  {},
                  {},
                  {}};
    for (std::size_t i = 0; i < file.values[c].size(); ++i) series.xy.push_back({file.values[x][i], file.values[c][i]});
    plot.series.push_back(series);
  }
  std::vector<Plot> plots;
  for (auto& [unit, plot] : by_unit) {
    if (plots.size() == kMostPlots) break;
    plot.file = file_name(name + "_" + (unit.empty() ? "numbers" : unit));
    plot.title = fmt::format("{}{}", name, unit.empty() ? "" : ", columns in " + unit);
    plot.caption =
        file.rows_per_block > 1 ? fmt::format("Means over blocks of {} rows.", file.rows_per_block) : "Every row.";
    plot.x_name = file.columns[x];
    plot.y_name = unit.empty() ? "value" : unit;
    plot.zoom = true;
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::vector<Plot> power_plots(const std::string& path, const std::string& name) {
  std::map<double, Series> by_fill;
  for (const Observation& row : read_reduced_table(path).rows) {
    if (row.apparatus != "mixer" || row.observable != "power" || !row.speed || !row.fill) continue;
    Series& series = by_fill[*row.fill];
    series.xy.push_back({*row.speed, row.value});
    series.u.push_back(kNormal975 * row.u);
  }
  if (by_fill.empty()) return {};
  Plot plot;
  plot.file = file_name(name + "_power_over_speed");
  plot.title = "Mixing power over speed: " + name;
  plot.caption = "Rows of the table with 95 % intervals. `vielto fit` puts an equation through them.";
  plot.x_name = "speed / (1/s)";
  plot.y_name = "mixing power / W";
  for (auto& [fill, series] : by_fill) {
    series.name = fmt::format("l = {:g}", fill);
    series.look = Series::Look::points;
    series.colour = static_cast<int>(plot.series.size());
    plot.series.push_back(series);
  }
  return {plot};
}

}  // namespace

void add_csv(const std::string& path, const std::string& name, bool plot_powers, Page& page) {
  const DataFile file = read_data_file(path);
  Section section{name, {}};
  if (!file.keys.empty()) {
    Table keys{"Keys", {"key", "value"}, {}};
    for (const auto& [key, value] : file.keys) keys.rows.push_back({key, value});
    section.blocks.push_back(keys);
  }
  const bool observations = file.columns.size() > 3 && file.columns[0] == "test" && file.columns[3] == "observable";
  if (observations) {
    if (plot_powers && file.rows <= kMostPowerRows)
      for (Plot& plot : power_plots(path, name)) section.blocks.push_back(std::move(plot));
  } else {
    for (Plot& plot : column_plots(file, name)) section.blocks.push_back(std::move(plot));
  }
  constexpr std::size_t kFewRows = 10;
  section.blocks.push_back(text_table(file, file.rows > kShownRows ? kFewRows : kShownRows));
  page.sections.push_back(std::move(section));
}

void add_json(const std::string& path, const std::string& name, Page& page) {
  page.sections.push_back({name, {json_table(read_json_file(path, "make the file again"))}});
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// One plot of a report: what is drawn, apart from the library that draws it (ECharts, in web/).
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vielto {

struct Series {
  enum class Look { points, line, dashed };
  std::string name;
  Look look = Look::line;
  int colour = 0;                         // of the palette; series that belong together share one
  std::vector<std::array<double, 2>> xy;  // finite
  std::vector<double> u;                  // half lengths of error bars in y; empty: none
  std::string family;                     // series of one family share an entry in the legend; empty: its own, by name
  std::vector<std::array<double, 2>> range = {};  // low and high at each point: bars of points, a band about a line
};

struct Band {
  double low = 0, high = 0;
  std::string label;
};

// One condition of a map: a coloured field with its words in it.
struct Cell {
  double x = 0, y = 0, value = 0;
  std::string words;
};

struct Plot {
  std::string file;  // name of its .svg and .csv
  std::string title, caption;
  std::string x_name, y_name;  // quantity and unit
  bool from_zero = false;      // both axes begin at 0
  bool zoom = false;           // a slider below, for long records
  bool half = false;           // two beside each other where the window is wide
  std::vector<Series> series;
  std::optional<Band> x_band, y_band;  // shaded
  // Names of rows, one below the other: y = 0, 1, 2 ... of the series is a row, x the value; ranges lie in x.
  std::vector<std::string> rows;
  // A map instead of series: the values of x and y become columns and rows; colours from -full to full.
  std::vector<Cell> cells;
  double full = 1;
};

// The plot as ECharts wants it: data only, no functions.
nlohmann::json plot_option(const Plot& plot);

// One row a point: series,x,y,u; with ranges series,x,y,u,low,high; of a map x,y,value.
std::string plot_csv(const Plot& plot);

}  // namespace vielto

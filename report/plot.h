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
};

struct Band {
  double low = 0, high = 0;
  std::string label;
};

struct Plot {
  std::string file;  // name of its .svg and .csv
  std::string title, caption;
  std::string x_name, y_name;  // quantity and unit
  bool from_zero = false;      // both axes begin at 0
  bool zoom = false;           // a slider below, for long records
  std::vector<Series> series;
  std::optional<Band> x_band, y_band;  // shaded
};

// The plot as ECharts wants it: data only, no functions.
nlohmann::json plot_option(const Plot& plot);

// One row a point: series,x,y,u.
std::string plot_csv(const Plot& plot);

}  // namespace vielto

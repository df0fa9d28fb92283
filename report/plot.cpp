// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/csv.h"

namespace vielto {
namespace {

using nlohmann::json;

// After P. Tol's "bright" scheme: told apart with any colour vision, on white and on black.
constexpr std::array<const char*, 7> kPalette = {"#4c8bc8", "#ee6677", "#2f9e44", "#c5a623",
                                                 "#56b4d8", "#b8559b", "#888888"};

json axis(bool from_zero) { return {{"type", "value"}, {"scale", !from_zero}}; }

json series_option(const Series& s) {
  const std::string colour = kPalette[static_cast<std::size_t>(s.colour) % kPalette.size()];
  json option = {{"name", s.family.empty() ? s.name : s.family},
                 {"data", s.xy},
                 {"itemStyle", {{"color", colour}, {"opacity", 1}}},
                 {"animation", false}};
  if (s.look == Series::Look::points) {
    option["type"] = "scatter";
    option["symbolSize"] = 9;
    option["z"] = 4;
    return option;
  }
  option["type"] = "line";
  option["showSymbol"] = false;
  option["lineStyle"] = {{"color", colour}, {"width", s.look == Series::Look::dashed ? 1.2 : 2}};
  if (s.look == Series::Look::dashed) option["lineStyle"]["type"] = "dashed";
  return option;
}

// Strokes with gaps between them, upright or (`level`) in x; in the legend they go with their points.
json error_bars(const Series& s, bool level) {
  json strokes = json::array();
  for (std::size_t i = 0; i < s.xy.size(); ++i) {
    const auto [x, y] = s.xy[i];
    const std::array<double, 2> ends = s.u.empty() ? s.range[i] : std::array<double, 2>{y - s.u[i], y + s.u[i]};
    for (const double end : ends) strokes.push_back(level ? json{end, y} : json{x, end});
    strokes.push_back(level ? json{"-", y} : json{x, "-"});
  }
  Series bars = s;
  bars.look = Series::Look::line;
  json option = series_option(bars);
  option["data"] = strokes;
  option["lineStyle"]["width"] = 1.5;
  option["silent"] = true;
  option["tooltip"] = {{"show", false}};
  return option;
}

// The area between low and high, by its corners; shared.js draws it.
json band_about_line(const Series& s) {
  json option = series_option(s);
  option["type"] = "custom";
  option["data"] = json::array();
  for (std::size_t i = 0; i < s.xy.size(); ++i) option["data"].push_back({s.xy[i][0], s.range[i][0]});
  for (std::size_t i = s.xy.size(); i-- > 0;) option["data"].push_back({s.xy[i][0], s.range[i][1]});
  option["itemStyle"]["opacity"] = 0.22;
  option["silent"] = true;
  option["tooltip"] = {{"show", false}};
  return option;
}

// Columns and rows of a map: its values in order.
std::vector<double> places(const std::vector<Cell>& cells, double Cell::*member) {
  std::set<double> values;
  for (const Cell& cell : cells) values.insert(cell.*member);
  return {values.begin(), values.end()};
}

json map_option(const Plot& plot) {
  const auto columns = places(plot.cells, &Cell::x), rows = places(plot.cells, &Cell::y);
  const auto words = [](const std::vector<double>& values) {
    json list = json::array();
    for (const double value : values) list.push_back(fmt::format("{:g}", value));
    return list;
  };
  const auto at = [](const std::vector<double>& values, double value) {
    return std::lower_bound(values.begin(), values.end(), value) - values.begin();
  };
  json data = json::array();
  for (const Cell& cell : plot.cells)
    data.push_back({{"value", {at(columns, cell.x), at(rows, cell.y), cell.value}},
                    {"label", {{"show", true}, {"formatter", cell.words}, {"color", "#111111"}}}});
  return {{"xAxis", {{"type", "category"}, {"data", words(columns)}}},
          {"yAxis", {{"type", "category"}, {"data", words(rows)}}},
          {"visualMap",
           {{"type", "continuous"},
            {"min", -plot.full},
            {"max", plot.full},
            {"show", false},
            {"inRange", {{"color", {kPalette[0], "#f3f3f3", kPalette[1]}}}}}},
          {"legend", {{"show", false}, {"top", 0}}},
          {"series",
           {{{"type", "heatmap"},
             {"data", data},
             {"animation", false},
             {"itemStyle", {{"borderColor", "#888888"}, {"borderWidth", 1}}}}}}};
}

// A shaded rectangle belongs to a series; this one is invisible and makes sure that a band in y is on the plot.
json band_series(const Band& band, const char* axis, const json& ends) {
  json label = {{"show", !band.label.empty()}, {"position", "insideTop"}, {"color", "#888888"}, {"fontSize", 11}};
  json from = {{axis, band.low}, {"name", band.label}}, to = {{axis, band.high}};
  return {{"type", "line"},
          {"data", ends},
          {"silent", true},
          {"showSymbol", false},
          {"lineStyle", {{"opacity", 0}}},
          {"tooltip", {{"show", false}}},
          {"markArea",
           {{"silent", true},
            {"itemStyle", {{"color", "rgba(110,160,110,0.18)"}}},
            {"label", label},
            {"data", json::array({json::array({from, to})})}}}};
}

std::string field(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

json plot_option(const Plot& plot) {
  const bool points = std::any_of(plot.series.begin(), plot.series.end(),
                                  [](const Series& s) { return s.look == Series::Look::points; });
  json option = {
      {"aria", {{"enabled", true}}},
      {"tooltip", {{"trigger", points ? "item" : "axis"}, {"confine", true}}},
      {"legend", {{"type", "scroll"}, {"itemGap", 16}, {"top", 0}, {"left", 0}, {"right", 0}}},
      {"grid", {{"left", 12}, {"right", 20}, {"top", 66}, {"bottom", plot.zoom ? 78 : 44}, {"containLabel", true}}},
      // The name of the y axis stands level above it: readable on a phone, never in the way of the numbers.
      {"title", json::array({{{"text", plot.y_name},
                              {"left", 0},
                              {"top", 36},
                              {"textStyle", {{"fontSize", 12}, {"fontWeight", "normal"}}}}})},
      {"xAxis", axis(plot.from_zero)},
      {"yAxis", axis(plot.from_zero)},
      {"series", json::array()}};
  if (!plot.cells.empty()) option.update(map_option(plot));
  if (!plot.rows.empty())
    option["yAxis"] = {{"type", "value"},    {"min", -1},       {"max", plot.rows.size()},
                       {"interval", 1},      {"inverse", true}, {"splitLine", {{"show", false}}},
                       {"labels", plot.rows}};  // page.js and svg.js write them at 0, 1, 2 ...
  if (!plot.rows.empty()) option["xAxis"]["axisLine"] = {{"onZero", false}};
  option["xAxis"]["name"] = plot.x_name;
  option["xAxis"]["nameLocation"] = "middle";
  option["xAxis"]["nameGap"] = 30;
  if (plot.zoom)
    option["dataZoom"] = json::array({{{"type", "inside"}, {"filterMode", "none"}},
                                      {{"type", "slider"}, {"filterMode", "none"}, {"bottom", 8}, {"height", 18}}});
  for (const Series& s : plot.series) {
    option["series"].push_back(series_option(s));
    if (!s.u.empty() || (!s.range.empty() && s.look == Series::Look::points))
      option["series"].push_back(error_bars(s, !plot.rows.empty()));
    else if (!s.range.empty())
      option["series"].push_back(band_about_line(s));
  }
  if (plot.x_band) option["series"].push_back(band_series(*plot.x_band, "xAxis", json::array()));
  if (plot.y_band && !plot.series.empty() && !plot.series.front().xy.empty()) {
    const double x = plot.series.front().xy.front()[0];
    option["series"].push_back(band_series(*plot.y_band, "yAxis", {{x, plot.y_band->low}, {x, plot.y_band->high}}));
  }
  return option;
}

std::string plot_csv(const Plot& plot) {
  const std::string axes = field(plot.x_name) + "," + field(plot.y_name);
  if (!plot.cells.empty()) {
    std::string text = axes + ",value\n";
    for (const Cell& cell : plot.cells)
      text += fmt::format("{},{},{}\n", number_text(cell.x), number_text(cell.y), number_text(cell.value));
    return text;
  }
  const bool ranges =
      std::any_of(plot.series.begin(), plot.series.end(), [](const Series& s) { return !s.range.empty(); });
  std::string text = fmt::format("series,{},u{}\n", axes, ranges ? ",low,high" : "");
  for (const Series& s : plot.series)
    for (std::size_t i = 0; i < s.xy.size(); ++i) {
      const auto [x, y] = s.xy[i];
      const auto row = static_cast<std::size_t>(std::lround(y));
      text += fmt::format("{},{},{},{}", field(s.name), number_text(x),
                          plot.rows.empty() ? number_text(y) : field(plot.rows.at(row)),
                          s.u.empty() ? "" : number_text(s.u[i]));
      if (ranges && !s.range.empty())
        text += fmt::format(",{},{}", number_text(s.range[i][0]), number_text(s.range[i][1]));
      else if (ranges)
        text += ",,";
      text += "\n";
    }
  return text;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

// Vertical strokes with gaps between them; in the legend they go with their points.
json error_bars(const Series& s) {
  json strokes = json::array();
  for (std::size_t i = 0; i < s.xy.size(); ++i) {
    const auto [x, y] = s.xy[i];
    strokes.push_back({x, y - s.u[i]});
    strokes.push_back({x, y + s.u[i]});
    strokes.push_back({x, "-"});
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
  option["xAxis"]["name"] = plot.x_name;
  option["xAxis"]["nameLocation"] = "middle";
  option["xAxis"]["nameGap"] = 30;
  if (plot.zoom)
    option["dataZoom"] = json::array({{{"type", "inside"}, {"filterMode", "none"}},
                                      {{"type", "slider"}, {"filterMode", "none"}, {"bottom", 8}, {"height", 18}}});
  for (const Series& s : plot.series) {
    option["series"].push_back(series_option(s));
    if (!s.u.empty()) option["series"].push_back(error_bars(s));
  }
  if (plot.x_band) option["series"].push_back(band_series(*plot.x_band, "xAxis", json::array()));
  if (plot.y_band && !plot.series.empty() && !plot.series.front().xy.empty()) {
    const double x = plot.series.front().xy.front()[0];
    option["series"].push_back(band_series(*plot.y_band, "yAxis", {{x, plot.y_band->low}, {x, plot.y_band->high}}));
  }
  return option;
}

std::string plot_csv(const Plot& plot) {
  std::string text = fmt::format("series,{},{},u\n", field(plot.x_name), field(plot.y_name));
  for (const Series& s : plot.series)
    for (std::size_t i = 0; i < s.xy.size(); ++i)
      text += fmt::format("{},{},{},{}\n", field(s.name), number_text(s.xy[i][0]), number_text(s.xy[i][1]),
                          s.u.empty() ? "" : number_text(s.u[i]));
  return text;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/diagnosis_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/condition.h"

namespace vielto::gap {
namespace {

using nlohmann::json;

constexpr std::size_t kFewestForALine = 3;
constexpr int kMeasuredColour = 6, kBeforeColour = 1, kAfterColour = 2, kRunBeforeColour = 5, kRunAfterColour = 3;

struct Shown {
  const char* key;
  std::string name;
  int colour;
  double shift;  // beside the others in its row
};
// The runs of the proof are points beside the lines of the emulator.
std::array<Shown, 5> shown_with(const std::string& with_effect) {
  return {{{"measured", "measured", kMeasuredColour, -0.3},
           {"before", "simulated", kBeforeColour, -0.1},
           {"before_again", "run again", kRunBeforeColour, 0},
           {"after", with_effect, kAfterColour, 0.1},
           {"after_again", "run again " + with_effect, kRunAfterColour, 0.2}}};
}

bool is_a_line(const Shown& shown) { return shown.key == std::string("before") || shown.key == std::string("after"); }

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return in_words(name) +
         (unit.empty() || unit == "1" ? "" : " / " + (unit.find('/') == std::string::npos ? unit : "(" + unit + ")"));
}

// The points of each observable, in the order of the table.
std::vector<std::vector<json>> by_observable(const json& points) {
  std::vector<std::string> names;
  std::vector<std::vector<json>> groups;
  for (const json& p : points) {
    const std::string name = p.at("apparatus").get<std::string>() + " " + p.at("observable").get<std::string>();
    const auto group = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (group == names.size()) {
      names.push_back(name);
      groups.emplace_back();
    }
    groups[group].push_back(p);
  }
  return groups;
}

std::set<double> values_of(const std::vector<json>& points, const std::string& condition) {
  std::set<double> values;
  for (const json& p : points)
    if (p.contains(condition)) values.insert(p[condition].get<double>());
  return values;
}

// The conditions that differ among the points, the one with the most values first.
std::vector<std::string> varied(const std::vector<json>& points, std::size_t at_least) {
  std::vector<std::string> names;
  for (const NamedCondition& c : kConditions)
    if (values_of(points, c.name).size() >= at_least) names.emplace_back(c.name);
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return values_of(points, a).size() > values_of(points, b).size();
  });
  return names;
}

std::string unit_of(const std::string& condition) {
  for (const NamedCondition& c : kConditions)
    if (condition == c.name) return c.unit == std::string("1") ? "" : c.unit;
  return "";
}

// "fill 0.1, tilt 45 deg": what of a point stays the same in its plot.
std::string others(const json& point, const std::vector<std::string>& conditions, const std::string& but) {
  std::string text;
  for (const std::string& c : conditions)
    if (c != but && point.contains(c))
      text += fmt::format("{}{} {:g}{}", text.empty() ? "" : ", ", in_words(c), point[c].get<double>(),
                          unit_of(c).empty() ? "" : " " + unit_of(c));
  return text;
}

std::array<double, 2> range_of(const json& band) {
  return {band.at("low95").get<double>(), band.at("high95").get<double>()};
}

std::string title_of(const std::vector<json>& points) {
  return points.front().at("apparatus").get<std::string>() + " " +
         in_words(points.front().at("observable").get<std::string>());
}

std::string file_name(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return text;
}

Plot over_a_condition(std::vector<json> points, const std::string& condition, const std::string& at,
                      const std::string& with_effect) {
  std::stable_sort(points.begin(), points.end(), [&](const json& a, const json& b) {
    return a[condition].get<double>() < b[condition].get<double>();
  });
  Plot plot;
  plot.title = title_of(points) + (at.empty() ? "" : ", " + at);
  plot.x_name = with_unit(condition, unit_of(condition));
  plot.y_name = with_unit(points.front().at("observable"), points.front().at("unit"));
  plot.half = true;
  for (const Shown& shown : shown_with(with_effect)) {
    Series series{shown.name, is_a_line(shown) ? Series::Look::line : Series::Look::points, shown.colour, {}, {}, {},
                  {}};
    for (const json& p : points) {
      if (!p.contains(shown.key)) continue;
      series.xy.push_back({p[condition].get<double>(), p[shown.key].at("value").get<double>()});
      series.range.push_back(range_of(p[shown.key]));
    }
    if (!series.xy.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot row_by_row(const std::vector<json>& points, const std::vector<std::string>& conditions,
                const std::string& with_effect) {
  Plot plot;
  plot.title = title_of(points);
  plot.x_name = with_unit(points.front().at("observable"), points.front().at("unit"));
  for (const json& p : points) {
    const std::string at = others(p, conditions, "");
    plot.rows.push_back(p.at("test").get<std::string>() + (at.empty() ? "" : "\n" + at));
  }
  for (const Shown& shown : shown_with(with_effect)) {
    Series series{shown.name, Series::Look::points, shown.colour, {}, {}, {}, {}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].contains(shown.key)) continue;
      const json& band = points[i][shown.key];
      series.xy.push_back({band.at("value").get<double>(), static_cast<double>(i) + shown.shift});
      series.range.push_back(range_of(band));
    }
    if (!series.xy.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

double percent_gap(const json& point, const char* key) {
  return 100 * (point.at(key).at("value").get<double>() / point.at("measured").at("value").get<double>() - 1);
}

}  // namespace

std::vector<ComparisonPlots> comparison_plots(const json& points, const std::string& name,
                                              const std::string& with_effect) {
  std::vector<ComparisonPlots> all;
  const auto place = [&all](const std::string& over) -> std::vector<Plot>& {
    for (ComparisonPlots& c : all)
      if (c.over == over) return c.plots;
    all.push_back({over, {}});
    return all.back().plots;
  };
  for (const std::vector<json>& group : by_observable(points)) {
    const auto conditions = varied(group, 2), lines = varied(group, kFewestForALine);
    for (const std::string& condition : lines) {
      std::map<std::string, std::vector<json>> panels;
      for (const json& p : group)
        if (p.contains(condition)) panels[others(p, conditions, condition)].push_back(p);
      for (const auto& [at, panel] : panels) {
        Plot plot = over_a_condition(panel, condition, at, with_effect);
        plot.file = file_name(name + title_of(group) + "_over_" + condition + (at.empty() ? "" : "_" + at));
        place(condition).push_back(std::move(plot));
      }
    }
    if (!lines.empty()) continue;
    Plot plot = row_by_row(group, conditions, with_effect);
    plot.file = file_name(name + title_of(group) + "_by_test");
    place("").push_back(std::move(plot));
  }
  return all;
}

std::vector<Plot> gap_maps(const json& points, const std::string& name, const std::string& with_effect) {
  std::vector<Plot> maps;
  for (const std::vector<json>& group : by_observable(points)) {
    if (values_of(group, "speed").size() < 2 || values_of(group, "fill").size() < 2) continue;
    double full = 5;
    std::vector<Plot> pair;
    for (const Shown& shown : shown_with(with_effect)) {
      if (!is_a_line(shown)) continue;
      Plot plot;
      plot.file = file_name(name + title_of(group) + "_gap_" + shown.key);
      plot.title = fmt::format("{}: {}", title_of(group), shown.name);
      plot.x_name = "speed / (1/s)";
      plot.y_name = "fill";
      plot.half = true;
      std::map<std::pair<double, double>, std::vector<double>> fields;
      for (const json& p : group)
        if (p.contains(shown.key) && p.contains("speed") && p.contains("fill") &&
            p.at("measured").at("value").get<double>() != 0)
          fields[{p["speed"].get<double>(), p["fill"].get<double>()}].push_back(percent_gap(p, shown.key));
      for (const auto& [at, gaps] : fields) {
        double mean = 0;
        for (const double gap : gaps) mean += gap / static_cast<double>(gaps.size());
        full = std::max(full, std::fabs(mean));
        plot.cells.push_back({at.first, at.second, mean, fmt::format("{:+.0f} %", mean)});
      }
      if (!plot.cells.empty()) pair.push_back(std::move(plot));
    }
    for (Plot& plot : pair) {
      plot.full = full;  // one scale for both
      maps.push_back(std::move(plot));
    }
  }
  return maps;
}

}  // namespace vielto::gap

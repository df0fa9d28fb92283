// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/equation_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/mixing_numbers.h"
#include "core/statistics.h"

namespace vielto {
namespace {

using nlohmann::json;
using Look = Series::Look;

struct DrawnEquation {
  std::string name, source;
  Equation equation;
};

Prediction predict_at(const DrawnEquation& e, const PowerPoint& p, double fill, double speed) {
  // Lever, bulk density and bulk cohesion follow from the point's own numbers.
  MixerDimensions mixer;
  mixer.lever = p.fr_m * kGravity / (p.speed * p.speed);
  BulkMaterial material;
  material.bulk_cohesion = cohesive_power_number(p.power / p.n_pc, mixer.lever, p.speed, 1);
  material.bulk_density = p.n_c / cohesion_number(mixer.lever, p.speed, 1, *material.bulk_cohesion);
  Groups groups = p.groups;
  const Groups own = groups_of(fill, speed, mixer, material, nullptr);
  for (int g = 0; g < 3; ++g) groups[g] = own[g];
  return predict(e.equation, e.source, groups, speed, mixer, material);
}

bool same(double a, double b) { return std::fabs(a - b) <= 1e-6 * std::fabs(b); }

std::vector<double> levels(const std::vector<PowerPoint>& points, double PowerPoint::*member) {
  std::vector<double> values;
  for (const PowerPoint& p : points) values.push_back(p.*member);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return same(b, a); }), values.end());
  return values;
}

std::vector<std::string> materials_of(const std::vector<PowerPoint>& points) {
  std::set<std::string> names;
  for (const PowerPoint& p : points) names.insert(p.material);
  return {names.begin(), names.end()};
}

// Power over `along`, one colour for each level of `across`: points with their u95, lines of the equations.
Plot power_plot(const std::vector<PowerPoint>& points, const std::vector<DrawnEquation>& equations,
                double PowerPoint::*along, double PowerPoint::*across, double low, double high) {
  Plot plot;
  const bool over_speed = along == &PowerPoint::speed;
  const std::vector<double> families = levels(points, across);
  const std::vector<std::string> materials = materials_of(points);
  int colour = 0;
  for (const std::string& material : materials) {
    for (const double level : families) {
      std::vector<PowerPoint> members;
      for (const PowerPoint& p : points)
        if (p.material == material && same(p.*across, level)) members.push_back(p);
      if (members.empty()) continue;
      std::string name = over_speed ? fmt::format("l = {:g}", level) : fmt::format("n = {:g} 1/s", level);
      if (materials.size() > 1) name += ", " + material;
      // Beside others, a level is one entry in the legend.
      const std::string family = families.size() * materials.size() > 1 ? name : "";
      Series series{name, Look::points, colour, {}, {}, family};
      for (const PowerPoint& p : members) {
        series.xy.push_back({p.*along, p.power});
        series.u.push_back(p.u95);
      }
      plot.series.push_back(series);
      for (std::size_t e = 0; e < equations.size(); ++e) {
        Series line{
            fmt::format("{}, {}", name, equations[e].name), e == 0 ? Look::line : Look::dashed, colour, {}, {}, family};
        constexpr int kSteps = 40;
        for (int i = 0; i <= kSteps; ++i) {
          const double x = low + (high - low) * i / kSteps;
          const double fill = over_speed ? level : x, speed = over_speed ? x : level;
          line.xy.push_back({x, predict_at(equations[e], members.front(), fill, speed).power});
        }
        if (high > low) plot.series.push_back(line);
      }
      ++colour;
    }
  }
  plot.x_name = over_speed ? "speed / (1/s)" : "drum loading factor l";
  plot.y_name = "mixing power / W";
  return plot;
}

Plot parity_plot(const std::vector<std::pair<std::string, std::vector<std::array<double, 2>>>>& sets, double limit,
                 const std::string& x_name, const std::string& y_name) {
  Plot plot;
  plot.x_name = x_name;
  plot.y_name = y_name;
  plot.from_zero = true;
  double most = 0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (sets[i].second.empty()) continue;
    plot.series.push_back({sets[i].first, Look::points, static_cast<int>(i), sets[i].second, {}, {}});
    for (const auto& [x, y] : sets[i].second) most = std::max({most, x, y});
  }
  constexpr int kGrey = 6;
  plot.series.push_back({"equal", Look::line, kGrey, {{0, 0}, {most, most}}, {}, {}});
  for (const double side : {1 + limit, 1 - limit})
    plot.series.push_back(
        {fmt::format("± {:.1f} %", 100 * limit), Look::dashed, kGrey, {{0, 0}, {most, most * side}}, {}, {}});
  return plot;
}

// The range of a level, widened to the booklet's where the points alone have none.
std::array<double, 2> range_of(const std::vector<double>& values, double low, double high) {
  if (values.size() > 1) return {values.front(), values.back()};
  return {std::min(values.front(), low), std::max(values.front(), high)};
}

std::string words(const json& value) {
  if (value.is_number()) return fmt::format("{:.5g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string percent(const json& value) { return fmt::format("{:.1f} %", 100 * value.get<double>()); }

Table coefficient_table(const json& fit) {
  Table table{"Coefficients", {"coefficient", "value", "low 95 %", "high 95 %", "booklet"}, {}};
  for (const char* kind : {"coefficients", "combinations"})
    for (const auto& [name, c] : fit.at(kind).items()) {
      const bool fixed = c.value("fixed", false);
      table.rows.push_back({name, words(c.at("value")), fixed ? "fixed" : words(c.at("low95")),
                            fixed ? "" : words(c.at("high95")), c.contains("booklet") ? words(c["booklet"]) : ""});
    }
  for (const json& name : fit.at("undetermined"))
    table.rows.push_back({name.get<std::string>(), "not determined", "", "", ""});
  return table;
}

Table statistics_table(const json& fit) {
  const json& s = fit.at("statistics");
  Table table{"Statistics", {"statistic", "value"}, {}};
  table.rows = {{"rows", words(s.at("rows"))},
                {"R²", words(s.at("r2"))},
                {"adjusted R²", words(s.at("adjusted_r2"))},
                {fmt::format("RMSE of {}", fit.at("number").get<std::string>()), words(s.at("rmse"))},
                {"mean relative error", percent(s.at("mean_relative_error"))},
                {"largest relative error", percent(s.at("max_relative_error"))},
                {"largest relative error, leave-one-out", percent(s.at("leave_one_out").at("maximum"))},
                {"largest relative error of the booklet's equation on these rows",
                 percent(fit.at("booklet").at("against_rows").at("maximum"))},
                {"stated in the booklet for its measurements", percent(fit.at("booklet").at("max_relative_error"))},
                {"rank", fmt::format("{} of {}", fit.at("rank").get<int>(), fit.at("columns").get<int>())},
                // JSON has no infinity
                {"condition number", fit.at("condition").is_null() ? "infinite" : words(fit["condition"])}};
  if (fit.contains("check"))
    table.rows.push_back({"largest relative error of the rows held out", percent(fit["check"].at("maximum"))});
  return table;
}

std::vector<PowerPoint> fitted_points(const json& fit) {
  std::vector<PowerPoint> points;
  const bool n_pc = fit.at("number") == "N_PC";
  for (const json& r : fit.at("residuals")) {
    PowerPoint p;
    p.label = r.at("test");
    p.material = r.value("material", "");
    p.speed = r.at("speed");
    p.power = r.at("power");
    p.u95 = kNormal975 * p.power * r.at("u").get<double>() / r.at("observed").get<double>();
    for (int g = 0; g < kGroupCount; ++g)
      if (r.at("groups").contains(kGroupNames[g])) p.groups[g] = r["groups"][kGroupNames[g]].get<double>();
    p.fill = p.groups[0].value();
    p.n_c = p.groups[1].value();
    p.fr_m = p.groups[2].value();
    p.n_pc = r.at("observed").get<double>() * (n_pc ? 1 : p.n_c);
    points.push_back(p);
  }
  return points;
}

std::string file_name(const std::string& name, std::string part) {
  for (char& c : part)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name + "_" + part;
}

std::vector<Plot> residual_plots(const json& fit, const std::string& name) {
  std::vector<Plot> plots;
  std::vector<std::string> quantities = {"speed"};
  for (const auto& [group, levels] : fit.at("residuals_by_group").items())
    if (group != "speed") quantities.push_back(group);
  for (const std::string& quantity : quantities) {
    Plot plot;
    plot.file = file_name(name, "residuals_" + quantity);
    plot.title = "Deviation of the fitted equation over " + quantity;
    plot.caption = fmt::format(
        "Fitted over observed power, less 1. Shaded: ± {:.1f} %, the largest relative error stated in the booklet for "
        "the equation.",
        100 * ThesisEquation::max_relative_error);
    plot.x_name = quantity == "speed" ? "speed / (1/s)" : quantity;
    plot.y_name = "fitted/observed − 1 in %";
    const double limit = 100 * ThesisEquation::max_relative_error;
    plot.y_band = Band{-limit, limit, ""};
    Series fitted{"rows fitted", Look::points, 0, {}, {}, {}};
    Series left_out{"each row against the equation fitted without it", Look::points, 1, {}, {}, {}};
    for (const json& r : fit.at("residuals")) {
      const double x = quantity == "speed" ? r.at("speed").get<double>() : r.at("groups").at(quantity).get<double>();
      const double observed = r.at("observed");
      fitted.xy.push_back({x, 100 * (r.at("fitted").get<double>() / observed - 1)});
      if (r.at("leave_one_out").is_number())
        left_out.xy.push_back({x, 100 * (r["leave_one_out"].get<double>() / observed - 1)});
    }
    plot.series = {left_out, fitted};
    plots.push_back(plot);
  }
  return plots;
}

}  // namespace

PowerPoint power_point(const json& power, const std::string& path, const std::string& label) {
  try {
    PowerPoint p;
    p.label = label;
    p.material = power.at("material");
    p.speed = power.at("speed");
    p.fill = power.at("fill");
    p.power = power.at("power_W");
    p.u95 = power.at("power_u95_W");
    p.n_pc = power.at("N_PC");
    p.n_c = power.at("N_C");
    p.fr_m = power.at("Fr_M");
    return p;
  } catch (const json::exception& error) {
    throw BadInput(path, 0, fmt::format("is no power.json ({})", error.what()), "run `vielto post` on the run again");
  }
}

std::vector<Plot> booklet_plots(const std::vector<PowerPoint>& points) {
  using Booklet = ThesisEquation;
  const std::vector<DrawnEquation> equations = {{"published equation", "the booklet's equation", thesis_equation()}};
  const auto speeds = range_of(levels(points, &PowerPoint::speed), Booklet::low_speed, Booklet::high_speed);
  const auto fills = range_of(levels(points, &PowerPoint::fill), Booklet::low_fill, Booklet::high_fill);
  const std::string caption = fmt::format(
      "Points: simulated runs with 95 % intervals. Lines: the published equation, which is up to {:.1f} % off the "
      "measurements it was fitted to.",
      100 * Booklet::max_relative_error);
  Plot over_speed = power_plot(points, equations, &PowerPoint::speed, &PowerPoint::fill, speeds[0], speeds[1]);
  over_speed.file = "power_over_speed";
  over_speed.title = "Mixing power over speed";
  over_speed.caption = caption;
  Plot over_fill = power_plot(points, equations, &PowerPoint::fill, &PowerPoint::speed, fills[0], fills[1]);
  over_fill.file = "power_over_fill";
  over_fill.title = "Mixing power over fill";
  over_fill.caption = caption;
  std::vector<std::array<double, 2>> pairs;
  for (const PowerPoint& p : points) pairs.push_back({predict_at(equations[0], p, p.fill, p.speed).power, p.power});
  Plot parity = parity_plot({{"runs", pairs}}, kThesisModelLimit, "published equation / W", "simulated / W");
  parity.file = "parity";
  parity.title = "Simulated power against the published equation";
  parity.caption = fmt::format(
      "Dashed: ± {:.1f} %, the booklet's limit for simulation against measurement (Thesis 2). The equation is no "
      "measurement: "
      "agreement with it alone proves nothing.",
      100 * kThesisModelLimit);
  return {over_speed, over_fill, parity};
}

void add_fit(const json& fit, const std::string& path, const std::string& name, Page& page) {
  try {
    const auto text = fit.at("equation").get<std::string>();
    const json& statistics = fit.at("statistics");
    page.figures.push_back({"Fitted equation, largest error", percent(statistics.at("max_relative_error")),
                            fmt::format("booklet's own: {:.1f} %", 100 * ThesisEquation::max_relative_error)});
    page.summary.push_back({fmt::format("{} (from {} rows; {}).", text, statistics.at("rows").get<int>(), name)});
    for (const json& note : fit.at("notes")) page.summary.push_back({"Note on the fit: " + note.get<std::string>()});

    Section section{"Equation of mixing power: " + name, {}};
    section.blocks.push_back(Paragraph{text});
    section.blocks.push_back(coefficient_table(fit));
    section.blocks.push_back(statistics_table(fit));

    const std::vector<PowerPoint> points = fitted_points(fit);
    std::vector<DrawnEquation> equations = {{"fitted", path, read_equation(path)},
                                            {"published", "the booklet's equation", thesis_equation()}};
    const auto speeds = levels(points, &PowerPoint::speed), fills = levels(points, &PowerPoint::fill);
    const std::string caption =
        "Points: rows of the table with 95 % intervals. Solid: the fitted equation; dashed: the published one.";
    Plot over_speed =
        power_plot(points, equations, &PowerPoint::speed, &PowerPoint::fill, speeds.front(), speeds.back());
    over_speed.file = name + "_power_over_speed";
    over_speed.title = "Mixing power over speed";
    over_speed.caption = caption;
    section.blocks.push_back(over_speed);
    Plot over_fill = power_plot(points, equations, &PowerPoint::fill, &PowerPoint::speed, fills.front(), fills.back());
    over_fill.file = name + "_power_over_fill";
    over_fill.title = "Mixing power over fill";
    over_fill.caption = caption;
    section.blocks.push_back(over_fill);

    std::vector<std::array<double, 2>> fitted, held_out;
    for (const json& r : fit.at("residuals")) {
      const double power = r.at("power");
      fitted.push_back({power, power * r.at("fitted").get<double>() / r.at("observed").get<double>()});
    }
    for (const json& r : fit.value("check_rows", json::array()))
      held_out.push_back({r.at("power"), r.at("predicted_power")});
    Plot parity = parity_plot({{"rows fitted", fitted}, {"rows held out", held_out}}, kThesisModelLimit, "observed / W",
                              "fitted equation / W");
    parity.file = name + "_parity";
    parity.title = "Fitted against observed power";
    parity.caption = fmt::format("Dashed: ± {:.1f} %, the booklet's limit for predicted powers (Thesis 2).",
                                 100 * kThesisModelLimit);
    section.blocks.push_back(parity);
    for (Plot& plot : residual_plots(fit, name)) section.blocks.push_back(std::move(plot));
    page.sections.push_back(std::move(section));
  } catch (const json::exception& error) {
    throw BadInput(path, 0, fmt::format("is no fit ({})", error.what()), "make it again with `vielto fit --out`");
  } catch (const std::bad_optional_access&) {
    throw BadInput(path, 0, "has a row without l, N_C or Fr_M", "make it again with `vielto fit --out`");
  }
}

}  // namespace vielto

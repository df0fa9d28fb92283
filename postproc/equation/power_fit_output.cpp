// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto fit` writes: the JSON that later commands read, and the tables a person reads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "core/mixing_numbers.h"
#include "equation/power_fit.h"

namespace vielto {
namespace {

using nlohmann::json;

const char* basis_name(IntervalBasis basis) { return basis == IntervalBasis::u ? "u" : "scatter"; }

const char* objective_name(Objective objective) {
  return objective == Objective::absolute ? "absolute" : objective == Objective::log ? "log" : "relative";
}

bool weighted(const PowerFit& fit) { return fit.request.weighted && fit.request.objective != Objective::relative; }

json errors_json(const RelativeErrors& e) {
  return {{"mean", e.mean}, {"root_mean_square", e.root_mean_square}, {"maximum", e.maximum}};
}

json coefficient_json(const PowerFit& fit, const Coefficient& c) {
  json j = {{"value", c.value}, {"low95", c.low95}, {"high95", c.high95}};
  // Of the logarithm for a factor.
  j["standard_error"] = c.standard_error;
  if (c.fixed) j["fixed"] = true;
  if (const auto booklet = booklet_value(fit, c)) j["booklet"] = *booklet;
  return j;
}

double correlation(const PowerLawFit& law, Eigen::Index i, Eigen::Index j) {
  return law.covariance(i, j) / std::sqrt(law.covariance(i, i) * law.covariance(j, j));
}

// Parameters with an error of their own: those that correlate.
std::vector<Eigen::Index> estimated(const PowerLawFit& law) {
  std::vector<Eigen::Index> list;
  for (Eigen::Index i = 0; i < law.parameters.size(); ++i)
    if (law.covariance(i, i) > 0) list.push_back(i);
  return list;
}

// What parameter i of the fitted equation stands for: a coefficient, or a combination where aliases took it in.
std::string label(const PowerLawFit& law, Eigen::Index i) {
  for (const std::string& name : law.undetermined)
    if (name == law.names[i])
      for (const Coefficient& c : law.combinations)
        if (c.weights[i] == 1) return c.name;
  return law.names[i];
}

// Relative deviations f/y - 1 of the rows, over the levels of one quantity; at most 8 levels, else 4 equal shares.
struct Level {
  double low = 0, high = 0;
  int rows = 0;
  double mean = 0, maximum = 0;
};

std::vector<Level> residual_levels(const PowerFit& fit, const std::function<double(const PowerRow&)>& quantity) {
  std::vector<std::pair<double, double>> rows;  // quantity, deviation
  for (Eigen::Index i = 0; i < fit.number.size(); ++i)
    rows.emplace_back(quantity(fit.data.fit[static_cast<std::size_t>(i)]), fit.law.fitted[i] / fit.number[i] - 1);
  std::sort(rows.begin(), rows.end());
  constexpr std::size_t kMostLevels = 8, kShares = 4;
  const auto same = [](double a, double b) { return std::fabs(a - b) <= 1e-9 * std::fabs(b); };
  std::size_t distinct = 1;
  for (std::size_t i = 1; i < rows.size(); ++i) distinct += !same(rows[i].first, rows[i - 1].first);
  std::vector<Level> levels;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool next = distinct <= kMostLevels ? i == 0 || !same(rows[i].first, rows[i - 1].first)
                                              : i * kShares / rows.size() != levels.size() - 1;
    if (next) levels.push_back({rows[i].first, rows[i].first, 0, 0, 0});
    Level& level = levels.back();
    level.high = rows[i].first;
    level.mean += (rows[i].second - level.mean) / ++level.rows;
    level.maximum = std::max(level.maximum, std::fabs(rows[i].second));
  }
  return levels;
}

// Every quantity that varies over the rows: the groups, in the equation or not, and the speed.
std::map<std::string, std::vector<Level>> residuals_by_group(const PowerFit& fit) {
  std::map<std::string, std::vector<Level>> tables;
  for (int g = 0; g < kGroupCount; ++g) {
    const auto& range = fit.equation.group_range[g];
    if (!range || range->high <= range->low * (1 + 1e-9)) continue;
    tables[kGroupNames[g]] = residual_levels(fit, [g](const PowerRow& row) { return *row.groups[g]; });
  }
  tables["speed"] = residual_levels(fit, [](const PowerRow& row) { return *row.observation.speed; });
  return tables;
}

std::string errors_text(const char* name, const RelativeErrors& e) {
  return fmt::format("{:<44}{:>8.2f} %{:>8.2f} %{:>8.2f} %\n", name, 100 * e.mean, 100 * e.root_mean_square,
                     100 * e.maximum);
}

const char* weights_name(const PowerFit& fit) {
  return !weighted(fit) ? "equal" : fit.data.covariance_paths.empty() ? "u" : "u and covariance";
}

json correlations_json(const PowerLawFit& law) {
  json correlations = json::object();
  for (const Eigen::Index i : estimated(law))
    for (const Eigen::Index j : estimated(law)) correlations[label(law, i)][label(law, j)] = correlation(law, i, j);
  return correlations;
}

json residuals_json(const PowerFit& fit) {
  json residuals = json::array();
  for (Eigen::Index i = 0; i < fit.number.size(); ++i) {
    const PowerRow& row = fit.data.fit[static_cast<std::size_t>(i)];
    json r = {{"test", row.observation.test},
              {"material", row.observation.material},
              {"speed", *row.observation.speed},
              {"power", row.observation.value},
              {"observed", fit.number[i]},
              {"u", fit.number_u[i]},
              {"fitted", fit.law.fitted[i]},
              {"leave_one_out", fit.law.leave_one_out[i]},
              {"relative_deviation", fit.law.fitted[i] / fit.number[i] - 1}};
    for (int g = 0; g < kGroupCount; ++g)
      if (row.groups[g]) r["groups"][kGroupNames[g]] = *row.groups[g];
    residuals.push_back(r);
  }
  return residuals;
}

json residuals_by_group_json(const PowerFit& fit) {
  json by_group = json::object();
  for (const auto& [name, levels] : residuals_by_group(fit))
    for (const Level& level : levels)
      by_group[name].push_back({{"low", level.low},
                                {"high", level.high},
                                {"rows", level.rows},
                                {"mean_relative_deviation", level.mean},
                                {"max_relative_deviation", level.maximum}});
  return by_group;
}

json statistics_json(const PowerFit& fit) {
  const PowerLawFit& law = fit.law;
  json statistics = {{"rows", law.rows},
                     {"degrees_of_freedom", law.degrees_of_freedom},
                     {"r2", law.r2},
                     {"adjusted_r2", law.adjusted_r2},
                     {"rmse", law.rmse},
                     {"mean_relative_error", law.errors.mean},
                     {"rms_relative_error", law.errors.root_mean_square},
                     {"max_relative_error", law.errors.maximum},
                     {"leave_one_out_rmse", law.leave_one_out_rmse},
                     {"leave_one_out", errors_json(law.leave_one_out_errors)},
                     {"relative_scatter", law.relative_scatter}};
  if (weighted(fit)) {
    statistics["chi2"] = law.chi2;
    statistics["chi2_per_degree_of_freedom"] = law.chi2 / law.degrees_of_freedom;
    statistics["chi2_exceedance"] = law.chi2_exceedance;
  }
  return statistics;
}

json intervals_json(const PowerFit& fit) {
  const PowerLawFit& law = fit.law;
  json errors = json::object();
  for (const Eigen::Index i : estimated(law)) {
    const std::string name = i == 0 ? "ln " + label(law, i) : label(law, i);
    errors[name]["from_scatter"] = law.standard_error_from_scatter[i];
    if (weighted(fit)) errors[name]["from_u"] = law.standard_error_from_u[i];
  }
  return {{"basis", basis_name(law.interval_basis)}, {"quantile", law.quantile}, {"standard_errors", errors}};
}

void add_check(const PowerFit& fit, json& result) {
  if (!fit.data.check.empty()) result["check"] = errors_json(fit.check_errors);
  for (Eigen::Index i = 0; i < fit.check_power.size(); ++i) {
    const Observation& o = fit.data.check[static_cast<std::size_t>(i)].observation;
    result["check_rows"].push_back(
        {{"test", o.test}, {"power", o.value}, {"u", o.u}, {"predicted_power", fit.check_power[i]}});
  }
}

}  // namespace

json power_fit_json(const PowerFit& fit) {
  const PowerLawFit& law = fit.law;
  json coefficients = json::object(), combinations = json::object(), fixed = json::object(), merged = json::object(),
       groups = json::array();
  for (const Coefficient& c : law.coefficients) {
    coefficients[c.name] = coefficient_json(fit, c);
    if (c.fixed) fixed[c.name] = c.value;
  }
  for (const Coefficient& c : law.combinations) combinations[c.name] = coefficient_json(fit, c);
  for (std::size_t j = 1; j < law.names.size(); ++j) groups.push_back(kGroupNames[group_of_coefficient(law.names[j])]);
  for (const int g : fit.merged)
    merged[fmt::format("B{}", g + 1)] = {{"group", kGroupNames[g]}, {"value", fit.equation.group_range[g]->low}};
  json result = {
      {"schema", 1},
      {"equation", equation_text(fit)},
      {"number", number_name(fit.request.number)},
      {"objective", objective_name(fit.request.objective)},
      {"weights", weights_name(fit)},
      {"groups", groups},
      {"coefficients", coefficients},
      {"identifiable", law.identifiable()},
      {"undetermined", law.undetermined},
      {"combinations", combinations},
      {"fixed", fixed},
      {"merged", merged},
      {"rank", law.rank},
      {"columns", law.columns},
      {"condition", law.condition},
      {"correlation", correlations_json(law)},
      {"intervals", intervals_json(fit)},
      {"statistics", statistics_json(fit)},
      {"booklet",
       {{"max_relative_error", ThesisEquation::max_relative_error}, {"against_rows", errors_json(fit.booklet_errors)}}},
      {"residuals", residuals_json(fit)},
      {"residuals_by_group", residuals_by_group_json(fit)},
      {"provisional", fit.equation.provisional},
      {"notes", fit.notes},
      {"prediction", to_json(fit.equation)}};
  add_check(fit, result);
  return result;
}

std::string power_fit_text(const PowerFit& fit) {
  const PowerLawFit& law = fit.law;
  std::string text = fmt::format("{}\n{} rows, errors {}, weights {}, 95 % intervals from {}\n\n", equation_text(fit),
                                 law.rows, objective_name(fit.request.objective), weights_name(fit),
                                 law.interval_basis == IntervalBasis::u ? "u" : "the scatter of the rows");
  const auto line = [&](const Coefficient& c, const std::string& group) {
    const auto booklet = booklet_value(fit, c);
    text += fmt::format("{:<16}{:<20}", c.name, group);
    text += c.fixed ? fmt::format("{:>11.4f}{:>24}", c.value, "(fixed)")
                    : fmt::format("{:>11.4f}{:>12.4f}{:>12.4f}", c.value, c.low95, c.high95);
    text += booklet ? fmt::format("{:>11.4f}\n", *booklet) : "\n";
  };
  text +=
      fmt::format("{:<16}{:<20}{:>11}{:>12}{:>12}{:>11}\n", "coefficient", "of", "value", "low95", "high95", "booklet");
  for (const Coefficient& c : law.coefficients)
    line(c, c.name == "B0" ? "" : kGroupNames[group_of_coefficient(c.name)]);
  for (const Coefficient& c : law.combinations) line(c, "");
  for (const std::string& name : law.undetermined)
    text += fmt::format("{:<16}{:<20}{:>11}\n", name, name == "B0" ? "" : kGroupNames[group_of_coefficient(name)],
                        "not determined");

  const std::vector<Eigen::Index> free = estimated(law);
  text += fmt::format("\nrank {} of {}, condition number {:.3g}\n", law.rank, law.columns, law.condition);
  if (free.size() > 1) {
    text += fmt::format("{:<14}", "correlation");
    for (const Eigen::Index j : free) text += fmt::format("{:>14}", label(law, j));
    text += "\n";
    for (const Eigen::Index i : free) {
      text += fmt::format("{:<14}", label(law, i));
      for (const Eigen::Index j : free) text += fmt::format("{:>14.3f}", correlation(law, i, j));
      text += "\n";
    }
  }

  text += fmt::format("\nR2 {:.5f}, adjusted {:.5f}, RMSE {:.4g} (of {})", law.r2, law.adjusted_r2, law.rmse,
                      number_name(fit.request.number));
  if (weighted(fit))
    text += fmt::format(", chi2 {:.4g} for {} degrees of freedom (p = {:.2g})", law.chi2, law.degrees_of_freedom,
                        law.chi2_exceedance);
  text += fmt::format("\n\n{:<44}{:>10}{:>10}{:>10}\n", "relative error", "mean", "rms", "maximum");
  text += errors_text("of the equation", law.errors);
  text += errors_text("of a row, fitted without it (leave-one-out)", law.leave_one_out_errors);
  if (!fit.data.check.empty()) text += errors_text("of the rows of role check", fit.check_errors);
  text += errors_text("of the booklet's equation on these rows", fit.booklet_errors);
  text += fmt::format("{:<44}{:>10}{:>10}{:>8.2f} %\n", "stated in the booklet for its measurements", "", "",
                      100 * ThesisEquation::max_relative_error);

  text += "\nfitted/observed - 1 over\n";
  for (const auto& [name, levels] : residuals_by_group(fit)) {
    for (const Level& level : levels) {
      const std::string where = level.high > level.low * (1 + 1e-9)
                                    ? fmt::format("{:.4g} to {:.4g}", level.low, level.high)
                                    : fmt::format("{:.4g}", level.low);
      text += fmt::format("  {:<20}{:<22}{:>4} rows  mean {:>+7.2f} %  largest {:>6.2f} %\n", name, where, level.rows,
                          100 * level.mean, 100 * level.maximum);
    }
  }
  if (!fit.notes.empty()) text += "\n";
  for (const std::string& note : fit.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace vielto

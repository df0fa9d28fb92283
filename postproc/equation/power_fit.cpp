// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/power_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/bad_input.h"
#include "core/mixing_numbers.h"

namespace vielto {
namespace {

// A group whose values agree to this relative difference is a constant.
constexpr double kConstant = 1e-9;
// Belsley, Kuh & Welsch, Regression Diagnostics (Wiley, 1980): from 30 on, collinearity does harm.
constexpr double kHighCondition = 30;

bool is_constant(const FittedRange& range) { return range.high - range.low <= kConstant * range.high; }

// The range of a group over the rows; nothing if a row does not know it.
std::optional<FittedRange> range_over(const std::vector<PowerRow>& rows, int group) {
  std::optional<FittedRange> range;
  for (const PowerRow& row : rows) {
    const auto& value = row.groups[group];
    if (!value) return std::nullopt;
    if (!range) range = FittedRange{*value, *value};
    range->low = std::min(range->low, *value);
    range->high = std::max(range->high, *value);
  }
  return range;
}

std::string needed_for(int group) {
  if (group == 1) return "--material CARD with bulkDensity and bulkCohesion";
  if (group == 3 || group == 5) return "--mixer FILE with the geometry";
  if (group == 7) return "--material CARD for the wall that the rows name, both cards with frictionAngle";
  return "--mixer FILE and a card with " + std::string(group == 4 ? "diameter" : "reposeAngle");
}

// Exponents of N_C and Fr_M told apart by materials whose rho_h/C_h differ by less than its uncertainty are not told
// apart by evidence.
void note_weak_contrast(PowerFit& fit) {
  const auto free = [&](const char* name) {
    return std::any_of(fit.law.coefficients.begin(), fit.law.coefficients.end(),
                       [&](const Coefficient& c) { return c.name == name && !c.fixed; });
  };
  // Mixers of two sizes tell them apart by their levers, which are known well.
  const bool one_lever = is_constant(fit.equation.lever);
  if (!free("B2") || !free("B3") || !one_lever) return;
  double low = INFINITY, high = 0, u = 0;
  for (const PowerRow& row : fit.data.fit) {
    const double ratio = *row.material.bulk_density / *row.material.bulk_cohesion;
    low = std::min(low, ratio);
    high = std::max(high, ratio);
    u = std::max(u, row.material.ratio_u.value_or(0));
  }
  if (std::log(high / low) < 2 * u)
    fit.notes.push_back(
        fmt::format("N_C/Fr_M differs by {:.2g} % between the materials, no more than its uncertainty of {:.2g} % "
                    "allows: do not trust B2 and B3 apart",
                    100 * std::log(high / low), 100 * u));
}

void add_notes(PowerFit& fit) {
  const PowerLawFit& law = fit.law;
  fit.notes = fit.data.notes;
  for (const int g : fit.merged)
    fit.notes.push_back(fmt::format("{} is the same in every row: merged into B0", kGroupNames[g]));
  for (const Alias& alias : law.aliases) {
    std::string product = fmt::format("{:.4g}", std::exp(alias.constant)), with;
    for (Eigen::Index j = 0; j < alias.weights.size(); ++j) {
      const double w = alias.weights[j];
      if (w == 0) continue;
      product += " " + kGroupNames[group_of_coefficient(law.names[j + 1])];
      if (std::fabs(w - 1) > 1e-6) product += fmt::format("^{:.4g}", w);
      with += law.names[j + 1] + ", ";
    }
    fit.notes.push_back(
        fmt::format("{} = {} in every row: the rows do not tell {} from {}B0; stated is only what they "
                    "determine, or fix one, such as --fix {}=VALUE",
                    kGroupNames[group_of_coefficient(alias.name)], product, alias.name, with, alias.name));
  }
  if (law.identifiable() && !law.combinations.empty())
    fit.notes.push_back("the rows determine only the combinations; what is apart rests on the fixed exponent");
  if (law.aliases.empty() && law.condition > kHighCondition)
    fit.notes.push_back(fmt::format("condition number {:.3g} > {}: groups nearly move together, see the intervals",
                                    law.condition, kHighCondition));
  note_weak_contrast(fit);
  if (law.interval_basis == IntervalBasis::scatter && law.chi2 > 0)
    fit.notes.push_back(
        fmt::format("chi2 = {:.3g} for {} degrees of freedom (p = {:.2g}): the stated u are too small "
                    "or the equation does not hold; intervals are from the scatter",
                    law.chi2, law.degrees_of_freedom, law.chi2_exceedance));
  constexpr double kTooGood = 0.999;
  if (law.chi2_exceedance > kTooGood && law.interval_basis == IntervalBasis::u)
    fit.notes.push_back("chi2 is far below the degrees of freedom: the stated u are larger than the rows scatter");
  if (fit.equation.provisional) fit.notes.push_back("provisional: a material card is not calibrated yet");
}

double scale_of(const PowerStream::Row& row, PowerNumber number) {
  return number == PowerNumber::n_pc ? row.scale_n_pc : row.scale_n_p;
}

// The errors of the equations over the rows of a long table.
void add_long_errors(const PowerStream& stream, PowerFit& fit) {
  RelativeErrorSum booklet, check;
  const Equation& e = fit.equation;
  stream.for_each([&](const PowerStream::Row& row) {
    if (row.check == 0) {
      booklet.add(row.power, row.booklet);
      return;
    }
    Eigen::VectorXd x = Eigen::VectorXd::Ones(e.parameters.size());
    for (Eigen::Index j = 1; j < x.size(); ++j) x[j] = std::log(row.groups[group_of_coefficient(e.names[j])]);
    for (const Alias& a : e.aliases) {
      const auto own = std::find(e.names.begin(), e.names.end(), a.name) - e.names.begin();
      constexpr double kSlack = 1e-3;
      if (std::fabs(x[own] - a.constant - a.weights.dot(x.tail(x.size() - 1))) > kSlack)
        throw BadInput(
            fit.data.check.front().file, 0,
            fmt::format("holds rows of role check that need {} apart, which the fit does not determine", a.name),
            fmt::format("fit rows that tell it apart, or fix it (--fix {}=VALUE)", a.name));
    }
    check.add(row.power, std::exp(x.dot(e.parameters)) * scale_of(row, e.number));
  });
  fit.booklet_errors = booklet.errors();
  fit.check_errors = check.errors();
}

// Groups that are asked for or fixed, but for those that are constant and free: they merge into B0.
std::vector<int> groups_that_vary(const PowerFitRequest& request, const std::string& file, PowerFit& fit) {
  std::set<int> chosen(request.groups.begin(), request.groups.end());
  for (const auto& [name, value] : request.fixed)
    if (name != "B0") chosen.insert(group_of_coefficient(name));
  std::vector<int> groups;
  for (const int g : chosen) {
    const std::optional<FittedRange>& range = fit.equation.group_range[g];
    if (!range) throw BadInput(file, 0, fmt::format("has rows without {}", kGroupNames[g]), "give " + needed_for(g));
    const bool fixed = request.fixed.count(fmt::format("B{}", g + 1)) > 0;
    (is_constant(*range) && !fixed ? fit.merged : groups).push_back(g);
  }
  return groups;
}

// Ranges of the groups and of the lever, and whether a card is provisional, over the rows at hand.
void set_ranges(const std::vector<PowerRow>& rows, Equation& equation) {
  for (int g = 0; g < kGroupCount; ++g) equation.group_range[g] = range_over(rows, g);
  equation.lever = {rows.front().mixer.lever, rows.front().mixer.lever};
  for (const PowerRow& row : rows) {
    equation.lever = {std::min(equation.lever.low, row.mixer.lever), std::max(equation.lever.high, row.mixer.lever)};
    equation.provisional = equation.provisional || row.material.provisional;
  }
}

// The same over all rows of a long table.
void set_ranges(const PowerStream& stream, Equation& equation) {
  for (int g = 0; g < kGroupCount; ++g) equation.group_range[g] = stream.group_range[g];
  equation.lever = stream.lever;
  equation.provisional = stream.provisional;
}

// The rows at hand as numbers and groups. Sets number and number_u.
PowerLawProblem problem_of(const PowerFitRequest& request, const std::vector<int>& groups, PowerFit& fit) {
  const std::vector<PowerRow>& rows = fit.data.fit;
  const auto n = static_cast<Eigen::Index>(rows.size());
  PowerLawProblem problem;
  problem.objective = request.objective;
  problem.fixed = request.fixed;
  problem.log_groups.resize(n, static_cast<Eigen::Index>(groups.size()));
  for (const int g : groups) problem.names.push_back(fmt::format("B{}", g + 1));
  fit.number.resize(n);
  fit.number_u.resize(n);
  Eigen::VectorXd inverse_scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PowerRow& row = rows[i];
    inverse_scale[i] = 1 / power_scale(request.number, *row.observation.speed, row.mixer, row.material);
    fit.number[i] = row.observation.value * inverse_scale[i];
    fit.number_u[i] = row.observation.u * inverse_scale[i];
    for (std::size_t j = 0; j < groups.size(); ++j)
      problem.log_groups(i, static_cast<Eigen::Index>(j)) = std::log(*row.groups[groups[j]]);
  }
  problem.observed = fit.number;
  if (request.weighted)
    problem.covariance = inverse_scale.asDiagonal() * fit.data.covariance * inverse_scale.asDiagonal();
  return problem;
}

// Every fit row of a long table, as power_law.h takes them.
void each_row(const PowerStream& stream, const std::vector<int>& groups, PowerNumber number,
              const PowerLawProblem::UseRow& use) {
  std::vector<double> logs(groups.size());
  stream.for_each([&](const PowerStream::Row& row) {
    if (row.check != 0) return;
    for (std::size_t j = 0; j < groups.size(); ++j) logs[j] = std::log(row.groups[groups[j]]);
    const double scale = scale_of(row, number);
    use(logs.data(), row.power / scale, row.u / scale);
  });
}

// fit_power_law, its reasons with the file that is to be mended.
PowerLawFit solve(const PowerLawProblem& problem, const std::string& file, const PowerData& data) {
  try {
    return fit_power_law(problem);
  } catch (const std::invalid_argument& error) {
    if (std::string(error.what()).find("covariance") == std::string::npos)
      throw BadInput(file, 0, error.what(), "give more rows or fewer groups");
    throw BadInput(data.covariance_paths.empty() ? file : data.covariance_paths.front(), 0, error.what(),
                   "correct the covariances, or leave out a row that repeats another");
  }
}

// The errors of the booklet's equation over the fit rows, and of the fitted one over the check rows.
void add_errors(PowerFit& fit) {
  RelativeErrorSum booklet, check;
  for (const PowerRow& row : fit.data.fit)
    booklet.add(row.observation.value, thesis_power(*row.observation.fill, row.mixer.lever, *row.observation.speed,
                                                    *row.material.bulk_density, *row.material.bulk_cohesion));
  fit.check_power.resize(static_cast<Eigen::Index>(fit.data.check.size()));
  for (std::size_t i = 0; i < fit.data.check.size(); ++i) {
    const PowerRow& row = fit.data.check[i];
    const double power =
        predict(fit.equation, row.file, row.groups, *row.observation.speed, row.mixer, row.material).power;
    fit.check_power[static_cast<Eigen::Index>(i)] = power;
    check.add(row.observation.value, power);
  }
  fit.booklet_errors = booklet.errors();
  fit.check_errors = check.errors();
}

PowerFit fit_rows(const PowerFitRequest& request, PowerData all_rows, const PowerStream* stream) {
  PowerFit fit;
  fit.request = request;
  fit.data = std::move(all_rows);
  const PowerData& data = fit.data;
  if (data.fit.empty())
    throw BadInput(data.check.front().file, 0, "holds no power row of role fit", "give role fit to the rows to use");
  const std::string& file = data.fit.front().file;

  Equation& equation = fit.equation;
  if (stream)
    set_ranges(*stream, equation);
  else
    set_ranges(data.fit, equation);
  const std::vector<int> groups = groups_that_vary(request, file, fit);
  PowerLawProblem problem = problem_of(request, groups, fit);
  if (stream)
    problem.all_rows = [&](const PowerLawProblem::UseRow& use) { each_row(*stream, groups, request.number, use); };
  fit.law = solve(problem, file, data);

  equation.number = request.number;
  equation.names = fit.law.names;
  equation.parameters = fit.law.parameters;
  equation.covariance = fit.law.covariance;
  equation.quantile = fit.law.quantile;
  equation.scatter = fit.law.relative_scatter;
  equation.aliases = fit.law.aliases;
  if (stream)
    add_long_errors(*stream, fit);
  else
    add_errors(fit);
  add_notes(fit);
  if (stream && fit.law.rows > problem.observed.size())
    fit.notes.push_back(
        fmt::format("residuals and their tables are of {} of the {} rows", problem.observed.size(), fit.law.rows));
  return fit;
}

}  // namespace

PowerFit fit_power(const PowerFitRequest& request, PowerData data) {
  return fit_rows(request, std::move(data), nullptr);
}

PowerFit fit_power(const PowerFitRequest& request, const PowerStream& stream) {
  return fit_rows(request, stream.sample, &stream);
}

std::optional<double> booklet_value(const PowerFit& fit, const Coefficient& c) {
  // The factor stands for the booklet's groups only.
  const std::vector<std::string>& names = fit.law.names;
  for (const std::string& name : names)
    if (name > "B3" && c.weights[0] != 0) return std::nullopt;
  const bool all = names.size() == 4 && names.back() == "B3";
  if (c.weights[0] != 0 && !all) return std::nullopt;
  double value = 0;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const double w = c.weights[static_cast<Eigen::Index>(j)];
    if (w == 0) continue;
    if (names[j] == "B0")
      value += w * std::log(ThesisEquation::factor);
    else if (names[j] == "B1")
      value += w * ThesisEquation::fill_exponent;
    else if (names[j] == "B2")
      value += w * (ThesisEquation::cohesion_exponent - (fit.request.number == PowerNumber::n_p));
    else if (names[j] == "B3")
      value += w * ThesisEquation::froude_exponent;
    else
      return std::nullopt;
  }
  return c.weights[0] != 0 ? std::exp(value) : value;
}

std::string equation_text(const PowerFit& fit) {
  const PowerLawFit& law = fit.law;
  std::string text = fmt::format("{} = {:.5g}", number_name(fit.request.number), std::exp(law.parameters[0]));
  for (std::size_t j = 1; j < law.names.size(); ++j) {
    const bool alias =
        std::any_of(law.aliases.begin(), law.aliases.end(), [&](const Alias& a) { return a.name == law.names[j]; });
    const int group = group_of_coefficient(law.names[j]);
    const std::string& symbol = kGroupNames[group];
    if (!alias)
      text += fmt::format(" {}^{:.4g}", group >= 3 ? "(" + symbol + ")" : symbol,
                          law.parameters[static_cast<Eigen::Index>(j)]);
  }
  return text;
}

}  // namespace vielto

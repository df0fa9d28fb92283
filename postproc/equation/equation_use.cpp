// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/equation_use.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/bad_input.h"
#include "equation/equation_covariance.h"

namespace vielto {
namespace {

// Where a power that grows with the fill reaches `limit`.
template <class Power>
std::optional<double> fill_of(Power power, double limit, const FittedRange& range) {
  if (power(range.low) > limit) return std::nullopt;
  if (power(range.high) <= limit) return range.high;
  double low = range.low, high = range.high;
  for (int i = 0; i < 100 && high - low > 1e-12 * high; ++i) {
    const double middle = (low + high) / 2;
    (power(middle) <= limit ? low : high) = middle;
  }
  return low;
}

}  // namespace

Prediction EquationUse::at(double fill, double speed) const {
  const Groups groups = groups_of(fill, speed, mixer, material, wall ? &*wall : nullptr);
  return predict(equation, source, groups, speed, mixer, material);
}

Prediction EquationUse::checked(double fill, double speed) const {
  Prediction p = at(fill, speed);
  if (!p.outside.empty() && !extrapolate)
    throw BadInput(source, 0,
                   fmt::format("does not hold at speed {} and fill {}: {}", speed, fill, fmt::join(p.outside, ", ")),
                   "stay inside, or add --extrapolate to be told all the same");
  return p;
}

LargestFill largest_fill(const EquationUse& use, double speed, double power) {
  const auto& range = use.equation.group_range[0];
  if (!range || range->high <= range->low)
    throw BadInput(use.source, 0, "was fitted at one fill", "fit rows of several fills to ask for the largest");
  use.checked(range->low, speed);
  if (!(use.at(range->high, speed).power > use.at(range->low, speed).power))
    throw BadInput(use.source, 0, "has a power that does not grow with the fill",
                   "there is no largest fill to ask for");
  return {fill_of([&](double fill) { return use.at(fill, speed).power; }, power, *range),
          fill_of([&](double fill) { return use.at(fill, speed).new_high95; }, power, *range), *range};
}

std::vector<Observation> predicted_rows(const EquationUse& use, const PredictedRows& asked) {
  Observation row;
  row.apparatus = "mixer";
  row.moisture = asked.moisture;
  row.wall = use.wall ? use.wall->name : "";
  row.material = use.material.name;
  std::vector<Observation> rows;
  for (const double fill : asked.fills)
    for (const double speed : asked.speeds) {
      const Prediction p = use.checked(fill, speed);
      row.test = fmt::format("l{:.4g}_n{:.4g}", fill, speed);
      row.role = asked.role(fill);
      row.speed = speed;
      row.fill = fill;
      // Six digits are far more than the equation is good for, and read better.
      rows.push_back(
          with_value(row, "power", std::stod(fmt::format("{:.6g}", p.power)), std::stod(fmt::format("{:.3g}", p.u))));
    }
  return rows;
}

std::string predicted_covariances(const std::vector<Observation>& rows) {
  const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
  Eigen::VectorXd fill(n), speed(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    fill[i] = *rows[static_cast<std::size_t>(i)].fill;
    speed[i] = *rows[static_cast<std::size_t>(i)].speed;
  }
  Eigen::MatrixXd correlation;
  try {
    correlation = equation_error_correlation(fill, speed);
  } catch (const std::invalid_argument& error) {
    throw BadInput("--covariance", 0, error.what(), "ask for a grid of --speeds and --fills");
  }
  std::string text = "test_a,observable_a,test_b,observable_b,covariance\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = i + 1; j < rows.size(); ++j)
      text +=
          fmt::format("{},power,{},power,{:.6g}\n", rows[i].test, rows[j].test,
                      correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * rows[i].u * rows[j].u);
  return text;
}

}  // namespace vielto

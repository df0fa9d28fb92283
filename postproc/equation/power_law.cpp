// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/power_law.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/statistics.h"
#include "equation/nonlinear_least_squares.h"
#include "equation/weights.h"

namespace vielto {
namespace {

constexpr double kAliasTolerance = 1e-6;
constexpr double kImprobable = 0.05;

// Least squares of `target` on the columns of `design`.
Eigen::MatrixXd solve_linear(const Eigen::MatrixXd& design, const Eigen::MatrixXd& target) {
  return design.colPivHouseholderQr().solve(target);
}

// Which columns of `logs` are a constant plus a combination of earlier ones. Without `with_constant` (B0 is fixed) no
// constant is at hand. `skip` marks columns that take no part (fixed exponents).
struct Aliasing {
  std::vector<Eigen::Index> kept;
  std::vector<std::pair<Eigen::Index, Eigen::VectorXd>> aliases;  // column; constant (if any), then weights of `kept`
};

Aliasing find_aliases(const Eigen::MatrixXd& logs, bool with_constant, const std::vector<bool>& skip) {
  Aliasing result;
  Eigen::MatrixXd design = Eigen::MatrixXd::Ones(logs.rows(), with_constant ? 1 : 0);
  for (Eigen::Index k = 0; k < logs.cols(); ++k) {
    if (skip[k]) continue;
    const Eigen::VectorXd column = logs.col(k);
    const double spread = with_constant ? (column.array() - column.mean()).matrix().norm() : column.norm();
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(design.cols());
    if (design.cols() > 0) weights = solve_linear(design, column);
    if ((column - design * weights).norm() > kAliasTolerance * spread) {
      result.kept.push_back(k);
      design.conservativeResize(Eigen::NoChange, design.cols() + 1);
      design.rightCols(1) = column;
    } else {
      result.aliases.emplace_back(k, weights);
    }
  }
  // Weights of columns kept after the alias was found are 0.
  for (auto& [column, weights] : result.aliases) {
    const Eigen::Index known = weights.size();
    weights.conservativeResize(design.cols());
    weights.tail(design.cols() - known).setZero();
  }
  return result;
}

// Belsley's condition number: of the design with columns of length 1, here centred where B0 is free.
double condition_number(const Eigen::MatrixXd& logs, bool with_constant, const std::vector<bool>& skip) {
  Eigen::MatrixXd design(logs.rows(), 0);
  for (Eigen::Index k = 0; k < logs.cols(); ++k) {
    if (skip[k]) continue;
    Eigen::VectorXd column = logs.col(k);
    if (with_constant) column.array() -= column.mean();
    design.conservativeResize(Eigen::NoChange, design.cols() + 1);
    design.rightCols(1) = column.normalized();
  }
  if (design.cols() == 0) return 1;
  const Eigen::VectorXd s = Eigen::JacobiSVD<Eigen::MatrixXd>(design).singularValues();
  const double smallest = s[s.size() - 1];
  constexpr double kRounding = 1e-13;
  return smallest > kRounding * s[0] ? s[0] / smallest : std::numeric_limits<double>::infinity();
}

void check(const PowerLawProblem& problem) {
  const Eigen::VectorXd& y = problem.observed;
  if (problem.log_groups.rows() != y.size() ||
      problem.log_groups.cols() != static_cast<Eigen::Index>(problem.names.size()))
    throw std::invalid_argument("rows, groups and names differ in number");
  if (!(y.array() > 0).all() || !y.allFinite() || !problem.log_groups.allFinite())
    throw std::invalid_argument("a power law needs observed numbers and groups above 0");
  for (const auto& [name, value] : problem.fixed) {
    if (name == "B0" ? !(value > 0) : !std::isfinite(value))
      throw std::invalid_argument(fmt::format("{} cannot be fixed to {}", name, value));
    bool known = name == "B0";
    for (const std::string& other : problem.names) known = known || name == other;
    if (!known) throw std::invalid_argument(fmt::format("{} is fixed, but its group is not in the equation", name));
  }
}

// "2 B1" as it stands in a sum.
std::string term(double weight, const std::string& name, bool first) {
  const double rounded = std::round(weight);
  const bool whole = std::fabs(weight - rounded) < kAliasTolerance;
  const double magnitude = std::fabs(whole ? rounded : weight);
  std::string text = weight < 0 ? "-" : first ? "" : "+";
  if (!(whole && magnitude == 1)) text += fmt::format("{:.4g}*", magnitude);
  return text + name;
}

// The combination `weights` of the parameters with its interval.
Coefficient estimate(const PowerLawFit& fit, const std::string& name, const Eigen::VectorXd& weights) {
  Coefficient c;
  c.name = name;
  c.weights = weights;
  c.value = weights.dot(fit.parameters);
  c.standard_error = std::sqrt(std::max(0.0, weights.dot(fit.covariance * weights)));
  c.low95 = c.value - fit.quantile * c.standard_error;
  c.high95 = c.value + fit.quantile * c.standard_error;
  const bool is_factor = weights[0] != 0;  // a factor B0 is fitted as its logarithm
  if (is_factor)
    for (double* value : {&c.value, &c.low95, &c.high95}) *value = std::exp(*value);
  return c;
}

// The combinations that the data determine where exponents are not told apart, fixed ones among them.
void add_combinations(const PowerLawProblem& problem, PowerLawFit& fit) {
  const Eigen::Index k = problem.log_groups.cols();
  const Aliasing all = find_aliases(problem.log_groups, true, std::vector<bool>(k, false));
  if (all.aliases.empty()) return;
  Eigen::VectorXd w = Eigen::VectorXd::Unit(k + 1, 0);
  std::string factor = "B0";
  for (const auto& [column, weights] : all.aliases) {
    w[column + 1] = weights[0];
    if (std::fabs(weights[0]) > kAliasTolerance)
      factor += fmt::format("*{:.4g}^{}", std::exp(weights[0]), problem.names[column]);
  }
  if (factor != "B0") fit.combinations.push_back(estimate(fit, factor, w));
  for (std::size_t j = 0; j < all.kept.size(); ++j) {
    w = Eigen::VectorXd::Unit(k + 1, all.kept[j] + 1);
    std::string name = problem.names[all.kept[j]];
    bool mixed = false;
    for (const auto& [column, weights] : all.aliases) {
      const double weight = weights[static_cast<Eigen::Index>(j) + 1];
      if (std::fabs(weight) <= kAliasTolerance) continue;
      w[column + 1] = weight;
      name += term(weight, problem.names[column], false);
      mixed = true;
    }
    if (mixed) fit.combinations.push_back(estimate(fit, name, w));
  }
}

// Sums over rows, one at a time, for the statistics of a fit.
struct Sums {
  double n = 0, squares = 0, loo_squares = 0, scatter = 0, mean = 0, total = 0;
  RelativeErrorSum errors, leave_one_out;

  void add(double y, double fitted, double without) {
    ++n;
    const double before = y - mean;
    mean += before / n;
    total += before * (y - mean);
    squares += (y - fitted) * (y - fitted);
    loo_squares += (y - without) * (y - without);
    scatter += (y / fitted - 1) * (y / fitted - 1);
    errors.add(y, fitted);
    leave_one_out.add(y, without);
  }
};

// How a row enters the least squares at the logarithm `log_f` of its model value: whitened residual, and the factor
// that makes a design row its whitened derivative.
struct WhitenedRow {
  double residual = 0, factor = 0;
};

WhitenedRow whitened(Objective objective, double log_f, double y, double u) {
  const double f = std::exp(log_f);
  switch (objective) {
    case Objective::log:
      return {(std::log(y) - log_f) * y / u, y / u};
    case Objective::relative:
      return {1 - f / y, f / y};
    case Objective::absolute:
      break;
  }
  return {(y - f) / u, f / u};
}

// All rows of a long table in the coordinates of the fit: offset and design row of a row's groups.
class LongTable {
 public:
  LongTable(const PowerLawProblem& problem, bool weighted, const Eigen::MatrixXd& to_design,
            const Eigen::VectorXd& means, const Eigen::VectorXd& fixed)
      : problem_(problem), weighted_(weighted), to_design_(to_design), means_(means), fixed_(fixed) {}

  // use(ln groups with a leading 1, design row, offset of ln f, y, u)
  template <class Use>
  void for_each(Use use) const {
    const Eigen::Index k = problem_.log_groups.cols();
    Eigen::VectorXd logs = Eigen::VectorXd::Ones(k + 1);
    problem_.all_rows([&](const double* groups, double y, double u) {
      for (Eigen::Index j = 0; j < k; ++j) logs[j + 1] = groups[j];
      const double log_unit = problem_.objective == Objective::log ? y : 1;  // rows alike: u = 1 of what is compared
      use(logs, Eigen::VectorXd(to_design_ * logs - means_), fixed_.dot(logs), y, weighted_ ? u : log_unit);
    });
  }

  // Gauss-Newton from `fit` until the step is nothing against the standard errors.
  void refine(NonlinearFit& fit) const {
    const Eigen::Index p = fit.parameters.size();
    constexpr int kMostSteps = 30;
    for (int step = 0; step < kMostSteps; ++step) {
      Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(p, p);
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p);
      double chi2 = 0;
      Eigen::Index n = 0;
      for_each([&](const Eigen::VectorXd&, const Eigen::VectorXd& x, double offset, double y, double u) {
        const WhitenedRow row = whitened(problem_.objective, offset + x.dot(fit.parameters), y, u);
        normal.noalias() += row.factor * row.factor * x * x.transpose();
        gradient.noalias() += row.factor * row.residual * x;
        chi2 += row.residual * row.residual;
        ++n;
      });
      const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
      const Eigen::VectorXd change = solver.solve(gradient);
      fit.covariance = solver.solve(Eigen::MatrixXd::Identity(p, p));
      fit.chi2 = chi2;
      fit.degrees_of_freedom = n - p;
      if (!change.allFinite() || !fit.covariance.allFinite()) break;
      // Its length in standard errors, of which the rows' rounding leaves some 1e-10.
      const double length = std::sqrt(std::max(0.0, change.dot(gradient)));
      if (length < 1e-7) return;
      fit.parameters += change;
    }
    throw std::runtime_error("the sums over all rows do not come to a minimum from the fit of a sample of them");
  }

 private:
  const PowerLawProblem& problem_;
  bool weighted_;
  Eigen::MatrixXd to_design_;  // p x (k + 1), of (1, ln groups)
  Eigen::VectorXd means_, fixed_;
};

}  // namespace

void RelativeErrorSum::add(double observed, double predicted) {
  const double error = predicted / observed - 1;
  ++rows_;
  mean_ += (std::fabs(error) - mean_) / rows_;
  mean_square_ += (error * error - mean_square_) / rows_;
  maximum_ = std::max(maximum_, std::fabs(error));
}

RelativeErrors RelativeErrorSum::errors() const { return {mean_, std::sqrt(mean_square_), maximum_}; }

RelativeErrors relative_errors(const Eigen::VectorXd& observed, const Eigen::VectorXd& predicted) {
  RelativeErrorSum sum;
  for (Eigen::Index i = 0; i < observed.size(); ++i) sum.add(observed[i], predicted[i]);
  return sum.errors();
}

PowerLawFit fit_power_law(const PowerLawProblem& problem) {
  check(problem);
  const Eigen::VectorXd& y = problem.observed;
  const Eigen::Index n = y.size(), k = problem.log_groups.cols();
  PowerLawFit fit;
  fit.names = {"B0"};
  fit.names.insert(fit.names.end(), problem.names.begin(), problem.names.end());
  fit.parameters = Eigen::VectorXd::Zero(k + 1);

  // Fixed coefficients make an offset of ln f; the rest are told apart or not.
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(n);
  std::vector<bool> skip(k, false);
  for (Eigen::Index j = 0; j < k; ++j) {
    const auto fixed = problem.fixed.find(problem.names[j]);
    if (fixed == problem.fixed.end()) continue;
    skip[j] = true;
    fit.parameters[j + 1] = fixed->second;
    offset += fixed->second * problem.log_groups.col(j);
  }
  const auto fixed_factor = problem.fixed.find("B0");
  const bool free_factor = fixed_factor == problem.fixed.end();
  if (!free_factor) {
    fit.parameters[0] = std::log(fixed_factor->second);
    offset.array() += fit.parameters[0];
  }
  const Aliasing aliasing = find_aliases(problem.log_groups, free_factor, skip);
  const Eigen::Index constants = free_factor ? 1 : 0;
  const Eigen::Index p = constants + static_cast<Eigen::Index>(aliasing.kept.size());
  fit.rank = static_cast<int>(p);
  fit.columns = fit.rank + static_cast<int>(aliasing.aliases.size());
  fit.condition = condition_number(problem.log_groups, free_factor, skip);
  if (p == 0) throw std::invalid_argument("every coefficient is fixed; leave one free");
  if (n <= p)
    throw std::invalid_argument(
        fmt::format("{} rows for {} coefficients leave nothing to judge the fit by; add rows or fix exponents", n, p));

  // Centred columns: ln B0 and the exponents are then nearly independent, which the least squares likes.
  Eigen::MatrixXd design = Eigen::MatrixXd::Ones(n, p);
  Eigen::MatrixXd to_parameters = Eigen::MatrixXd::Zero(k + 1, p);
  if (free_factor) to_parameters(0, 0) = 1;
  for (std::size_t j = 0; j < aliasing.kept.size(); ++j) {
    const Eigen::Index column = constants + static_cast<Eigen::Index>(j), group = aliasing.kept[j];
    const double mean = free_factor ? problem.log_groups.col(group).mean() : 0;
    design.col(column) = problem.log_groups.col(group).array() - mean;
    to_parameters(group + 1, column) = 1;
    to_parameters(0, column) = -mean;
  }

  const bool weighted = problem.covariance.rows() > 0 && problem.objective != Objective::relative;
  const Eigen::VectorXd inverse = y.cwiseInverse();
  Weights weights = weighted ? Weights::correlated(problem.covariance) : Weights::equal(n);
  const Weights log_weights = weighted ? weights.scaled(inverse) : weights;
  const Eigen::VectorXd log_y = y.array().log();
  const Eigen::VectorXd start = solve_linear(log_weights.whiten(design), log_weights.whiten(log_y - offset));

  const bool log = problem.objective == Objective::log;
  const bool relative = problem.objective == Objective::relative;
  if (log) weights = log_weights;
  const auto model = [&](const auto* b, auto* f) {
    for (Eigen::Index i = 0; i < n; ++i) {
      auto sum = b[0] * design(i, 0);
      for (Eigen::Index j = 1; j < p; ++j) sum += b[j] * design(i, j);
      sum += offset[i];
      f[i] = log ? sum : exp(sum) * (relative ? inverse[i] : 1.0);
    }
    return true;
  };
  const Eigen::VectorXd target = log ? log_y : relative ? Eigen::VectorXd(Eigen::VectorXd::Ones(n)) : y;
  NonlinearFit solution = nonlinear_least_squares_of(model, target, weights, start);

  // The same coordinates for all rows of a long table: design row = to_design (1, ln groups) - means.
  Eigen::MatrixXd to_design = Eigen::MatrixXd::Zero(p, k + 1);
  Eigen::VectorXd means = Eigen::VectorXd::Zero(p), fixed_part = Eigen::VectorXd::Zero(k + 1);
  if (free_factor) to_design(0, 0) = 1;
  for (std::size_t j = 0; j < aliasing.kept.size(); ++j) {
    const Eigen::Index column = constants + static_cast<Eigen::Index>(j);
    to_design(column, aliasing.kept[j] + 1) = 1;
    means[column] = free_factor ? problem.log_groups.col(aliasing.kept[j]).mean() : 0;
  }
  if (!free_factor) fixed_part[0] = std::log(fixed_factor->second);
  for (Eigen::Index j = 0; j < k; ++j)
    if (const auto fixed = problem.fixed.find(problem.names[j]); fixed != problem.fixed.end())
      fixed_part[j + 1] = fixed->second;
  const LongTable all(problem, weighted, to_design, means, fixed_part);
  if (problem.all_rows) {
    all.refine(solution);
    // What the sample does not tell apart, no row may.
    all.for_each([&](const Eigen::VectorXd& logs, const Eigen::VectorXd&, double, double, double) {
      for (const auto& [column, weight] : aliasing.aliases) {
        double value = free_factor ? weight[0] : 0;
        for (std::size_t j = 0; j < aliasing.kept.size(); ++j)
          value += weight[constants + static_cast<Eigen::Index>(j)] * logs[aliasing.kept[j] + 1];
        constexpr double kSlack = 1e-5;
        if (std::fabs(logs[column + 1] - value) > kSlack)
          throw std::invalid_argument(
              "few rows tell coefficients apart that a sample of the rows does not; give those rows a table of their "
              "own");
      }
    });
  }
  fit.rows = static_cast<long>(solution.degrees_of_freedom + p);

  fit.degrees_of_freedom = static_cast<int>(solution.degrees_of_freedom);
  fit.chi2 = weighted ? solution.chi2 : 0;
  fit.chi2_exceedance = weighted ? chi2_exceedance(solution.chi2, fit.degrees_of_freedom) : 1;
  const bool trust_u = weighted && fit.chi2_exceedance >= kImprobable;
  fit.interval_basis = trust_u ? "u" : "scatter";
  fit.quantile = trust_u ? kNormal975 : t975(fit.degrees_of_freedom);
  fit.parameters += to_parameters * solution.parameters;
  fit.covariance = to_parameters * solution.covariance * to_parameters.transpose();
  const Eigen::VectorXd root = fit.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  fit.standard_error_from_u = weighted ? root : Eigen::VectorXd(Eigen::VectorXd::Zero(k + 1));
  fit.standard_error_from_scatter = root * std::sqrt(solution.residual_variance());
  if (!trust_u) fit.covariance *= solution.residual_variance();

  // An alias takes its exponents with it: those it is mixed with are no longer determined, nor is B0.
  std::vector<bool> mixed(k + 1, false);
  for (const auto& [column, weight] : aliasing.aliases) {
    Alias alias{problem.names[column], free_factor ? weight[0] : 0, Eigen::VectorXd::Zero(k)};
    mixed[column + 1] = true;
    mixed[0] = mixed[0] || (free_factor && std::fabs(weight[0]) > kAliasTolerance);
    for (std::size_t j = 0; j < aliasing.kept.size(); ++j) {
      const double w = weight[constants + static_cast<Eigen::Index>(j)];
      if (std::fabs(w) <= kAliasTolerance) continue;
      alias.weights[aliasing.kept[j]] = w;
      mixed[aliasing.kept[j] + 1] = true;
    }
    fit.aliases.push_back(alias);
  }
  for (Eigen::Index j = 0; j <= k; ++j) {
    if (mixed[j]) {
      fit.undetermined.push_back(fit.names[j]);
      continue;
    }
    Coefficient c = estimate(fit, fit.names[j], Eigen::VectorXd::Unit(k + 1, j));
    c.fixed = problem.fixed.count(fit.names[j]) > 0;
    fit.coefficients.push_back(c);
  }
  add_combinations(problem, fit);

  // A row fitted without itself; q = v - step.vj is what is left of its weight v.
  const auto without = [&](double log_f, const Eigen::VectorXd& x, const Eigen::VectorXd& step, double q, double v,
                           double vr) {
    // A row that alone determines a coefficient is out of reach of the equation fitted without it.
    return q > 1e-12 * v ? std::exp(log_f - x.dot(step) * (vr / q)) : std::numeric_limits<double>::infinity();
  };
  Sums sums;
  fit.fitted.resize(n);
  fit.leave_one_out.resize(n);
  if (problem.all_rows) {
    const auto of_row = [&](const Eigen::VectorXd& x, double row_offset, double observed, double u) {
      const double log_f = row_offset + x.dot(solution.parameters);
      const WhitenedRow row = whitened(problem.objective, log_f, observed, u);
      const Eigen::VectorXd step = solution.covariance * x * row.factor;
      return std::pair(std::exp(log_f), without(log_f, x, step, 1 - row.factor * x.dot(step), 1, row.residual));
    };
    all.for_each([&](const Eigen::VectorXd&, const Eigen::VectorXd& x, double row_offset, double observed, double u) {
      const auto [fitted, left_out] = of_row(x, row_offset, observed, u);
      sums.add(observed, fitted, left_out);
    });
    for (Eigen::Index i = 0; i < n; ++i) {
      const double alike = log ? y[i] : 1;
      const double u = weighted ? std::sqrt(problem.covariance.coeff(static_cast<int>(i), static_cast<int>(i))) : alike;
      std::tie(fit.fitted[i], fit.leave_one_out[i]) = of_row(design.row(i), offset[i], y[i], u);
    }
  } else {
    const Eigen::MatrixXd vj = weights.precision_times(solution.jacobian);  // V^-1 J
    const Eigen::VectorXd vr = weights.precision_times(solution.residuals);
    const Eigen::VectorXd v = weights.precision_diagonal();
    for (Eigen::Index i = 0; i < n; ++i) {
      const double log_f = offset[i] + design.row(i).dot(solution.parameters);
      fit.fitted[i] = std::exp(log_f);
      // At the minimum J' V^-1 r = 0, so Q r = V^-1 r.
      const Eigen::VectorXd step = solution.covariance * vj.row(i).transpose();
      fit.leave_one_out[i] = without(log_f, design.row(i), step, v[i] - vj.row(i).dot(step), v[i], vr[i]);
      sums.add(y[i], fit.fitted[i], fit.leave_one_out[i]);
    }
  }

  const auto dof = static_cast<double>(fit.degrees_of_freedom);
  fit.r2 = sums.total > 0 ? 1 - sums.squares / sums.total : 0;
  fit.adjusted_r2 = sums.total > 0 ? 1 - (sums.squares / dof) / (sums.total / (sums.n - 1)) : 0;
  fit.rmse = std::sqrt(sums.squares / sums.n);
  fit.leave_one_out_rmse = std::sqrt(sums.loo_squares / sums.n);
  fit.relative_scatter = std::sqrt(sums.scatter / dof);
  fit.errors = sums.errors.errors();
  fit.leave_one_out_errors = sums.leave_one_out.errors();
  return fit;
}

}  // namespace vielto

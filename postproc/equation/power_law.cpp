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

// Which coefficients are fitted, and in what coordinates: those fixed make an offset of ln f, aliases are set apart,
// and the columns of the rest are centred. ln B0 and the exponents are then nearly independent, which the least squares
// likes. design row = to_design (1, ln groups) - means; parameters = fixed + to_parameters (fitted ones).
struct Coordinates {
  bool free_factor = true;
  std::vector<bool> is_fixed;  // k, of the exponents
  Aliasing aliasing;
  Eigen::Index count = 0;         // p, those fitted
  Eigen::MatrixXd to_design;      // p x (k + 1)
  Eigen::MatrixXd to_parameters;  // (k + 1) x p
  Eigen::VectorXd means;          // p
  Eigen::VectorXd fixed;          // k + 1, ln B0 and the exponents; 0 where they are free

  explicit Coordinates(const PowerLawProblem& problem);
  // Of the j-th group that is kept.
  Eigen::Index column(std::size_t j) const { return (free_factor ? 1 : 0) + static_cast<Eigen::Index>(j); }
  // The constant of an alias among its weights.
  double constant(const Eigen::VectorXd& weights) const { return free_factor ? weights[0] : 0; }
  Eigen::MatrixXd design(const Eigen::MatrixXd& log_groups) const;
  Eigen::VectorXd offset(const Eigen::MatrixXd& log_groups) const;
};

Coordinates::Coordinates(const PowerLawProblem& problem) {
  const Eigen::Index k = problem.log_groups.cols();
  is_fixed.assign(k, false);
  fixed = Eigen::VectorXd::Zero(k + 1);
  for (const auto& [name, value] : problem.fixed) {
    if (name == "B0") {
      free_factor = false;
      fixed[0] = std::log(value);
    }
    for (Eigen::Index j = 0; j < k; ++j)
      if (name == problem.names[j]) {
        is_fixed[j] = true;
        fixed[j + 1] = value;
      }
  }
  aliasing = find_aliases(problem.log_groups, free_factor, is_fixed);
  count = column(aliasing.kept.size());
  to_design = Eigen::MatrixXd::Zero(count, k + 1);
  to_parameters = Eigen::MatrixXd::Zero(k + 1, count);
  means = Eigen::VectorXd::Zero(count);
  if (free_factor) to_design(0, 0) = to_parameters(0, 0) = 1;
  for (std::size_t j = 0; j < aliasing.kept.size(); ++j) {
    const Eigen::Index group = aliasing.kept[j];
    if (free_factor) means[column(j)] = problem.log_groups.col(group).mean();
    to_design(column(j), group + 1) = to_parameters(group + 1, column(j)) = 1;
    to_parameters(0, column(j)) = -means[column(j)];
  }
}

Eigen::MatrixXd Coordinates::design(const Eigen::MatrixXd& log_groups) const {
  Eigen::MatrixXd d = Eigen::MatrixXd::Ones(log_groups.rows(), count);
  for (std::size_t j = 0; j < aliasing.kept.size(); ++j)
    d.col(column(j)) = log_groups.col(aliasing.kept[j]).array() - means[column(j)];
  return d;
}

Eigen::VectorXd Coordinates::offset(const Eigen::MatrixXd& log_groups) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(log_groups.rows());
  for (Eigen::Index j = 0; j < log_groups.cols(); ++j)
    if (is_fixed[j]) sum += fixed[j + 1] * log_groups.col(j);
  if (!free_factor) sum.array() += fixed[0];
  return sum;
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
  LongTable(const PowerLawProblem& problem, bool weighted, const Coordinates& coordinates)
      : problem_(problem), weighted_(weighted), at_(coordinates) {}

  // use(ln groups with a leading 1, design row, offset of ln f, y, u)
  template <class Use>
  void for_each(Use use) const {
    const Eigen::Index k = problem_.log_groups.cols();
    Eigen::VectorXd logs = Eigen::VectorXd::Ones(k + 1);
    problem_.all_rows([&](const double* groups, double y, double u) {
      for (Eigen::Index j = 0; j < k; ++j) logs[j + 1] = groups[j];
      const double log_unit = problem_.objective == Objective::log ? y : 1;  // rows alike: u = 1 of what is compared
      use(logs, Eigen::VectorXd(at_.to_design * logs - at_.means), at_.fixed.dot(logs), y, weighted_ ? u : log_unit);
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

  // What the sample does not tell apart, no row may.
  void check_aliases() const {
    for_each([&](const Eigen::VectorXd& logs, const Eigen::VectorXd&, double, double, double) {
      for (const auto& [alias, weights] : at_.aliasing.aliases) {
        double value = at_.constant(weights);
        for (std::size_t j = 0; j < at_.aliasing.kept.size(); ++j)
          value += weights[at_.column(j)] * logs[at_.aliasing.kept[j] + 1];
        constexpr double kSlack = 1e-5;
        if (std::fabs(logs[alias + 1] - value) > kSlack)
          throw std::invalid_argument(
              "few rows tell coefficients apart that a sample of the rows does not; give those rows a table of their "
              "own");
      }
    });
  }

 private:
  const PowerLawProblem& problem_;
  bool weighted_;
  const Coordinates& at_;
};

// The least squares of the rows at hand.
struct Solved {
  bool weighted;
  Eigen::MatrixXd design;
  Eigen::VectorXd offset;
  Weights weights;
  NonlinearFit fit;
};

// Nonlinear from the weighted log-linear solution, in the errors of the objective.
Solved solve(const PowerLawProblem& problem, const Coordinates& at) {
  const Eigen::VectorXd& y = problem.observed;
  const Eigen::Index n = y.size(), p = at.count;
  const bool log = problem.objective == Objective::log, relative = problem.objective == Objective::relative;
  const bool weighted = problem.covariance.rows() > 0 && !relative;
  const Eigen::MatrixXd design = at.design(problem.log_groups);
  const Eigen::VectorXd offset = at.offset(problem.log_groups);
  const Eigen::VectorXd inverse = y.cwiseInverse(), log_y = y.array().log();
  Weights weights = weighted ? Weights::correlated(problem.covariance) : Weights::equal(n);
  const Weights log_weights = weighted ? weights.scaled(inverse) : weights;
  const Eigen::VectorXd start = solve_linear(log_weights.whiten(design), log_weights.whiten(log_y - offset));
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
  NonlinearFit fit = nonlinear_least_squares_of(model, target, weights, start);
  return {weighted, design, offset, weights, fit};
}

// Parameters, and their covariance on the basis that chi2 allows.
void set_parameters(const Coordinates& at, const Solved& solved, PowerLawFit& fit) {
  const NonlinearFit& solution = solved.fit;
  fit.rows = static_cast<long>(solution.degrees_of_freedom + at.count);
  fit.degrees_of_freedom = static_cast<int>(solution.degrees_of_freedom);
  fit.chi2 = solved.weighted ? solution.chi2 : 0;
  fit.chi2_exceedance = solved.weighted ? chi2_exceedance(solution.chi2, fit.degrees_of_freedom) : 1;
  const bool trust_u = solved.weighted && fit.chi2_exceedance >= kImprobable;
  fit.interval_basis = trust_u ? IntervalBasis::u : IntervalBasis::scatter;
  fit.quantile = trust_u ? kNormal975 : t975(fit.degrees_of_freedom);
  fit.parameters = at.fixed + at.to_parameters * solution.parameters;
  fit.covariance = at.to_parameters * solution.covariance * at.to_parameters.transpose();
  const Eigen::VectorXd root = fit.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  fit.standard_error_from_u = solved.weighted ? root : Eigen::VectorXd(Eigen::VectorXd::Zero(root.size()));
  fit.standard_error_from_scatter = root * std::sqrt(solution.residual_variance());
  if (!trust_u) fit.covariance *= solution.residual_variance();
}

// An alias takes its exponents with it: those it is mixed with are no longer determined, nor is B0.
void set_coefficients(const PowerLawProblem& problem, const Coordinates& at, PowerLawFit& fit) {
  const Eigen::Index k = problem.log_groups.cols();
  std::vector<bool> mixed(k + 1, false);
  for (const auto& [column, weights] : at.aliasing.aliases) {
    Alias alias{problem.names[column], at.constant(weights), Eigen::VectorXd::Zero(k)};
    mixed[column + 1] = true;
    mixed[0] = mixed[0] || std::fabs(alias.constant) > kAliasTolerance;
    for (std::size_t j = 0; j < at.aliasing.kept.size(); ++j) {
      const double w = weights[at.column(j)];
      if (std::fabs(w) <= kAliasTolerance) continue;
      alias.weights[at.aliasing.kept[j]] = w;
      mixed[at.aliasing.kept[j] + 1] = true;
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
}

// f of a row by the equation fitted without it, from its ln f by all rows: `step` is C J' v of the row, q = v - step.vj
// what is left of its weight v, vr its weighted residual. A row that alone determines a coefficient is out of reach.
double without_row(double log_f, const Eigen::VectorXd& x, const Eigen::VectorXd& step, double q, double v, double vr) {
  return q > 1e-12 * v ? std::exp(log_f - x.dot(step) * (vr / q)) : std::numeric_limits<double>::infinity();
}

// Rows by the equation, and by the one fitted without them, where the rows at hand are all.
Sums judge_rows(const PowerLawProblem& problem, const Solved& solved, PowerLawFit& fit) {
  const Eigen::MatrixXd vj = solved.weights.precision_times(solved.fit.jacobian);  // V^-1 J
  const Eigen::VectorXd vr = solved.weights.precision_times(solved.fit.residuals);
  const Eigen::VectorXd v = solved.weights.precision_diagonal();
  Sums sums;
  for (Eigen::Index i = 0; i < problem.observed.size(); ++i) {
    const double log_f = solved.offset[i] + solved.design.row(i).dot(solved.fit.parameters);
    fit.fitted[i] = std::exp(log_f);
    // At the minimum J' V^-1 r = 0, so Q r = V^-1 r.
    const Eigen::VectorXd step = solved.fit.covariance * vj.row(i).transpose();
    fit.leave_one_out[i] = without_row(log_f, solved.design.row(i), step, v[i] - vj.row(i).dot(step), v[i], vr[i]);
    sums.add(problem.observed[i], fit.fitted[i], fit.leave_one_out[i]);
  }
  return sums;
}

// The same of a long table: sums of all its rows, numbers of the sample's.
Sums judge_rows(const PowerLawProblem& problem, const Solved& solved, const LongTable& all, PowerLawFit& fit) {
  const auto of_row = [&](const Eigen::VectorXd& x, double offset, double observed, double u) {
    const double log_f = offset + x.dot(solved.fit.parameters);
    const WhitenedRow row = whitened(problem.objective, log_f, observed, u);
    const Eigen::VectorXd step = solved.fit.covariance * x * row.factor;
    return std::pair(std::exp(log_f), without_row(log_f, x, step, 1 - row.factor * x.dot(step), 1, row.residual));
  };
  Sums sums;
  all.for_each([&](const Eigen::VectorXd&, const Eigen::VectorXd& x, double offset, double observed, double u) {
    const auto [fitted, left_out] = of_row(x, offset, observed, u);
    sums.add(observed, fitted, left_out);
  });
  for (Eigen::Index i = 0; i < problem.observed.size(); ++i) {
    const double y = problem.observed[i], alike = problem.objective == Objective::log ? y : 1;
    const int at = static_cast<int>(i);
    const double u = solved.weighted ? std::sqrt(problem.covariance.coeff(at, at)) : alike;
    std::tie(fit.fitted[i], fit.leave_one_out[i]) = of_row(solved.design.row(i), solved.offset[i], y, u);
  }
  return sums;
}

void set_statistics(const Sums& sums, PowerLawFit& fit) {
  const auto dof = static_cast<double>(fit.degrees_of_freedom);
  fit.r2 = sums.total > 0 ? 1 - sums.squares / sums.total : 0;
  fit.adjusted_r2 = sums.total > 0 ? 1 - (sums.squares / dof) / (sums.total / (sums.n - 1)) : 0;
  fit.rmse = std::sqrt(sums.squares / sums.n);
  fit.leave_one_out_rmse = std::sqrt(sums.loo_squares / sums.n);
  fit.relative_scatter = std::sqrt(sums.scatter / dof);
  fit.errors = sums.errors.errors();
  fit.leave_one_out_errors = sums.leave_one_out.errors();
}

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
  const Coordinates at(problem);
  const Eigen::Index n = problem.observed.size(), p = at.count;
  if (p == 0) throw std::invalid_argument("every coefficient is fixed; leave one free");
  if (n <= p)
    throw std::invalid_argument(
        fmt::format("{} rows for {} coefficients leave nothing to judge the fit by; add rows or fix exponents", n, p));

  PowerLawFit fit;
  fit.names = {"B0"};
  fit.names.insert(fit.names.end(), problem.names.begin(), problem.names.end());
  fit.rank = static_cast<int>(p);
  fit.columns = fit.rank + static_cast<int>(at.aliasing.aliases.size());
  fit.condition = condition_number(problem.log_groups, at.free_factor, at.is_fixed);

  Solved solved = solve(problem, at);
  const LongTable all(problem, solved.weighted, at);
  if (problem.all_rows) {
    all.refine(solved.fit);
    all.check_aliases();
  }
  set_parameters(at, solved, fit);
  set_coefficients(problem, at, fit);
  fit.fitted.resize(n);
  fit.leave_one_out.resize(n);
  set_statistics(problem.all_rows ? judge_rows(problem, solved, all, fit) : judge_rows(problem, solved, fit), fit);
  return fit;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: fit a power law to observed numbers, with what the data can and cannot tell apart.
//
// Equation: f = B0 prod_k g_k^Bk, k over the chosen groups. Errors of the fit, y the observed numbers:
//   absolute  y - f            weighted by the covariance of y, if given
//   log       ln y - ln f      weighted by the same covariance, to first order cov(ln y) = cov(y)/(y y')
//   relative  (y - f)/y        every row counts the same
// Nonlinear least squares (nonlinear_least_squares.h) from the weighted log-linear solution.
//
// Identifiability: groups are taken in their order; one whose logarithm is, over all rows, a constant plus a linear
// combination of those before it (to 1e-6 of its spread) is an alias: ln g_m = c + sum_j w_j ln g_j. Its exponent is
// then not told apart from theirs. What the data determine is the equation without it, with exponents B_j + sum_m w_j
// B_m and factor B0 exp(sum_m c B_m); these combinations are fitted and reported, the separate exponents are not,
// unless the caller fixes enough of them.
//
// Intervals (95 %): on Bk and on ln B0. Basis `u`: the given covariance is taken as true, normal quantile. Basis
// `scatter`: covariance times s^2 = chi2/(n - p), Student's t; used where rows have no weights or chi2 is too large for
// the stated uncertainties (exceeded with probability below 5 %): then the uncertainties are too small or the equation
// does not hold.
//
// Leave-one-out: the deviation of row i from the equation fitted without it, by one Gauss-Newton step from the full
// solution: b_(i) = b - C J' q_i r~_i / Q_ii with Q = V^-1 - V^-1 J C J' V^-1, r~ = Q r, q_i column i of V^-1. For
// independent rows and a linear model this is the exact r_i/(1 - h_ii).
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace vielto {

enum class Objective { absolute, relative, log };

struct PowerLawProblem {
  Eigen::VectorXd observed;                // n, > 0
  Eigen::SparseMatrix<double> covariance;  // n x n of the observed numbers; 0 x 0: every row counts the same
  Eigen::MatrixXd log_groups;              // n x k, ln of the chosen groups
  std::vector<std::string> names;          // k: "B1" ...
  Objective objective = Objective::absolute;
  std::map<std::string, double> fixed;  // coefficient by name; "B0" is B0 itself

  // Many rows: those above are a sample, and this calls back for each of all the independent rows (ln of the chosen
  // groups, number, its u), as often as asked. The sample gives the start and what is told apart; coefficients,
  // covariance and statistics are of all rows, by Gauss-Newton steps whose normal equations are summed row by row.
  using UseRow = std::function<void(const double* log_groups, double observed, double u)>;
  std::function<void(const UseRow&)> all_rows;
};

struct Coefficient {
  std::string name;
  double value = 0, low95 = 0, high95 = 0;
  double standard_error = 0;  // on the basis of the intervals; of ln B0 for a factor
  Eigen::VectorXd weights;    // of the parameters in it (ln B0, B1 ...)
  bool fixed = false;
};

// ln g_name = constant + sum_j weights_j ln g_j, j over all chosen groups (0 for aliases and fixed ones).
struct Alias {
  std::string name;
  double constant = 0;
  Eigen::VectorXd weights;
};

struct RelativeErrors {
  double mean = 0, root_mean_square = 0, maximum = 0;  // of |f/y - 1|
};

// The same, one row at a time.
class RelativeErrorSum {
 public:
  void add(double observed, double predicted);
  RelativeErrors errors() const;

 private:
  double rows_ = 0, mean_ = 0, mean_square_ = 0, maximum_ = 0;
};

// What the intervals rest on: the stated u, or how the rows scatter about the equation.
enum class IntervalBasis { u, scatter };

struct PowerLawFit {
  std::vector<std::string> names;  // "B0", then those of the problem
  Eigen::VectorXd parameters;      // ln B0 and the exponents; 0 where the exponent is an alias
  Eigen::MatrixXd covariance;      // of the parameters, on the basis of the intervals; 0 rows for fixed and aliases
  Eigen::VectorXd standard_error_from_u, standard_error_from_scatter;  // of the parameters on either basis
  IntervalBasis interval_basis = IntervalBasis::u;
  double quantile = 0;  // half width of a 95 % interval in standard errors

  std::vector<Coefficient> coefficients;  // those determined, fixed ones included
  std::vector<std::string> undetermined;  // names of the others
  std::vector<Coefficient> combinations;  // "B2+B3", "B0*0.148^B3"
  std::vector<Alias> aliases;             // among the free groups
  int columns = 0, rank = 0;              // of the design of the free coefficients
  double condition = 0;                   // of the centred design with columns of length 1; infinite for exact aliases

  long rows = 0;                          // fitted; of these the n of the problem are a sample if there are more
  Eigen::VectorXd fitted, leave_one_out;  // n, f of the equation, and of the equation fitted without the row
  int degrees_of_freedom = 0;
  double chi2 = 0, chi2_exceedance = 0;  // 0 and 1 if the rows have no weights
  double r2 = 0, adjusted_r2 = 0, rmse = 0, leave_one_out_rmse = 0;
  double relative_scatter = 0;  // sqrt(sum (y/f - 1)^2/(n - p))
  RelativeErrors errors, leave_one_out_errors;

  bool identifiable() const { return undetermined.empty(); }
};

// Errors: std::invalid_argument with one line of reason: rows too few, numbers not above 0, a covariance that is not
// positive definite, a fixed name that is not among the groups.
PowerLawFit fit_power_law(const PowerLawProblem& problem);

RelativeErrors relative_errors(const Eigen::VectorXd& observed, const Eigen::VectorXd& predicted);

}  // namespace vielto

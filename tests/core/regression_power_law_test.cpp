// SPDX-License-Identifier: GPL-2.0-or-later
// The power law: known coefficients recovered, what data cannot tell apart, closed forms of small fits, coverage of the
// intervals.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "equation/power_law.h"

namespace {

using vielto::IntervalBasis;
using vielto::Objective;
using vielto::PowerLawFit;
using vielto::PowerLawProblem;

constexpr double kFactor = 15.68, kFill = 1.04, kCohesion = 0.1, kFroude = -0.25;

// Grid of 4 fills and 4 speeds for each material; ln of l, N_C, Fr_M. A material is its N_C/Fr_M.
PowerLawProblem grid(const std::vector<double>& ratios) {
  PowerLawProblem problem;
  problem.names = {"B1", "B2", "B3"};
  std::vector<Eigen::Vector3d> rows;
  for (const double ratio : ratios)
    for (const double fill : {0.10, 0.15, 0.20, 0.25})
      for (const double speed : {0.48, 0.85, 1.21, 1.58}) {
        const double froude = 0.114 * speed * speed / 9.81;
        rows.emplace_back(std::log(fill), std::log(ratio * froude), std::log(froude));
      }
  problem.log_groups.resize(rows.size(), 3);
  problem.observed.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    problem.log_groups.row(i) = rows[i];
    problem.observed[i] = kFactor * std::exp(rows[i].dot(Eigen::Vector3d(kFill, kCohesion, kFroude)));
  }
  return problem;
}

Eigen::SparseMatrix<double> diagonal(const Eigen::VectorXd& variances) {
  return Eigen::MatrixXd(variances.asDiagonal()).sparseView();
}

void set_relative_u(PowerLawProblem& problem, double u) {
  problem.covariance = diagonal((u * problem.observed).cwiseAbs2());
}

double value(const PowerLawFit& fit, const std::string& name) {
  for (const auto* list : {&fit.coefficients, &fit.combinations})
    for (const vielto::Coefficient& c : *list)
      if (c.name == name) return c.value;
  ADD_FAILURE() << name << " is not stated";
  return std::nan("");
}

bool stated(const PowerLawFit& fit, const std::string& name) {
  for (const vielto::Coefficient& c : fit.coefficients)
    if (c.name == name) return true;
  return false;
}

// Data on the equation itself: least squares must return it to rounding, amplified by the condition number (about 10).
TEST(PowerLaw, KnownCoefficientsAreRecoveredFromTwoMaterials) {
  for (const Objective objective : {Objective::absolute, Objective::log, Objective::relative}) {
    PowerLawProblem problem = grid({0.15, 0.30});
    problem.objective = objective;
    const PowerLawFit fit = fit_power_law(problem);
    EXPECT_TRUE(fit.identifiable());
    EXPECT_TRUE(fit.combinations.empty());
    EXPECT_EQ(fit.rank, 4);
    EXPECT_NEAR(value(fit, "B0"), kFactor, 1e-9);
    EXPECT_NEAR(value(fit, "B1"), kFill, 1e-10);
    EXPECT_NEAR(value(fit, "B2"), kCohesion, 1e-10);
    EXPECT_NEAR(value(fit, "B3"), kFroude, 1e-10);
    EXPECT_NEAR(fit.r2, 1, 1e-12);
  }
}

// In one material N_C = c Fr_M, so N = B0 c^-B3 l^B1 N_C^(B2+B3): only B1, B2+B3 and that factor are data.
TEST(PowerLaw, OneMaterialDeterminesOnlyTheSumOfExponents) {
  const double ratio = 0.15;
  const PowerLawFit fit = fit_power_law(grid({ratio}));
  EXPECT_FALSE(fit.identifiable());
  EXPECT_EQ(fit.undetermined, (std::vector<std::string>{"B0", "B2", "B3"}));
  EXPECT_FALSE(stated(fit, "B2") || stated(fit, "B3") || stated(fit, "B0"));
  EXPECT_EQ(fit.rank, 3);
  EXPECT_EQ(fit.columns, 4);
  EXPECT_TRUE(std::isinf(fit.condition));
  EXPECT_NEAR(value(fit, "B1"), kFill, 1e-10);
  EXPECT_NEAR(value(fit, "B2+B3"), kCohesion + kFroude, 1e-10);
  ASSERT_EQ(fit.aliases.size(), 1u);
  EXPECT_EQ(fit.aliases[0].name, "B3");
  EXPECT_NEAR(fit.aliases[0].constant, -std::log(ratio), 1e-10);
  EXPECT_NEAR(fit.combinations[0].value, kFactor * std::pow(ratio, -kFroude), 1e-8);
}

TEST(PowerLaw, AFixedExponentLeavesTheOtherDetermined) {
  PowerLawProblem problem = grid({0.15});
  problem.fixed["B3"] = kFroude;
  const PowerLawFit fit = fit_power_law(problem);
  EXPECT_TRUE(fit.identifiable());
  EXPECT_NEAR(value(fit, "B0"), kFactor, 1e-9);
  EXPECT_NEAR(value(fit, "B2"), kCohesion, 1e-10);
  EXPECT_NEAR(value(fit, "B2+B3"), kCohesion + kFroude, 1e-10);  // still what the data determine
}

// The sum and its interval do not depend on the value that is fixed.
TEST(PowerLaw, TheSumOfExponentsIsTheSameWhateverIsFixed) {
  PowerLawProblem problem = grid({0.15});
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (double& y : problem.observed) y *= 1 + 0.03 * normal(random);
  set_relative_u(problem, 0.03);
  const PowerLawFit free = fit_power_law(problem);
  problem.fixed["B3"] = 7;
  const PowerLawFit fixed = fit_power_law(problem);
  ASSERT_EQ(free.combinations.size(), 2u);
  ASSERT_EQ(fixed.combinations.size(), 2u);
  for (int i : {0, 1}) {
    EXPECT_EQ(free.combinations[i].name, fixed.combinations[i].name);
    EXPECT_NEAR(free.combinations[i].value, fixed.combinations[i].value, 1e-8);
    EXPECT_NEAR(free.combinations[i].low95, fixed.combinations[i].low95, 1e-8);
  }
}

TEST(PowerLaw, AFixedFactorTellsTheExponentsOfOneMaterialApart) {
  PowerLawProblem problem = grid({0.15});
  problem.fixed["B0"] = kFactor;
  const PowerLawFit fit = fit_power_law(problem);
  EXPECT_TRUE(fit.identifiable());
  EXPECT_NEAR(value(fit, "B2"), kCohesion, 1e-9);
  EXPECT_NEAR(value(fit, "B3"), kFroude, 1e-9);
}

// A group that is the square of another, halved: its exponent counts twice in the combination.
TEST(PowerLaw, AnAliasEntersWithItsWeight) {
  PowerLawProblem problem = grid({0.15});
  problem.log_groups.col(2) = 2 * problem.log_groups.col(0).array() - std::log(2.0);
  const PowerLawFit fit = fit_power_law(problem);
  EXPECT_NEAR(value(fit, "B1+2*B3"), kFill, 1e-10);
  EXPECT_NEAR(value(fit, "B2"), kCohesion + kFroude, 1e-10);  // N_C stands for Fr_M here
}

// Straight line through (x, ln y) by hand, x = ln g = 0, 1, 2, 3, ln y = 1.0, 1.4, 2.1, 2.3: mean x 1.5, mean ln y 1.7,
// Sxx 5, Sxy 2.3; slope 0.46, intercept 1.01; residuals -0.01, -0.07, 0.17, -0.09, sum of squares 0.042; s^2 = 0.021;
// standard error of the slope sqrt(0.021/5); t(2) = 4.3027.
TEST(PowerLaw, LogErrorsGiveTheStraightLineOfTheLogarithms) {
  PowerLawProblem problem;
  problem.names = {"B1"};
  problem.log_groups = Eigen::Vector4d(0, 1, 2, 3);
  problem.observed = Eigen::Vector4d(1.0, 1.4, 2.1, 2.3).array().exp();
  problem.objective = Objective::log;
  const PowerLawFit fit = fit_power_law(problem);
  EXPECT_NEAR(value(fit, "B1"), 0.46, 1e-12);
  EXPECT_NEAR(std::log(value(fit, "B0")), 1.01, 1e-12);
  EXPECT_EQ(fit.interval_basis, IntervalBasis::scatter);
  const double error = std::sqrt(0.021 / 5);
  EXPECT_NEAR(fit.coefficients[1].standard_error, error, 1e-12);
  EXPECT_NEAR(fit.coefficients[1].high95, 0.46 + 4.3027 * error, 5e-5 * error);
  const double intercept_error = std::sqrt(0.021 * (1.0 / 4 + 1.5 * 1.5 / 5));
  EXPECT_NEAR(std::log(fit.coefficients[0].low95), 1.01 - 4.3027 * intercept_error, 5e-5 * intercept_error);
  // Leave-one-out of a linear fit: residual/(1 - leverage), leverage 1/4 + (x - 1.5)^2/5.
  EXPECT_NEAR(std::log(fit.leave_one_out[2]), 2.1 - 0.17 / (1 - 0.25 - 0.05), 1e-10);
  EXPECT_NEAR(std::log(fit.leave_one_out[3]), 2.3 + 0.09 / (1 - 0.25 - 0.45), 1e-10);
}

// Without groups the equation is a constant; two rows with covariance v: best B0 = 1'V^-1 y / 1'V^-1 1, here
// V = [1 0.5; 0.5 4]: weights (4 - 0.5, 1 - 0.5)/(5 - 1) = 0.875, 0.125, variance (4 - 0.25)/(5 - 1).
TEST(PowerLaw, CorrelatedRowsOfAConstantHaveTheirGeneralisedMean) {
  PowerLawProblem problem;
  problem.log_groups.resize(2, 0);
  problem.observed = Eigen::Vector2d(10, 11);
  Eigen::Matrix2d v;
  v << 1, 0.5, 0.5, 4;
  problem.covariance = v.sparseView();
  const PowerLawFit fit = fit_power_law(problem);
  const double mean = 0.875 * 10 + 0.125 * 11;
  EXPECT_NEAR(value(fit, "B0"), mean, 1e-10);
  EXPECT_EQ(fit.interval_basis, IntervalBasis::u);
  EXPECT_NEAR(fit.standard_error_from_u[0], std::sqrt(3.75 / 4) / mean, 1e-10);  // of ln B0
  // chi2 = d^2 / (variance of the difference) = 1/(1 + 4 - 1)
  EXPECT_NEAR(fit.chi2, 0.25, 1e-10);
}

// sum (1 - f/y)^2 is smallest at f = sum 1/y / sum 1/y^2; for y = 1, 2, 4: (7/4)/(21/16) = 4/3.
TEST(PowerLaw, RelativeErrorsOfAConstantHaveTheirClosedForm) {
  PowerLawProblem problem;
  problem.log_groups.resize(3, 0);
  problem.observed = Eigen::Vector3d(1, 2, 4);
  problem.objective = Objective::relative;
  EXPECT_NEAR(value(fit_power_law(problem), "B0"), 4.0 / 3, 1e-10);
}

// A constant explains nothing of the variance: R2 = 0, adjusted 0; y = 1, 2, 3, 6 about their mean 3: RMSE sqrt(14/4),
// relative errors 2, 1/2, 0, 1/2.
TEST(PowerLaw, StatisticsOfAConstantAreThoseOfTheMean) {
  PowerLawProblem problem;
  problem.log_groups.resize(4, 0);
  problem.observed = Eigen::Vector4d(1, 2, 3, 6);
  const PowerLawFit fit = fit_power_law(problem);
  EXPECT_NEAR(value(fit, "B0"), 3, 1e-10);
  EXPECT_NEAR(fit.r2, 0, 1e-10);
  EXPECT_NEAR(fit.adjusted_r2, 0, 1e-10);
  EXPECT_NEAR(fit.rmse, std::sqrt(14.0 / 4), 1e-10);
  EXPECT_NEAR(fit.errors.mean, 0.75, 1e-10);
  EXPECT_NEAR(fit.errors.maximum, 2, 1e-10);
  EXPECT_NEAR(fit.errors.root_mean_square, std::sqrt(4.5 / 4), 1e-10);
  // One step in ln B0: residual 3 over 1 - 1/4, times the row's share 1/4 of the mean, over the mean.
  EXPECT_NEAR(fit.leave_one_out[3], 3 * std::exp(-1.0 / 3), 1e-9);
}

PowerLawProblem noisy(double relative, unsigned seed, bool correlated) {
  PowerLawProblem problem = grid({0.15, 0.30});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double common = normal(random);
  const Eigen::VectorXd truth = problem.observed;
  for (double& y : problem.observed) y *= 1 + relative * (normal(random) + (correlated ? common : 0));
  Eigen::MatrixXd v = Eigen::VectorXd((relative * truth).cwiseAbs2()).asDiagonal();
  if (correlated) v += relative * relative * truth * truth.transpose();
  problem.covariance = v.sparseView();
  return problem;
}

// The one Gauss-Newton step against refitting without the row. Its error is of second order in the change of the
// coefficients: 32 rows of 3 % noise change ln f by about 1 %, so the step is off by about 1e-4.
TEST(PowerLaw, LeaveOneOutAgreesWithFittingWithoutTheRow) {
  for (const bool correlated : {false, true}) {
    const PowerLawProblem problem = noisy(0.03, 3, correlated);
    const PowerLawFit fit = fit_power_law(problem);
    const Eigen::Index n = problem.observed.size();
    const Eigen::MatrixXd v = problem.covariance;
    for (const Eigen::Index left_out : {0, 5, 31}) {
      std::vector<Eigen::Index> rest;
      for (Eigen::Index i = 0; i < n; ++i)
        if (i != left_out) rest.push_back(i);
      PowerLawProblem without = problem;
      without.observed = Eigen::VectorXd(problem.observed(rest));
      without.log_groups = Eigen::MatrixXd(problem.log_groups(rest, Eigen::all));
      without.covariance = Eigen::MatrixXd(v(rest, rest)).sparseView();
      const Eigen::VectorXd b = fit_power_law(without).parameters;
      const double expected = std::exp(b[0] + problem.log_groups.row(left_out).dot(b.tail(3)));
      EXPECT_NEAR(fit.leave_one_out[left_out] / expected, 1, 2e-4) << left_out;
      EXPECT_GT(std::fabs(expected / fit.fitted[left_out] - 1), 4e-4);  // leaving it out does change the equation
    }
  }
}

// Share of the trials in which the interval holds the true coefficient, expected 95 %. With 1000 trials the binomial
// standard deviation is 0.69 %; 3.5 of those either way. With u the basis turns to the wider scatter in 5 % of the
// trials, which adds at most half a per cent.
void expect_coverage(IntervalBasis basis, bool correlated, bool with_u) {
  constexpr int kTrials = 1000;
  const std::map<std::string, double> truth = {{"B0", kFactor}, {"B1", kFill}, {"B2", kCohesion}, {"B3", kFroude}};
  std::map<std::string, int> inside;
  int on_basis = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    PowerLawProblem problem = noisy(0.05, 100 + trial, correlated);
    if (!with_u) {
      problem.covariance.resize(0, 0);
      problem.objective = Objective::log;  // equal weights suit relative noise
    }
    const PowerLawFit fit = fit_power_law(problem);
    on_basis += fit.interval_basis == basis;
    for (const vielto::Coefficient& c : fit.coefficients)
      inside[c.name] += c.low95 <= truth.at(c.name) && truth.at(c.name) <= c.high95;
  }
  EXPECT_GT(on_basis, 0.9 * kTrials);
  for (const auto& [name, count] : inside) EXPECT_NEAR(count / double(kTrials), 0.95, 3.5 * 0.0069 + 0.003) << name;
}

TEST(PowerLawCoverage, IntervalsFromStatedUncertaintiesHoldTheTruth) { expect_coverage(IntervalBasis::u, false, true); }
TEST(PowerLawCoverage, IntervalsFromACovarianceHoldTheTruth) { expect_coverage(IntervalBasis::u, true, true); }
TEST(PowerLawCoverage, IntervalsFromTheScatterHoldTheTruth) { expect_coverage(IntervalBasis::scatter, false, false); }

// u stated three times too small: chi2 is nine times too large, the intervals must not follow u.
TEST(PowerLaw, UncertaintiesThatTheScatterRefutesDoNotMakeTheIntervals) {
  PowerLawProblem problem = noisy(0.06, 7, false);
  problem.covariance /= 9;
  const PowerLawFit fit = fit_power_law(problem);
  EXPECT_EQ(fit.interval_basis, IntervalBasis::scatter);
  EXPECT_LT(fit.chi2_exceedance, 0.05);
  EXPECT_NEAR(fit.coefficients[1].standard_error / fit.standard_error_from_u[1],
              std::sqrt(fit.chi2 / fit.degrees_of_freedom), 1e-9);
}

TEST(PowerLaw, RefusesWhatCannotBeFitted) {
  PowerLawProblem problem = grid({0.15});
  problem.observed[3] = 0;
  EXPECT_THROW(fit_power_law(problem), std::invalid_argument);
  problem = grid({0.15});
  problem.fixed["B5"] = 1;
  EXPECT_THROW(fit_power_law(problem), std::invalid_argument);
  problem = grid({0.15});
  problem.observed.conservativeResize(3);
  problem.log_groups.conservativeResize(3, 3);
  EXPECT_THROW(fit_power_law(problem), std::invalid_argument);
}

}  // namespace

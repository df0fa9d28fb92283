// SPDX-License-Identifier: GPL-2.0-or-later
// Distributions and weights of the regression against tables and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/statistics.h"
#include "equation/weights.h"

namespace {

using vielto::Weights;

// Printed tables of Student's t and chi-squared: 3 decimals.
TEST(Distributions, StudentsQuantileAgreesWithPrintedTable) {
  EXPECT_NEAR(vielto::t975(1), 12.706, 5e-4);
  EXPECT_NEAR(vielto::t975(10), 2.228, 5e-4);
  EXPECT_NEAR(vielto::t975(120), 1.980, 5e-4);
}

TEST(Distributions, ChiSquaredExceedanceAgreesWithPrintedTable) {
  EXPECT_NEAR(vielto::chi2_exceedance(18.307, 10), 0.05, 5e-6);
  EXPECT_NEAR(vielto::chi2_exceedance(6.635, 1), 0.01, 5e-6);
}

// One deviate: E|z| = sqrt(2/pi). Two: E max(|a|, |b|) = E(|a+b| + |a-b|)/2 = 2/sqrt(pi), since a+b and a-b are normal
// with variance 2. The integral is exact to rounding.
TEST(Distributions, LargestOfFewNormalDeviatesHasItsClosedForm) {
  EXPECT_NEAR(vielto::expected_largest_magnitude(1), std::sqrt(2 / M_PI), 1e-12);
  EXPECT_NEAR(vielto::expected_largest_magnitude(2), 2 / std::sqrt(M_PI), 1e-12);
}

// 20000 draws of 16 deviates: the mean of the maxima (deviation about 0.45) is known to 0.003; 4 of those allowed.
TEST(Distributions, LargestOfSixteenNormalDeviatesAgreesWithDraws) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double mean = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    double largest = 0;
    for (int k = 0; k < 16; ++k) largest = std::max(largest, std::fabs(normal(random)));
    mean += largest / kDraws;
  }
  EXPECT_NEAR(vielto::expected_largest_magnitude(16), mean, 4 * 0.45 / std::sqrt(kDraws));
}

Eigen::SparseMatrix<double> covariance(double a, double b, double rho) {
  Eigen::Matrix2d v;
  v << a * a, rho * a * b, rho * a * b, b * b;
  return v.sparseView();
}

// V^-1 of two rows: 1/(1 - rho^2) [1/a^2, -rho/(ab); -rho/(ab), 1/b^2]. Exact to rounding.
TEST(Weights, WhitenedSquareIsTheGeneralisedOne) {
  const double a = 2, b = 0.5, rho = 0.6;
  const Weights weights = Weights::correlated(covariance(a, b, rho));
  const Eigen::Vector2d r(3, -1);
  const double expected = (9 / (a * a) + 1 / (b * b) + 2 * rho * 3 / (a * b)) / (1 - rho * rho);
  EXPECT_NEAR(weights.whiten(r).squaredNorm(), expected, 1e-12 * expected);
  EXPECT_NEAR(r.dot(Eigen::Vector2d(weights.precision_times(r))), expected, 1e-12 * expected);
  EXPECT_NEAR(weights.precision_diagonal()[0], 1 / (a * a * (1 - rho * rho)), 1e-12);
  EXPECT_NEAR(weights.precision_diagonal()[1], 1 / (b * b * (1 - rho * rho)), 1e-12);
}

TEST(Weights, IndependentRowsAreDividedByTheirUncertainty) {
  const Weights weights = Weights::independent(Eigen::Vector2d(2, 0.5));
  EXPECT_EQ(Eigen::VectorXd(weights.whiten(Eigen::Vector2d(3, -1))), Eigen::Vector2d(1.5, -2));
  EXPECT_EQ(weights.precision_diagonal(), Eigen::Vector2d(0.25, 4));
}

TEST(Weights, ScalingTheRowsScalesTheirCovariance) {
  const Weights scaled = Weights::correlated(covariance(2, 0.5, 0.6)).scaled(Eigen::Vector2d(10, 3));
  const Weights direct = Weights::correlated(covariance(20, 1.5, 0.6));
  const Eigen::Vector2d r(3, -1);
  EXPECT_NEAR((scaled.whiten(r) - direct.whiten(r)).norm(), 0, 1e-12);
}

TEST(Weights, FullyCorrelatedRowsAreRefused) {
  EXPECT_THROW(Weights::correlated(covariance(2, 0.5, 1)), std::invalid_argument);
  EXPECT_THROW(Weights::correlated(covariance(0.7, 0.7, 1)), std::invalid_argument);
}

// Three rows, each pair correlated by -0.6: the variance of their sum would be 3 - 6*0.6 < 0.
TEST(Weights, ContradictingCorrelationsAreRefused) {
  Eigen::Matrix3d v = Eigen::Matrix3d::Constant(-0.6);
  v.diagonal().setOnes();
  EXPECT_THROW(Weights::correlated(Eigen::SparseMatrix<double>(v.sparseView())), std::invalid_argument);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// Correlated errors of a fitted equation on the thesis' grid.
#include "equation/equation_covariance.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Grid {
  VectorXd l = VectorXd(16), n = VectorXd(16);
  Grid() {
    const double fills[] = {0.10, 0.15, 0.20, 0.25}, speeds[] = {0.48, 0.85, 1.21, 1.58};
    for (int i = 0; i < 16; ++i) l[i] = fills[i / 4], n[i] = speeds[i % 4];
  }
};

TEST(EquationCovariance, IsACorrelationWithAlikeNeighbours) {
  const Grid g;
  const MatrixXd r = vielto::equation_error_correlation(g.l, g.n);
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(r(i, i), 1, 1e-12);
  EXPECT_TRUE(r.isApprox(r.transpose(), 1e-12));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(r).eigenvalues()[0], 1e-6);  // a covariance can be inverted
  // Along the speeds of a fill neighbours err alike on the average, points two steps apart less so. Not every pair
  // does: a smooth error without its straight line changes sign along the way.
  double next = 0, second = 0;
  for (int i = 0; i < 16; ++i) {
    if (i % 4 < 3) next += r(i, i + 1) / 12;
    if (i % 4 < 2) second += r(i, i + 2) / 8;
  }
  EXPECT_GT(next, 0);
  EXPECT_GT(next, second);
}

// On a 2 x 2 grid three coefficients leave one direction, (1, -1, -1, 1)/2: H + k M K M with trace(M) = 1 is the unit
// matrix.
TEST(EquationCovariance, TwoByTwoByHand) {
  VectorXd l(4), n(4);
  l << 0.1, 0.1, 0.2, 0.2;
  n << 0.5, 1.5, 0.5, 1.5;
  EXPECT_TRUE(vielto::equation_error_correlation(l, n).isApprox(MatrixXd::Identity(4, 4), 1e-9));
}

TEST(EquationCovariance, RefusesPointsThatFixNoEquation) {
  EXPECT_THROW(vielto::equation_error_correlation(VectorXd::Constant(5, 0.1), VectorXd::LinSpaced(5, 0.5, 1.5)),
               std::invalid_argument);
  EXPECT_THROW(vielto::equation_error_correlation(VectorXd::LinSpaced(3, 0.1, 0.2), VectorXd::LinSpaced(3, 0.5, 1.5)),
               std::invalid_argument);
}

}  // namespace

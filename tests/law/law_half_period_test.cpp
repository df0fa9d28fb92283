// SPDX-License-Identifier: GPL-2.0-or-later
/* The shortest half period of a contact against the generalized eigenvalue problem of its two bodies, formed here from
   the springs' geometry: energies E = 1/2 q'Kq and T = 1/2 q'Mq in the twelve displacements q = (x1, a1, x2, a2) with
   rotations a. */
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "vielto_law.h"

namespace {

typedef Eigen::Matrix<double, 12, 12> Matrix;
typedef Eigen::Matrix<double, 1, 12> Row;
typedef Eigen::Vector3d V;

struct Body {
  double R, m;
};

const double kPi = std::acos(-1.0);
const double kInfinity = std::numeric_limits<double>::infinity();

// Material with everything on; rolling and twisting factors are varied.
vielto::Material material(double E, double nu, double betaKr, double betaKtw) {
  return {E, nu, 0.4, 0.0, 0.0, betaKr, betaKtw, 0.1, 0.1};
}

double harmonic(double a, double b) { return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0; }

// Largest eigenfrequency, from springs along n (normal, twisting) and along the two tangents (sliding, rolling).
double half_period(const vielto::Material& a, const vielto::Material& b, double cn, Body one, Body two, bool wall) {
  const double k1 = 2 * a.youngsModulus * one.R, k2 = 2 * b.youngsModulus * two.R;
  const double kn = harmonic(k1, k2), ks = harmonic(k1 * a.stiffnessRatio, k2 * b.stiffnessRatio);
  const double kr = harmonic(a.rollingStiffnessFactor, b.rollingStiffnessFactor) * kn * one.R * two.R;
  const double ktw = harmonic(a.twistingStiffnessFactor, b.twistingStiffnessFactor) * ks * one.R * two.R;
  const V axes[3] = {V(1, 0, 0), V(0, 1, 0), V(0, 0, 1)}, n = axes[2];
  Matrix K = Matrix::Zero(), M = Matrix::Zero();
  for (const V& e : axes) {
    // stretch of the contact point along e: x1 - x2 + a1 x (-R1 n) - a2 x (R2 n), by components
    Row stretch = Row::Zero(), turn = Row::Zero();
    for (int d = 0; d < 3; d++) {
      stretch[d] = e[d];
      stretch[6 + d] = -e[d];
      stretch[3 + d] = axes[d].cross(-one.R * n).dot(e);
      stretch[9 + d] = -axes[d].cross(two.R * n).dot(e);
      turn[3 + d] = e[d];
      turn[9 + d] = -e[d];
    }
    const bool along = e == n;
    K += (along ? cn * kn : ks) * stretch.transpose() * stretch;
    K += (along ? ktw : kr) * turn.transpose() * turn;
  }
  for (int d = 0; d < 3; d++) {
    M(d, d) = one.m;
    M(3 + d, 3 + d) = 0.4 * one.m * one.R * one.R;
    M(6 + d, 6 + d) = two.m;
    M(9 + d, 9 + d) = 0.4 * two.m * two.R * two.R;
  }
  // a wall's motion is given: only body 1 has degrees of freedom
  const int n_dof = wall ? 6 : 12;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K.topLeftCorner(n_dof, n_dof),
                                                                        M.topLeftCorner(n_dof, n_dof));
  return kPi / std::sqrt(modes.eigenvalues().maxCoeff());
}

// Tolerance: round-off of the eigenvalue solver, a few 1e-15 times 12.
const double kRounding = 1e-12;

struct Case {
  double betaKr, betaKtw, cn;
};

class HalfPeriod : public testing::TestWithParam<Case> {};

TEST_P(HalfPeriod, OfTwoUnequalSpheresIsThatOfTheStiffestMode) {
  const auto [betaKr, betaKtw, cn] = GetParam();
  const vielto::Material a = material(1e6, 0.5, betaKr, betaKtw), b = material(3e6, 0.8, 1.5 * betaKr, betaKtw);
  const Body one = {0.003, 2e-4}, two = {0.005, 7e-4};
  const double expected = half_period(a, b, cn, one, two, false);
  EXPECT_NEAR(vielto::shortest_half_period(vielto::mix(a, b), cn, one.R, one.m, two.R, two.m) / expected, 1, kRounding);
  EXPECT_NEAR(vielto::shortest_half_period(vielto::mix(b, a), cn, two.R, two.m, one.R, one.m) / expected, 1, kRounding);
}

TEST_P(HalfPeriod, OfASphereOnAWallIsThatOfTheStiffestMode) {
  const auto [betaKr, betaKtw, cn] = GetParam();
  const vielto::Material a = material(1e6, 0.5, betaKr, betaKtw), b = material(3e6, 0.8, 1.5 * betaKr, betaKtw);
  const Body one = {0.003, 2e-4};
  for (const double factor : {1.0, 2.0, 10.0}) {
    const double expected = half_period(a, b, cn, one, {factor * one.R, 1.0}, true);
    EXPECT_NEAR(vielto::shortest_half_period(vielto::mix(a, b), cn, one.R, one.m, factor * one.R, kInfinity) / expected,
                1, kRounding);
  }
}

// Either of normal, sliding-rolling and twisting is the stiffest in some case.
INSTANTIATE_TEST_SUITE_P(Modes, HalfPeriod,
                         testing::Values(Case{0, 0, 4}, Case{0, 0, 1}, Case{0.5, 0.5, 4}, Case{2, 0, 1}, Case{0, 3, 1},
                                         Case{0.1, 0.1, 1}, Case{10, 0.1, 4}, Case{0.1, 30, 4}));

}  // namespace

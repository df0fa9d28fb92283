// SPDX-License-Identifier: GPL-2.0-or-later
// Every formula, mixing rule and cap of the contact law against numbers worked by hand, with unequal bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vielto_law.h"

namespace {

using vielto::Vec;

const double kRounding = 1e-14;  // relative: a few roundings of double precision
const double kInfinity = std::numeric_limits<double>::infinity();
const double kPi = std::acos(-1.0);

void expect_relative(double value, double expected, double relative = kRounding) {
  EXPECT_NEAR(value, expected, relative * std::fabs(expected));
}

void expect_vec(const Vec& v, double x, double y, double z, double tolerance) {
  EXPECT_NEAR(v.x, x, tolerance);
  EXPECT_NEAR(v.y, y, tolerance);
  EXPECT_NEAR(v.z, z, tolerance);
}

// Round numbers. R1 = 3 mm, R2 = 6 mm: k_1 = 2 * 1e6 * 0.003 = 6000, k_2 = 2 * 2e6 * 0.006 = 24000 N/m.
const vielto::Material kOne = {1e6, 0.5, 0.3, 0.2, 0.1, 0.4, 0.0, 0.05, 0.30};
const vielto::Material kTwo = {2e6, 0.25, 0.5, 0.4, 0.5, 0.1, 0.7, 0.20, 0.10};
const double kR1 = 0.003, kR2 = 0.006;

TEST(LawMixing, DampingAndFrictionAngleAreMeans) {
  const vielto::Pair p = vielto::mix(kOne, kTwo);
  expect_relative(p.betaN, 0.3);
  expect_relative(p.betaS, 0.3);
  expect_relative(p.tanPhi, std::tan(0.4));  // mean of the angles, not of their tangents
}

TEST(LawMixing, ResistancesAreMinima) {
  const vielto::Pair p = vielto::mix(kOne, kTwo);
  expect_relative(p.muR, 0.05);
  expect_relative(p.muTwTanPhi, 0.10 * std::tan(0.4));
}

TEST(LawMixing, MomentFactorsAreHarmonicMeansAndZeroIfOneIsZero) {
  const vielto::Pair p = vielto::mix(kOne, kTwo);
  expect_relative(p.betaKr, 2 * 0.4 * 0.1 / 0.5);  // 0.16
  EXPECT_EQ(p.betaKtw, 0.0);
  EXPECT_EQ(vielto::mix(kTwo, kOne).betaKtw, 0.0);
  EXPECT_EQ(vielto::harmonic_mean_or_zero(0, 0), 0.0);
}

TEST(LawMixing, OrderOfTheBodiesDoesNotMatter) {
  const vielto::Pair p = vielto::mix(kOne, kTwo), q = vielto::mix(kTwo, kOne);
  const vielto::Stiffness s = vielto::stiffness(p, kR1, kR2, 1e-4), t = vielto::stiffness(q, kR2, kR1, 1e-4);
  expect_relative(s.kn, t.kn);
  expect_relative(s.ks, t.ks);
  expect_relative(s.gammaN, t.gammaN);
  expect_relative(s.gammaS, t.gammaS);
}

TEST(LawStiffness, NormalIsTheHarmonicMeanOfTheBodyStiffnesses) {
  // 2 * 6000 * 24000 / 30000 = 9600; printed form 4 E1R1E2R2/(E1R1+E2R2) = 4 * 3000 * 12000 / 15000 = 9600 N/m.
  expect_relative(vielto::stiffness(vielto::mix(kOne, kTwo), kR1, kR2, 1e-4).kn, 9600);
}

TEST(LawStiffness, TangentialIsTheHarmonicMeanOfTheBodyStiffnessesTimesTheirRatios) {
  // k_1 nu_1 = 3000, k_2 nu_2 = 6000: 2 * 3000 * 6000 / 9000 = 4000 N/m; not a ratio times k_n.
  expect_relative(vielto::stiffness(vielto::mix(kOne, kTwo), kR1, kR2, 1e-4).ks, 4000);
  // equal ratios 0.5 and E = 1e6: k_n = 2 * 6000 * 12000 / 18000 = 8000, k_s half of it
  expect_relative(vielto::stiffness(vielto::mix(kOne, kOne), kR1, kR2, 1e-4).ks, 4000);
}

TEST(LawStiffness, DashpotsAreTwiceTheRootTimesTheRatio) {
  const double mass = 1e-4;
  const vielto::Stiffness s = vielto::stiffness(vielto::mix(kOne, kTwo), kR1, kR2, mass);
  expect_relative(s.gammaN, 2 * std::sqrt(0.96) * 0.3);
  expect_relative(s.gammaS, 2 * std::sqrt(0.40) * 0.3);
  const vielto::Stiffness equal = vielto::stiffness(vielto::mix(kOne, kOne), kR1, kR2, mass);
  expect_relative(equal.gammaS, 2 * std::sqrt(0.40) * 0.1);
}

TEST(LawNormalForce, IsSpringTimesFactorLessDashpot) {
  const vielto::Stiffness s = {9600, 4000, 0.6, 0.4};
  // overlap 1e-5 m: 4 * 9600 * 1e-5 = 0.384 N; parting at 0.2 m/s: less 0.12 N
  expect_relative(vielto::normal_force(4, s, 1e-5, 0.2), 0.264);
  expect_relative(vielto::normal_force(1, s, 1e-5, 0.2), -0.024);  // the dashpot may attract
  expect_relative(vielto::normal_force(1, s, 1e-5, -0.2), 0.216);
}

TEST(LawCap, ShortensToTheLimitAndKeepsTheDirection) {
  Vec v = {3, 4, 0};
  EXPECT_FALSE(vielto::cap(v, 5.0));
  expect_vec(v, 3, 4, 0, 0);
  EXPECT_TRUE(vielto::cap(v, 2.5));
  expect_vec(v, 1.5, 2, 0, 1e-15);
  EXPECT_TRUE(vielto::cap(v, 0.0));  // no load, no friction
  expect_vec(v, 0, 0, 0, 0);
  EXPECT_FALSE(vielto::cap(v, 0.0));
}

TEST(LawTangentialSpring, GrowsByStiffnessTimesSlipAgainstTheSlip) {
  const vielto::Stiffness s = {9600, 4000, 0, 0};
  bool sliding = true;
  // 4000 N/m * 1e-5 s * (0.3, 0, -0.4) m/s = (0.012, 0, -0.016) N
  const Vec f = vielto::tangential_spring(s, {0.1, 0, 0}, {0.3, 0, -0.4}, 1e-5, 1.0, sliding);
  expect_vec(f, 0.088, 0, 0.016, 1e-16);
  EXPECT_FALSE(sliding);
}

TEST(LawTangentialSpring, IsCutAtTheSlidingLimit) {
  const vielto::Stiffness s = {9600, 4000, 0, 0};
  bool sliding = false;
  const Vec f = vielto::tangential_spring(s, {0, 0, 0}, {0.3, 0, -0.4}, 1e-5, 0.01, sliding);
  EXPECT_TRUE(sliding);  // 0.02 N wanted
  expect_vec(f, -0.006, 0, 0.008, 1e-16);
}

TEST(LawMoments, StiffnessesAndLengthByHand) {
  const vielto::Pair p = vielto::mix(kOne, kTwo);
  expect_relative(vielto::rolling_length(kR1, kR2), 0.004);                      // 2 * 18 / 9 mm
  expect_relative(vielto::rolling_stiffness(p, 9600, kR1, kR2), 0.16 * 0.1728);  // 9600 * 1.8e-5 = 0.1728 N m
  EXPECT_EQ(vielto::twisting_stiffness(p, 4000, kR1, kR2), 0.0);                 // one body has no factor
  expect_relative(vielto::twisting_stiffness(vielto::mix(kTwo, kTwo), 4000, kR1, kR2), 0.7 * 0.072);
}

TEST(LawMoments, WallOfTwiceTheRadiusHasLengthFourThirds) {
  expect_relative(vielto::rolling_length(kR1, 2 * kR1), 4.0 / 3.0 * kR1);
}

TEST(LawMoments, RollingSpringGrowsAndIsCut) {
  bool rolling = true;
  Vec m = vielto::rolling_spring(0.02, {0, 1e-6, 0}, {3, 0, 0}, 1e-5, 1e-3, rolling);
  EXPECT_FALSE(rolling);
  expect_vec(m, -6e-7, 1e-6, 0, 1e-20);
  m = vielto::rolling_spring(0.02, m, {0, 0, 0}, 1e-5, 0.0, rolling);
  EXPECT_TRUE(rolling);
  expect_vec(m, 0, 0, 0, 0);
}

TEST(LawMoments, TwistingSpringGrowsAndIsCutInEitherDirection) {
  bool twisting = true;
  expect_relative(vielto::twisting_spring(0.05, 3e-6, 2.0, 1e-5, 1e-3, twisting), 2e-6);
  EXPECT_FALSE(twisting);
  expect_relative(vielto::twisting_spring(0.05, 0, 2.0, 1e-5, 4e-7, twisting), -4e-7);
  EXPECT_TRUE(twisting);
  expect_relative(vielto::twisting_spring(0.05, 0, -2.0, 1e-5, 4e-7, twisting), 4e-7);
  EXPECT_TRUE(twisting);
}

// A spring that only stores: the work of a closed cycle of stretching and release is zero, and so is each step's loss.
TEST(LawLoss, StickingSpringLosesNothing) {
  const vielto::Stiffness s = {9600, 4000, 0, 0};
  const double dt = 1e-5;
  Vec f = {0, 0, 0};
  for (int step = 0; step < 1000; step++) {
    const double t = step * 0.0314;
    const Vec slip = {0.1 * std::cos(t), 0.03 * std::sin(2 * t), 0};
    bool sliding;
    const Vec now = vielto::tangential_spring(s, f, slip, dt, 1e9, sliding);
    // round-off of a difference of squares of forces up to 0.13 N over 4000 N/m
    EXPECT_NEAR(vielto::capped_spring_loss(f, now, slip, dt, s.ks), 0.0, 1e-20);
    f = now;
  }
}

TEST(LawLoss, SteadySlidingLosesLimitTimesSlip) {
  const vielto::Stiffness s = {9600, 4000, 0, 0};
  const double dt = 1e-5, limit = 0.05, slip = 0.8;
  bool sliding;
  const Vec old = {-limit, 0, 0}, rate = {slip, 0, 0};
  const Vec now = vielto::tangential_spring(s, old, rate, dt, limit, sliding);
  expect_relative(vielto::capped_spring_loss(old, now, rate, dt, s.ks), limit * slip * dt);
  expect_relative(vielto::capped_spring_loss(-limit, -limit, slip, dt, 0.02), limit * slip * dt);
}

TEST(LawLoss, FallingLimitLosesTheStoredEnergy) {
  // the load vanishes at rest: 0.5 F^2/k_s = 0.5 * 0.0025 / 4000
  expect_relative(vielto::capped_spring_loss(Vec{0.05, 0, 0}, Vec{0, 0, 0}, Vec{0, 0, 0}, 1e-5, 4000),
                  0.5 * 0.0025 / 4000);
}

// The same of a twisting moment, by hand: work -1/2 dt (M + M') w = 5e-6 * 0.05 * 3 = 7.5e-7 J; stored energy falls
// from 0.04^2/(2 k) to 0.01^2/(2 k), k = 200 N m: by 0.0015/400 = 3.75e-6 J. And a moment that only grows loses
// nothing.
TEST(LawLoss, OfAMomentIsItsWorkLessWhatItStores) {
  expect_relative(vielto::capped_spring_loss(-0.04, -0.01, 3.0, 1e-5, 200.0), 7.5e-7 + 3.75e-6);
  expect_relative(vielto::capped_spring_loss(-0.01, -0.04, 3.0, 1e-5, 200.0), 7.5e-7 - 3.75e-6);
  bool twisting;
  const double ktw = 0.05, old = 3e-4, rate = -40, dt = 1e-5;
  const double now = vielto::twisting_spring(ktw, old, rate, dt, 1.0, twisting);
  EXPECT_NEAR(vielto::capped_spring_loss(old, now, rate, dt, ktw), 0, 1e-14 * 0.5 * now * now / ktw);
}

TEST(LawLoss, WithoutSpringThereIsNone) {
  EXPECT_EQ(vielto::capped_spring_loss(1.0, 0.0, 3.0, 1e-5, 0.0), 0.0);
  EXPECT_EQ(vielto::capped_spring_loss(Vec{1, 0, 0}, Vec{0, 0, 0}, Vec{3, 0, 0}, 1e-5, 0.0), 0.0);
}

TEST(LawContactTime, IsHalfThePeriodOfTheNormalOscillator) {
  // sqrt(1e-4 / (4 * 2500)) = 1e-4 s
  expect_relative(vielto::normal_contact_time(4, 2500, 1e-4), kPi * 1e-4);
  expect_relative(vielto::normal_contact_time(1, 2500, 1e-4), kPi * 2e-4);
}

// Similarity of the law itself: twice the radii (8 times the mass) at equal strain u/R and equal velocities.
TEST(LawSimilarity, ForceGrowsWithTheSquareAndMomentWithTheCubeOfTheRadius) {
  const vielto::Pair p = vielto::mix(kOne, kTwo), q = vielto::mix(kTwo, kTwo);
  const vielto::Stiffness small = vielto::stiffness(p, kR1, kR2, 1e-4),
                          large = vielto::stiffness(p, 2 * kR1, 2 * kR2, 8e-4);
  expect_relative(vielto::normal_force(4, large, 2e-5, -0.3), 4 * vielto::normal_force(4, small, 1e-5, -0.3));
  expect_relative(large.gammaS, 4 * small.gammaS);
  // angles are equal: spins halve, times double
  expect_relative(vielto::rolling_stiffness(q, large.kn, 2 * kR1, 2 * kR2),
                  8 * vielto::rolling_stiffness(q, small.kn, kR1, kR2));
  expect_relative(vielto::twisting_stiffness(q, large.ks, 2 * kR1, 2 * kR2),
                  8 * vielto::twisting_stiffness(q, small.ks, kR1, kR2));
  expect_relative(vielto::rolling_length(2 * kR1, 2 * kR2) * 4, 8 * vielto::rolling_length(kR1, kR2));
}

TEST(LawWall, InfinitePartnerOfTheHalfPeriodIsAWall) {
  // normal mode only: k_r and k_tw off, small k_s; k_n = 4 E R 2R / (3R) = 8/3 * 1e6 * 0.003 = 8000 N/m, m = 1e-4 kg
  vielto::Material m = kOne;
  m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  m.stiffnessRatio = 0.01;
  expect_relative(vielto::shortest_half_period(vielto::mix(m, m), 4, kR1, 1e-4, 2 * kR1, kInfinity),
                  kPi * std::sqrt(1e-4 / 32000));
}

}  // namespace

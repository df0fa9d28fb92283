// SPDX-License-Identifier: GPL-2.0-or-later
// The whole shaft from a slice, against sums worked by hand. With one paddle feeling a + b cos(theta), 22 paddles 90
// degrees apart stand 6, 6, 5 and 5 at 0, 90, 180 and 270 degrees, so that
//   sum_i cos(phi + i 90) = cos(phi) - sin(phi) = sqrt(2) cos(phi + 45 degrees).
#include "rigs/whole_shaft.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace {

using vielto::kPhases;
const double kPi = std::acos(-1.0);
const double kDegree = kPi / 180;

double middle(int phase) { return 2 * kPi * (phase + 0.5) / kPhases; }

double mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

// A slice whose paddles feel a + swing(turn) cos(their angle); stems 0.1, shaft 0.05, drum -0.2 N m.
template <class Swing>
vielto::TorqueRecord slice(const std::vector<double>& degrees, double step, int turns, double a, Swing swing) {
  vielto::TorqueRecord record;
  record.header.slice = static_cast<int>(degrees.size());
  record.header.paddles = 22;
  record.header.paddle_angle_step = step * kDegree;
  record.blocks = turns;
  const std::size_t size = static_cast<std::size_t>(turns) * kPhases;
  record.part[0].assign(size, 0.0);
  record.part[1].assign(size, 0.1);
  record.part[2].assign(size, 0.05);
  record.part[3].assign(size, -0.2);
  for (const double d : degrees) {
    record.header.paddle_angles.push_back(d * kDegree);
    std::vector<double> torque;
    for (int t = 0; t < turns; ++t)
      for (int i = 0; i < kPhases; ++i) torque.push_back(a + swing(t) * std::cos(middle(i) + d * kDegree));
    for (std::size_t i = 0; i < size; ++i) record.part[0][i] += torque[i];
    record.paddle.push_back(torque);
  }
  return record;
}

TEST(WholeShaft, TurningACurveByPhasesMovesItAndByPartsBlendsIt) {
  std::vector<double> curve(kPhases, 0.0);
  curve[10] = 1;
  EXPECT_EQ(vielto::turned(curve, 50 * kDegree)[0], 1);
  EXPECT_EQ(vielto::turned(curve, -310 * kDegree)[0], 1);
  EXPECT_EQ(vielto::turned(curve, -10 * kDegree)[12], 1);
  const auto half = vielto::turned(curve, 2.5 * kDegree);
  EXPECT_NEAR(half[9], 0.5, 1e-12);
  EXPECT_NEAR(half[10], 0.5, 1e-12);
  EXPECT_NEAR(mean(half), 1.0 / kPhases, 1e-15);
}

TEST(WholeShaft, SinglePaddleIsFoundAtItsOwnAngle) {
  const auto curves = vielto::shaft_curves(slice({30, 120, 210, 300}, 90, 2, 0.2, [](int) { return 0.05; }), 0, 2);
  for (int i = 0; i < kPhases; ++i) EXPECT_NEAR(curves.paddle[i], 0.2 + 0.05 * std::cos(middle(i)), 1e-12);
}

// a + b cos(theta) is a + b sin(s) at s past the lowest point: the share of a sector from p to q is
// 1/6 + b/(2 pi a) (cos p - cos q), at the middles of phases of 5 degrees times h/sin(h), h = 2.5 degrees. As the
// turns' b differ, a share's uncertainty is that of their mean.
TEST(WholeShaft, SharesOfAPaddlesTorqueByItsPlace) {
  const auto swing = [](int turn) { return 0.05 + 0.01 * turn; };  // 0.05, 0.06, 0.07: sd 0.01
  const auto curves = vielto::shaft_curves(slice({30, 120, 210, 300}, 90, 3, 0.2, swing), 0, 3);
  const double h = kPi / 72, of_swing = h / std::sin(h) / (2 * kPi * 0.2);
  const std::array<double, 3> cosines = {-1, -0.5, 1};  // carried -120 to -60, entering -60 to 0, leaving 60 to 120
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(curves.shares[k], 1.0 / 6 + 0.06 * of_swing * cosines[k], 1e-12) << k;
    EXPECT_NEAR(curves.shares_u[k], 0.01 / std::sqrt(3.0) * of_swing * std::fabs(cosines[k]), 1e-12) << k;
  }
}

TEST(WholeShaft, PhaseShiftedSumOfTwentyTwoPaddles) {
  const auto curves = vielto::shaft_curves(slice({0, 90, 180, 270}, 90, 3, 0.2, [](int) { return 0.05; }), 0, 3);
  for (int i = 0; i < kPhases; ++i) {
    const double paddles = 22 * 0.2 + 0.05 * std::sqrt(2.0) * std::cos(middle(i) + kPi / 4);
    EXPECT_NEAR(curves.part[0][i], paddles, 1e-12);
    EXPECT_NEAR(curves.rotor[i], paddles + 5.5 * 0.15, 1e-12);
    EXPECT_NEAR(curves.part[1][i], 0.55, 1e-12);
    EXPECT_NEAR(curves.part[3][i], -1.1, 1e-12);
    EXPECT_NEAR(curves.rotor_u[i], 0, 1e-12);
  }
  // Standard deviation of sqrt(2) cos is 1.
  EXPECT_NEAR(curves.ripple, 0.05 / (22 * 0.2 + 5.5 * 0.15), 1e-12);
  EXPECT_NEAR(curves.ripple_u, 0, 1e-12);
}

// Left as it is, the slice would swing by its own paddles' phases: four in quadrature not at all, two at 0 and 90 too
// much.
TEST(WholeShaft, RippleIsTheShaftsWhateverPaddlesTheSliceHolds) {
  const double expected = 0.05 / (22 * 0.2 + 0.15 * 11);
  const auto two = vielto::shaft_curves(slice({0, 90}, 90, 2, 0.2, [](int) { return 0.05; }), 0, 2);
  EXPECT_NEAR(two.ripple, expected, 1e-12);
  // All paddles in line: 22 cos(phi).
  const auto line = vielto::shaft_curves(slice({0, 0}, 0, 2, 0.2, [](int) { return 0.05; }), 0, 2);
  EXPECT_NEAR(line.ripple, 22 * 0.05 / std::sqrt(2.0) / (22 * 0.2 + 0.15 * 11), 1e-12);
}

TEST(WholeShaft, MeanIsTheSlicesTimesPaddles) {
  const auto record = slice({0, 90, 180, 270}, 90, 3, 0.2, [](int t) { return 0.01 * t; });
  EXPECT_NEAR(mean(vielto::shaft_curves(record, 0, 3).rotor), 5.5 * mean(record.rotor()), 1e-12);
}

// A step of 33 degrees is no whole number of phases: sum_i cos(phi + 33 i) = sin(11 * 33)/sin(16.5) cos(phi + 346.5).
// Linear interpolation between phases lowers a cosine by at most (2 pi/72)^2/8 = 0.1 %.
TEST(WholeShaft, AnyStepBetweenPaddles) {
  const auto curves = vielto::shaft_curves(slice({0, 33}, 33, 2, 0.2, [](int) { return 0.05; }), 0, 2);
  const double factor = std::sin(11 * 33 * kDegree) / std::sin(16.5 * kDegree);
  for (int i = 0; i < kPhases; ++i)
    EXPECT_NEAR(curves.part[0][i], 4.4 + 0.05 * factor * std::cos(middle(i) + 346.5 * kDegree), 22 * 0.05 * 0.002);
}

TEST(WholeShaft, WholeDrumIsTakenAsItIs) {
  auto record = slice({0}, 90, 2, 0.2, [](int) { return 0.05; });
  record.header.slice = 0;
  record.paddle.clear();
  const auto curves = vielto::shaft_curves(record, 0, 2);
  EXPECT_TRUE(curves.paddle.empty());
  for (int i = 0; i < kPhases; ++i) EXPECT_NEAR(curves.rotor[i], 0.35 + 0.05 * std::cos(middle(i)), 1e-12);
}

// Two turns that begin with the second quarter of one are the same at each angle.
TEST(WholeShaft, TurnsMayBeginInsideOne) {
  const auto record = slice({0, 90, 180, 270}, 90, 3, 0.2, [](int) { return 0.05; });
  const auto whole = vielto::shaft_curves(record, 0, 2), later = vielto::shaft_curves(record, kPhases / 4, 2);
  for (int i = 0; i < kPhases; ++i) {
    EXPECT_NEAR(later.paddle[i], whole.paddle[i], 1e-12) << i;
    EXPECT_NEAR(later.rotor[i], whole.rotor[i], 1e-12) << i;
  }
}

// Only the turns asked for count.
TEST(WholeShaft, TurnsLeftOutDoNotCount) {
  const auto record = slice({0, 90, 180, 270}, 90, 4, 0.2, [](int t) { return t == 0 ? 1.0 : 0.05; });
  EXPECT_NEAR(vielto::shaft_curves(record, kPhases, 3).ripple, 0.05 / (22 * 0.2 + 5.5 * 0.15), 1e-12);
}

// The swing b of turn t is random: the ripple is proportional to its mean, and the jackknife of a mean is the standard
// error s/sqrt(n), without bias.
TEST(WholeShaft, JackknifeOfTheRippleIsTheStandardErrorOfTheSwing) {
  const std::vector<double> swings = {0.05, 0.07, 0.04, 0.06, 0.055};
  const auto record = slice({0, 90, 180, 270}, 90, 5, 0.2, [&](int t) { return swings[t]; });
  const auto curves = vielto::shaft_curves(record, 0, 5);
  double squares = 0;
  for (const double b : swings) squares += (b - 0.055) * (b - 0.055);
  const double torque = 22 * 0.2 + 5.5 * 0.15;
  EXPECT_NEAR(curves.ripple, 0.055 / torque, 1e-12);
  EXPECT_NEAR(curves.ripple_u, std::sqrt(squares / 4 / 5) / torque, 1e-12);
  // The rotor's own uncertainty at a phase: sqrt(2) abs(cos(phi + 45)) times that of the swing.
  for (int i = 0; i < kPhases; ++i)
    EXPECT_NEAR(curves.rotor_u[i], std::sqrt(2 * squares / 4 / 5) * std::fabs(std::cos(middle(i) + kPi / 4)), 1e-12);
}

// White noise alone has no ripple, but a mean over n turns keeps sigma/sqrt(n) of it: that much is named as noise.
TEST(WholeShaft, NoiseLeftInTheRippleIsNamed) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  vielto::TorqueRecord record;
  const int turns = 8;
  record.blocks = turns;
  for (auto& part : record.part) part.assign(static_cast<std::size_t>(turns) * kPhases, 0.0);
  for (double& value : record.part[0]) value = 1 + 0.1 * normal(random);
  const auto curves = vielto::shaft_curves(record, 0, turns);
  // Over 72 phases the spread is known to 1/sqrt(144) = 8 %: three of them.
  EXPECT_NEAR(curves.ripple, 0.1 / std::sqrt(8.0), 0.25 * 0.1 / std::sqrt(8.0));
  // The spread between turns tells the same noise, to 1/sqrt(2 * 72 * 7) = 3 %.
  EXPECT_NEAR(curves.ripple_noise, 0.1 / std::sqrt(8.0), 0.1 * 0.1 / std::sqrt(8.0));
}

}  // namespace

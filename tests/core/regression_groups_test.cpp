// SPDX-License-Identifier: GPL-2.0-or-later
// The groups of equation (1) and predictions, against the booklet's numbers and closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/bad_input.h"
#include "equation/power_equation.h"

namespace {

using namespace vielto;

BulkMaterial millet() {
  BulkMaterial m;
  m.name = "hulled_millet";
  m.bulk_density = 825;
  m.bulk_cohesion = 6175;
  m.diameter = 0.0018;
  m.repose_angle = 26;
  m.friction_angle = 45;
  return m;
}

// The booklet prints N_C 0.0004 to 0.0043 and Fr_M 0.0026 to 0.0291 for n = 0.48 to 1.58 1/s: last digits. N_C at the
// upper speed lies at 0.00433 with rho_h/C_h = 0.1336, within the 1 % of that ratio.
TEST(Groups, BookletsRangesFollowFromItsSpeeds) {
  const Groups low = groups_of(0.10, 0.48, {}, millet(), nullptr), high = groups_of(0.25, 1.58, {}, millet(), nullptr);
  EXPECT_NEAR(*low[1], 0.0004, 5e-5);
  EXPECT_NEAR(*high[1], 0.0043, 5e-5);
  EXPECT_NEAR(*low[2], 0.0026, 1e-4);
  EXPECT_NEAR(*high[2], 0.0291, 1e-4);
  EXPECT_EQ(*low[0], 0.10);
}

// By hand from the booklet's dimensions: 765/50, 250/1.8, 270/20, 10/26; tan 25 deg / tan 45 deg = 0.46631.
TEST(Groups, GeometryAndFrictionGroupsAreTheirRatios) {
  MixerDimensions mixer;
  mixer.drum_length = 0.765;
  mixer.drum_width = 0.250;
  mixer.drum_height = 0.270;
  mixer.paddle_width = 0.050;
  mixer.paddle_height = 0.020;
  mixer.inclination = 10;
  BulkMaterial steel;
  steel.friction_angle = 25;
  const Groups g = groups_of(0.15, 1, mixer, millet(), &steel);
  EXPECT_NEAR(*g[3], 15.3, 1e-12);
  EXPECT_NEAR(*g[4], 138.888889, 1e-6);
  EXPECT_NEAR(*g[5], 13.5, 1e-12);
  EXPECT_NEAR(*g[6], 0.384615, 1e-6);
  EXPECT_NEAR(*g[7], 0.466308, 1e-6);
}

TEST(Groups, UnknownInputsLeaveTheirGroupEmpty) {
  const Groups g = groups_of(0.15, 1, {}, BulkMaterial(), nullptr);
  EXPECT_TRUE(g[0] && g[2]);
  for (const int i : {1, 3, 4, 5, 6, 7}) EXPECT_FALSE(g[i]) << kGroupNames[i];
}

Prediction at(const Equation& e, double fill, double speed, double lever = 0.114) {
  MixerDimensions mixer;
  mixer.lever = lever;
  return predict(e, "equation", groups_of(fill, speed, mixer, millet(), nullptr), speed, mixer, millet());
}

// Corners of the table of powers worked out from the booklet's equation for rho_h = 825 kg/m3: W, 2 decimals.
TEST(Prediction, BookletsEquationGivesItsPowers) {
  EXPECT_NEAR(at(thesis_equation(), 0.10, 0.48).power, 12.62, 0.006);
  EXPECT_NEAR(at(thesis_equation(), 0.25, 0.48).power, 32.74, 0.006);
  EXPECT_NEAR(at(thesis_equation(), 0.10, 1.58).power, 29.07, 0.006);
  EXPECT_NEAR(at(thesis_equation(), 0.25, 1.58).power, 75.38, 0.006);
}

// 13.7 % over the expected largest of 16 normal deviates, 2.077 (doc/theory/equation.md).
TEST(Prediction, BookletsUncertaintyFollowsFromItsLargestError) {
  EXPECT_NEAR(thesis_relative_u(), 0.137 / 2.077, 1e-4);
  const Prediction p = at(thesis_equation(), 0.15, 1);
  EXPECT_NEAR(p.u / p.power, 0.137 / 2.077, 1e-4);
  EXPECT_NEAR(p.high95 / p.power, std::exp(1.95996 * 0.137 / 2.077), 1e-4);
}

TEST(Prediction, LeavingTheFittedRangeIsNamed) {
  EXPECT_TRUE(at(thesis_equation(), 0.10, 0.48).outside.empty());
  EXPECT_TRUE(at(thesis_equation(), 0.25, 1.58).outside.empty());
  const Prediction full = at(thesis_equation(), 0.30, 1);
  ASSERT_EQ(full.outside.size(), 1u);
  EXPECT_NE(full.outside[0].find("l = 0.3"), std::string::npos);
  EXPECT_EQ(at(thesis_equation(), 0.15, 2).outside.size(), 2u);  // N_C and Fr_M
}

// Another size at the same Froude number: N_C grows with L, so the power is not P ~ L^3 n alone; and the booklet's
// mixer is the only one the equation was fitted in, which is said.
TEST(Prediction, ScalingToAnotherMixerGoesThroughTheGroups) {
  const double k = 1.2, speed = 0.6;
  const Prediction one = at(thesis_equation(), 0.15, speed),
                   other = at(thesis_equation(), 0.15, speed / std::sqrt(k), k * 0.114);
  EXPECT_NEAR(other.power / one.power, std::pow(k, 3 - 0.5) * std::pow(k, 0.1), 1e-9);
  ASSERT_EQ(other.outside.size(), 1u);
  EXPECT_NE(other.outside[0].find("L_kl"), std::string::npos);
}

// Equation N_PC = B0 l^B1 with independent errors of ln B0 and B1: u(ln P)^2 = s0^2 + (s1 ln l)^2.
TEST(Prediction, UncertaintyOfThePowerFollowsFromTheCovariance) {
  Equation e;
  e.names = {"B0", "B1"};
  e.parameters = Eigen::Vector2d(1, 0.5);
  e.covariance = Eigen::Vector2d(0.02 * 0.02, 0.01 * 0.01).asDiagonal();
  e.quantile = 2;
  e.scatter = 0.05;
  e.lever = {0.114, 0.114};
  const Prediction p = at(e, 0.2, 1);
  const double u = std::hypot(0.02, 0.01 * std::log(0.2));
  EXPECT_NEAR(p.number, std::exp(1 + 0.5 * std::log(0.2)), 1e-12);
  EXPECT_NEAR(p.power, p.number * 6175 * std::pow(0.114, 3), 1e-9);  // P = N_PC C_h L^3 n
  EXPECT_NEAR(std::log(p.high95 / p.power), 2 * u, 1e-9);
  EXPECT_NEAR(std::log(p.new_low95 / p.power), -2 * std::hypot(u, 0.05), 1e-9);
}

TEST(Prediction, ExponentsThatTheFitDidNotTellApartAreNotUsedApart) {
  Equation e = thesis_equation();
  e.parameters[3] = 0;
  const double constant = -std::log(0.114 * 9.81 * 825 / 6175);  // ln Fr_M - ln N_C of this millet
  e.aliases.push_back({"B3", constant, Eigen::Vector3d(0, 1, 0)});
  EXPECT_NO_THROW(at(e, 0.15, 1));
  MixerDimensions mixer;
  BulkMaterial other = millet();
  other.bulk_cohesion = 7000;
  EXPECT_THROW(predict(e, "equation", groups_of(0.15, 1, mixer, other, nullptr), 1, mixer, other), BadInput);
}

}  // namespace

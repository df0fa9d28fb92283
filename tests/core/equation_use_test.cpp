// SPDX-License-Identifier: GPL-2.0-or-later
// Largest fill for a motor, against the power law solved for the fill: P = exp(b0) l^b1 C_h L^3 n.
#include "equation/equation_use.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/bad_input.h"

namespace {

using namespace vielto;

constexpr double kFactor = 20, kExponent = 1.5, kSpeed = 1.2, kCohesion = 6000, kLever = 0.114;

EquationUse millet(double exponent = kExponent) {
  EquationUse use;
  use.source = "equation";
  use.equation.names = {"B0", "B1"};
  use.equation.parameters = Eigen::Vector2d(std::log(kFactor), exponent);
  use.equation.covariance = Eigen::Matrix2d::Zero();
  use.equation.group_range[0] = FittedRange{0.1, 0.25};
  use.equation.lever = {kLever, kLever};
  use.mixer.lever = kLever;
  use.material.bulk_density = 800;
  use.material.bulk_cohesion = kCohesion;
  return use;
}

double power(double fill) { return kFactor * std::pow(fill, kExponent) * kCohesion * std::pow(kLever, 3) * kSpeed; }

TEST(EquationUse, LargestFillSolvesThePowerLaw) {
  // the bisection stops at 1e-12 of the fill
  EXPECT_NEAR(largest_fill(millet(), kSpeed, power(0.17)).expected.value(), 0.17, 1e-11);
}

TEST(EquationUse, LargestFillIsTheEndOfTheRangeOrNothing) {
  EXPECT_EQ(largest_fill(millet(), kSpeed, power(0.3)).expected.value(), 0.25);
  EXPECT_FALSE(largest_fill(millet(), kSpeed, power(0.09)).expected);
  EXPECT_FALSE(largest_fill(millet(), kSpeed, power(0.09)).safe);
}

TEST(EquationUse, RefusesAnEquationThatHasNoLargestFill) {
  EXPECT_THROW(largest_fill(millet(-0.1), kSpeed, power(0.17)), BadInput);
  EquationUse one = millet();
  one.equation.group_range[0] = FittedRange{0.1, 0.1};
  EXPECT_THROW(largest_fill(one, kSpeed, power(0.17)), BadInput);
}

TEST(EquationUse, OutsideItsRangeItSpeaksOnlyIfAsked) {
  EXPECT_THROW(millet().checked(0.3, kSpeed), BadInput);
  EquationUse use = millet();
  use.extrapolate = true;
  EXPECT_NEAR(use.checked(0.3, kSpeed).power, power(0.3), 1e-12 * power(0.3));
  EXPECT_EQ(use.checked(0.3, kSpeed).outside.size(), 1u);
}

}  // namespace

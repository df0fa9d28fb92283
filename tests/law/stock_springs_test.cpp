// SPDX-License-Identifier: GPL-2.0-or-later
// Springs of LIGGGHTS' own laws by hand, with unequal bodies.
#include "stock_springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace stock;

const double kInfinity = std::numeric_limits<double>::infinity();

// E 2e6, v 0.5: (1 - v^2)/E = 3.75e-7, 2 (2 - v)(1 + v)/E = 2.25e-6; E 4e6, v 0.2: 2.4e-7 and 1.08e-6 1/Pa.
TEST(StockSprings, ModuliAreThoseOfBothBodies) {
  const Moduli c = moduli({2e6, 0.5}, {4e6, 0.2});
  EXPECT_DOUBLE_EQ(c.normal, 1 / 6.15e-7);
  EXPECT_DOUBLE_EQ(c.shear, 1 / 3.33e-6);
  EXPECT_DOUBLE_EQ(moduli({4e6, 0.2}, {2e6, 0.5}).shear, c.shear);
}

TEST(StockSprings, RadiusAndMassAreEffectiveOnes) {
  EXPECT_DOUBLE_EQ(radius(0.003, 0.006, 1), 0.002);
  EXPECT_DOUBLE_EQ(radius(0.003, 0.006, kInfinity), 0.003);
  EXPECT_DOUBLE_EQ(mass(3e-4, 6e-4), 2e-4);
  EXPECT_DOUBLE_EQ(mass(3e-4, kInfinity), 3e-4);
}

// R u = 4e-7 m2: slope 2 Y sqrt(R u), k_t = 8 G sqrt(R u), k_r = k_t R^2.
TEST(StockSprings, HertzIsTheSlopeAtTheOverlap) {
  const vielto::Springs k = hertz_springs({1e6, 2e5}, 1e-4, 0.004);
  const double root = std::sqrt(4e-7);
  EXPECT_DOUBLE_EQ(k.normal, 2e6 * root);
  EXPECT_DOUBLE_EQ(k.tangential, 1.6e6 * root);
  EXPECT_DOUBLE_EQ(k.rolling, 1.6e6 * root * 1.6e-5);
  EXPECT_EQ(k.twisting, 0);
}

// The linear spring that a Hertzian one of the same energy makes at the characteristic velocity: an impact at V of the
// mass m compresses Hertz' F = 4/3 Y sqrt(R) u^(3/2) to u with m V^2/2 = 8/15 Y sqrt(R) u^(5/2); k_n = m V^2/u^2.
TEST(StockSprings, HookeHasTheGreatestOverlapOfHertzAtTheCharacteristicVelocity) {
  const double Y = 1e6, R = 0.004, m = 3e-4, V = 0.7;
  const double u = std::pow(15 * m * V * V / (16 * Y * std::sqrt(R)), 0.4);
  const vielto::Springs k = hooke_springs({Y, 2e5}, V, R, m);
  EXPECT_NEAR(k.normal, m * V * V / (u * u), 1e-12 * k.normal);
  EXPECT_DOUBLE_EQ(k.tangential, 2 * k.normal / 7);
  EXPECT_DOUBLE_EQ(k.rolling, k.tangential * R * R);
  EXPECT_EQ(k.twisting, 0);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// The law CohFrictPhys alone: mixing, limits and what breaks a bond, against numbers worked by hand.
#include "cohfrict_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using cohfrict::advance;
using vielto::Vec;

const double kRounding = 1e-14;  // relative: a few roundings of double precision

void expect_relative(double value, double expected) { EXPECT_NEAR(value, expected, kRounding * std::fabs(expected)); }

// Round numbers: E_1R_1 = 1e6 * 0.003 = 3000, E_2R_2 = 2e6 * 0.006 = 12000 N/m.
const cohfrict::Material kOne = {1e6, 0.5, 0.3, 0.4, 0.0, 0.1, 0.3, 1e4, 3e4};
const cohfrict::Material kTwo = {2e6, 0.25, 0.5, 0.1, 0.7, 0.02, -1, 2e4, 1e4};
const double kR1 = 0.003, kR2 = 0.006;

TEST(CohFrictMixing, GivesTheContactsConstants) {
  const cohfrict::Contact c = cohfrict::contact(cohfrict::mix(kOne, kTwo), kR1, kR2);
  expect_relative(c.kn, 4800);                         // 2 * 3000 * 12000/15000
  expect_relative(c.ks, 2000);                         // 2 * 1500 * 3000/4500
  expect_relative(c.tanPhi, std::tan(0.3));            // the smaller angle
  expect_relative(c.kr, 0.16 * 2000 * kR1 * kR2);      // alpha_kr: 2 * 0.4 * 0.1/0.5
  EXPECT_EQ(c.ktw, 0.0);                               // one of them is 0
  expect_relative(c.rollingArm, 0.02 * kR2);           // 0.12 mm against 0.3 mm
  EXPECT_LT(c.twistingArm, 0);                         // one of them has no limit
  expect_relative(c.normalAdhesion, 1e4 * kR1 * kR1);  // the smaller cohesion on the smaller radius
  expect_relative(c.shearAdhesion, 1e4 * kR1 * kR1);
}

// As above, with a twisting stiffness and limit on both: alpha_ktw = 2 * 0.3 * 0.6/0.9 = 0.4.
TEST(CohFrictMixing, GivesTheTwistsConstants) {
  cohfrict::Material a = kOne, b = kTwo;
  a.alphaKtw = 0.3, b.alphaKtw = 0.6;
  a.etaTwist = 0.3, b.etaTwist = 0.1;
  cohfrict::Contact c = cohfrict::contact(cohfrict::mix(a, b), kR1, kR2);
  expect_relative(c.ktw, 0.4 * 2000 * kR1 * kR2);
  expect_relative(c.twistingArm, 0.1 * kR2);  // 0.6 mm against 0.9 mm
  b.etaTwist = 0.5;
  c = cohfrict::contact(cohfrict::mix(a, b), kR1, kR2);
  expect_relative(c.twistingArm, 0.3 * kR1);  // 0.9 mm against 3 mm
  a.etaRoll = 0.01;
  c = cohfrict::contact(cohfrict::mix(a, b), kR1, kR2);
  expect_relative(c.rollingArm, 0.01 * kR1);  // 0.03 mm against 0.12 mm
}

TEST(CohFrictMixing, OrderOfTheBodiesDoesNotMatter) {
  const cohfrict::Contact c = cohfrict::contact(cohfrict::mix(kOne, kTwo), kR1, kR2);
  const cohfrict::Contact d = cohfrict::contact(cohfrict::mix(kTwo, kOne), kR2, kR1);
  expect_relative(c.kn, d.kn);
  expect_relative(c.ks, d.ks);
  expect_relative(c.kr, d.kr);
  expect_relative(c.rollingArm, d.rollingArm);
  expect_relative(c.normalAdhesion, d.normalAdhesion);
}

// Two touching spheres that turn as one rigid body do not slip, with either slip: v_1 - v_2 = w x (R_1 + R_2 - u_n) n.
TEST(CohFrictSlip, IsZeroWhereThePairTurnsAsOneBody) {
  const Vec n = {0.6, 0, 0.8}, w = {30, -20, 50};
  for (const double overlap : {1e-4, -1e-4})
    for (const bool avoid : {false, true}) {
      const Vec v = (kR1 + kR2 - overlap) * cross(w, n);
      const Vec s = cohfrict::slip(n, v, w, w, kR1, kR2, overlap, avoid);
      EXPECT_LT(std::sqrt(dot(s, s)), kRounding * std::sqrt(dot(v, v)));
    }
}

// v_t = 1 m/s at u_n = 0.9 mm: against ratcheting it counts 9/8.1; spins with R_i there, R_i - u_n/2 without.
TEST(CohFrictSlip, HasTheStatedLevers) {
  const Vec n = {0, 0, 1}, v = {1, 0, 5}, w1 = {0, 100, 0}, w2 = {0, -40, 7}, still = {0, 0, 0};
  const double u = 9e-4;
  expect_relative(cohfrict::slip(n, v, still, still, kR1, kR2, u, true).x, 9 / 8.1);
  expect_relative(cohfrict::slip(n, v, still, still, kR1, kR2, u, false).x, 1);
  EXPECT_EQ(cohfrict::slip(n, v, still, still, kR1, kR2, u, false).z, 0);  // what goes along n is no slip
  // n x w = (-w_y, w_x, 0)
  expect_relative(cohfrict::slip(n, still, w1, w2, kR1, kR2, u, true).x, -100 * kR1 + 40 * kR2);
  expect_relative(cohfrict::slip(n, still, w1, w2, kR1, kR2, u, false).x, -100 * (kR1 - u / 2) + 40 * (kR2 - u / 2));
  // a wall: the spin of body 2 is in v already
  expect_relative(cohfrict::slip(n, v, w1, w2, kR1, 0, u, false).x, 1 - 100 * (kR1 - u / 2));
}

// A contact of k_n = 1000, k_s = 500 N/m, a_n = 0.2, a_s = 0.1 N, tan(phi) = 0.5; n = z, and a step in which it slips,
// rolls and twists by given amounts.
cohfrict::Contact simple() { return {1000, 500, 2, 3, 0.5, 0.001, 0.002, 0.2, 0.1}; }

struct Step {
  double overlap;
  double slip = 0, roll = 0, twist = 0;  // m, rad, rad
};

bool take(const Step& step, cohfrict::Memory& memory, cohfrict::Load& load, const cohfrict::Contact& c = simple()) {
  // in one second, so that the rates of the motion are its amounts
  const cohfrict::Motion m = {{0, 0, 1}, step.overlap, {step.slip, 0, 0}, {0, step.roll, 0}, step.twist, 0};
  return advance(c, m, 1.0, memory, load);
}

cohfrict::Memory fresh(bool bonded) { return {{0, 0, 0}, {0, 0, 0}, 0, bonded}; }

TEST(CohFrictBond, PullsUpToTheNormalAdhesion) {
  cohfrict::Memory memory = fresh(true);
  cohfrict::Load load;
  ASSERT_TRUE(take({-0.199e-3}, memory, load));
  expect_relative(load.normal, -0.199);
  EXPECT_TRUE(memory.bonded);
  EXPECT_FALSE(take({-0.201e-3}, memory, load));
}

TEST(CohFrictBond, WithoutOneTheContactEndsAtOnce) {
  cohfrict::Memory memory = fresh(false);
  cohfrict::Load load;
  EXPECT_TRUE(take({0}, memory, load));
  EXPECT_FALSE(take({-1e-12}, memory, load));
}

TEST(CohFrictBond, BearsShearAdhesionAndFriction) {
  cohfrict::Load load;
  // F_n = 0.4 N: 0.1 + 0.2 N; stretched, F_n = -0.1 N: 0.1 - 0.05 N
  for (const auto& [overlap, strength] : {std::pair(4e-4, 0.3), std::pair(-1e-4, 0.05)}) {
    cohfrict::Memory memory = fresh(true);
    ASSERT_TRUE(take({overlap, 0.999 * strength / 500}, memory, load));
    EXPECT_TRUE(memory.bonded);
    expect_relative(load.shear.x, -0.999 * strength);
    memory = fresh(true);
    ASSERT_TRUE(take({overlap, 1.001 * strength / 500}, memory, load));
    EXPECT_FALSE(memory.bonded);
  }
}

TEST(CohFrictBond, BrokenInShearLeavesFriction) {
  cohfrict::Memory memory = fresh(true);
  cohfrict::Load load;
  ASSERT_TRUE(take({4e-4, 1e-3}, memory, load));
  EXPECT_FALSE(memory.bonded);
  expect_relative(load.shear.x, -0.2);
  expect_relative(load.normal, 0.4);
  // it does not heal
  ASSERT_TRUE(take({4e-4, -0.5e-3}, memory, load));
  expect_relative(load.shear.x, 0.05);  // -0.2 + 0.25
  EXPECT_FALSE(take({-1e-5}, memory, load));
}

TEST(CohFrictBond, BrokenInShearWhileStretchedBearsNothing) {
  cohfrict::Memory memory = fresh(true);
  cohfrict::Load load;
  ASSERT_TRUE(take({-1e-4, 1e-3, 0.1, 0.1}, memory, load));
  EXPECT_FALSE(memory.bonded);
  EXPECT_EQ(load.normal, 0.0);
  EXPECT_EQ(dot(load.shear, load.shear), 0.0);
  EXPECT_EQ(dot(load.moment, load.moment), 0.0);
}

// Stored: F_n^2/(2 k_n) + F_s^2/(2 k_s). A cap takes (trial - capped) (old + capped)/(2 k): the mean force over the
// slip that is no longer stored.
TEST(CohFrictEnergy, OfACapIsItsMeanForceTimesTheSlip) {
  cohfrict::Memory memory = fresh(false);
  cohfrict::Load load;
  cohfrict::Energy energy;
  const auto step = [&](double overlap, double slip, double roll) {
    const cohfrict::Motion m = {{0, 0, 1}, overlap, {slip, 0, 0}, {0, roll, 0}, 0, 0};
    return advance(simple(), m, 1.0, memory, load, &energy);
  };
  ASSERT_TRUE(step(4e-4, 2e-4, 1e-4));  // F_n 0.4, F_s 0.1 N, M_r 2e-4 N m: nothing slides
  EXPECT_NEAR(energy.sliding, 0, kRounding);
  EXPECT_NEAR(energy.rolling, 0, kRounding);
  expect_relative(energy.elastic, 0.4 * 0.4 / 2000 + 0.1 * 0.1 / 1000 + 2e-4 * 2e-4 / 4);
  ASSERT_TRUE(step(4e-4, 6e-4, 3e-4));  // trial 0.4 N over 0.2 N; trial 8e-4 N m over 4e-4 N m
  EXPECT_NEAR(energy.sliding, (0.4 - 0.2) * (0.1 + 0.2) / (2 * 500), 1e-3 * kRounding);
  EXPECT_NEAR(energy.rolling, (8e-4 - 4e-4) * (2e-4 + 4e-4) / (2 * 2), 1e-3 * kRounding);
  expect_relative(energy.elastic, 0.4 * 0.4 / 2000 + 0.2 * 0.2 / 1000 + 4e-4 * 4e-4 / 4);
}

TEST(CohFrictEnergy, OfABondThatTearsIsLetGo) {
  cohfrict::Memory memory = fresh(true);
  cohfrict::Load load;
  cohfrict::Energy energy;
  memory.shear = {0.02, 0, 0};
  const cohfrict::Motion m = {{0, 0, 1}, -0.201e-3, {0, 0, 0}, {0, 0, 0}, 0, 0};
  EXPECT_FALSE(advance(simple(), m, 1.0, memory, load, &energy));
  expect_relative(energy.sliding, 0.201 * 0.201 / 2000 + 0.02 * 0.02 / 1000);
  EXPECT_EQ(energy.elastic, 0);
}

// What the springs hold when a contact ends, of all four: F^2/(2 k) each. A spring that is not there holds nothing.
TEST(CohFrictEnergy, OfAContactThatEndsIsThatOfItsSprings) {
  cohfrict::Contact c = simple();  // k 1000, 500 N/m, 2, 3 N m
  for (const bool with_moments : {true, false}) {
    if (!with_moments) c.kr = c.ktw = 0;
    cohfrict::Memory memory = {{0.02, 0, 0}, {0, 3e-4, 4e-4}, 6e-4, true};
    cohfrict::Load load;
    cohfrict::Energy energy;
    const cohfrict::Motion m = {{0, 0, 1}, -0.201e-3, {0, 0, 0}, {0, 0, 0}, 0, 0};
    EXPECT_FALSE(advance(c, m, 1.0, memory, load, &energy));
    const double moments = with_moments ? 5e-4 * 5e-4 / 4 + 6e-4 * 6e-4 / 6 : 0;
    expect_relative(energy.sliding, 0.201 * 0.201 / 2000 + 0.02 * 0.02 / 1000 + moments);
    EXPECT_EQ(energy.elastic, 0);
  }
}

// A contact without a bond ends where it parts, and has no normal force to let go of then.
TEST(CohFrictEnergy, OfATouchThatEndsIsThatOfItsShear) {
  cohfrict::Memory memory = {{0.02, 0, 0}, {0, 0, 0}, 0, false};
  cohfrict::Load load;
  cohfrict::Energy energy;
  const cohfrict::Motion m = {{0, 0, 1}, -1e-6, {0, 0, 0}, {0, 0, 0}, 0, 0};
  EXPECT_FALSE(advance(simple(), m, 1.0, memory, load, &energy));
  expect_relative(energy.sliding, 0.02 * 0.02 / 1000);
}

// Stretched by F_n = -0.1 N, a shear of 0.5 N breaks the bond: all is let go, -0.1 N in the spring before the step and
// the slip, whose force goes from 0.02 N to none: its mean 0.01 N times the slip of 0.5/500 m, and what was held.
TEST(CohFrictEnergy, OfABondThatBreaksWhileStretchedIsLetGo) {
  cohfrict::Memory memory = {{-0.02, 0, 0}, {0, 0, 0}, 0, true};
  cohfrict::Load load;
  cohfrict::Energy energy;
  const cohfrict::Motion m = {{0, 0, 1}, -1e-4, {1e-3, 0, 0}, {0, 0, 0}, 0, 0};
  ASSERT_TRUE(advance(simple(), m, 1.0, memory, load, &energy));
  EXPECT_EQ(energy.elastic, 0);
  expect_relative(energy.sliding, 0.1 * 0.1 / 2000 + 0.5 * 0.02 * 1e-3 + 0.02 * 0.02 / 1000);
}

// The twist as the roll above: trial 9e-4 N m over 8e-4 N m; k_tw = 3 N m.
TEST(CohFrictEnergy, OfATwistThatIsCappedIsItsMeanMomentTimesTheAngle) {
  cohfrict::Memory memory = fresh(false);
  cohfrict::Load load;
  cohfrict::Energy energy;
  const auto step = [&](double twist) {
    const cohfrict::Motion m = {{0, 0, 1}, 4e-4, {0, 0, 0}, {0, 0, 0}, twist, 0};
    return advance(simple(), m, 1.0, memory, load, &energy);
  };
  ASSERT_TRUE(step(1e-4));  // 3e-4 N m
  expect_relative(energy.elastic, 0.4 * 0.4 / 2000 + 3e-4 * 3e-4 / 6);
  EXPECT_NEAR(energy.twisting, 0, kRounding);
  ASSERT_TRUE(step(2e-4));
  EXPECT_NEAR(energy.twisting, (9e-4 - 8e-4) * (3e-4 + 8e-4) / (2 * 3), 1e-3 * kRounding);
  expect_relative(energy.elastic, 0.4 * 0.4 / 2000 + 8e-4 * 8e-4 / 6);
}

// A motion of 0.25 s at four times the rate is that of one second.
TEST(CohFrictStep, TakesRatesTimesItsLength) {
  cohfrict::Memory memory = fresh(true);
  cohfrict::Load load;
  cohfrict::Energy energy;
  const cohfrict::Motion m = {{0, 0, 1}, 4e-4, {4 * 2e-4, 0, 0}, {0, 4 * 1e-4, 0}, 4 * 1e-5, 0};
  ASSERT_TRUE(advance(simple(), m, 0.25, memory, load, &energy));
  expect_relative(load.shear.x, -500 * 2e-4);
  expect_relative(load.moment.y, -2 * 1e-4);
  expect_relative(load.moment.z, -3 * 1e-5);
  EXPECT_NEAR(energy.sliding, 0, kRounding);
  EXPECT_NEAR(energy.rolling, 0, kRounding);
  EXPECT_NEAR(energy.twisting, 0, kRounding);
}

TEST(CohFrictMoments, AreLimitedByTheNormalForceOfEitherSign) {
  for (const double overlap : {2e-4, -1e-4}) {  // F_n = 0.2 and -0.1 N
    const double F = std::fabs(1000 * overlap);
    cohfrict::Memory memory = fresh(true);
    cohfrict::Load load;
    ASSERT_TRUE(take({overlap, 0, 1e-5, -1e-5}, memory, load));
    expect_relative(load.moment.y, -2e-5);  // k_r times the angle, below 0.001 |F_n|
    expect_relative(load.moment.z, 3e-5);
    ASSERT_TRUE(take({overlap, 0, -1, 1}, memory, load));
    expect_relative(load.moment.y, 0.001 * F);
    expect_relative(load.moment.z, -0.002 * F);
  }
}

TEST(CohFrictMoments, HaveNoLimitWhereTheArmIsNegative) {
  cohfrict::Contact c = simple();
  c.rollingArm = c.twistingArm = -1;
  cohfrict::Memory memory = fresh(false);
  cohfrict::Load load;
  ASSERT_TRUE(take({1e-6, 0, 0.1, -0.1}, memory, load, c));
  expect_relative(load.moment.y, -0.2);
  expect_relative(load.moment.z, 0.3);
}

// The adapter asks LIGGGHTS to look as far as a bond can be stretched: a_n/k_n over R_1 + R_2, and over R_1 for a wall,
// is never more than the bound.
TEST(CohFrictStretch, IsNeverMoreThanItsBound) {
  for (const double R2 : {0.0003, 0.001, 0.003, 0.02})
    for (const double E2 : {1e6, 7e6}) {
      cohfrict::Material a = kOne, b = kTwo;
      b.young = E2;
      const cohfrict::Contact c = cohfrict::contact(cohfrict::mix(a, b), kR1, R2);
      const double bound = cohfrict::stretch_bound(2e4, 1e6), stretch = c.normalAdhesion / c.kn;
      EXPECT_LE(stretch, bound * (kR1 + R2));
      EXPECT_LE(stretch, bound * kR1);
    }
  // of two alike, k_n = E R and a_n = C R^2: at a wall of the same radius it is the bound
  const cohfrict::Contact alike = cohfrict::contact(cohfrict::mix(kOne, kOne), kR1, kR1);
  expect_relative(alike.normalAdhesion / alike.kn, cohfrict::stretch_bound(1e4, 1e6) * kR1);
}

}  // namespace

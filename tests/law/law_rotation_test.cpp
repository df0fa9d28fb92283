// SPDX-License-Identifier: GPL-2.0-or-later
// What turns with a contact: stored forces from step to step, and the spin of a wall read from a moving triangle.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "vielto_law.h"

namespace {

typedef Eigen::Vector3d V;

vielto::Vec to(const V& v) { return {v[0], v[1], v[2]}; }
V from(const vielto::Vec& v) { return {v.x, v.y, v.z}; }

class Random {
 public:
  V direction() {
    V v;
    do v = V(number_(engine_), number_(engine_), number_(engine_));
    while (v.norm() > 1 || v.norm() < 0.1);
    return v.normalized();
  }
  double number(double low, double high) { return low + (high - low) * 0.5 * (1 + number_(engine_)); }

 private:
  std::mt19937 engine_{20240601};
  std::uniform_real_distribution<double> number_{-1, 1};
};

// A contact frame that turns by the rotation vector `turn` in one step; its normal before the step is n.
struct Step {
  V n, stored, turn;
  V exact() const { return Eigen::AngleAxisd(turn.norm(), turn.normalized()) * stored; }
  V new_normal() const { return Eigen::AngleAxisd(turn.norm(), turn.normalized()) * n; }
  V result() const {
    // mean spin about the normal over the step, as the adapters form it
    return from(vielto::turned_with_contact(to(stored), to(new_normal()), turn.dot(new_normal())));
  }
};

Step random_step(Random& random, double angle) {
  Step step;
  step.n = random.direction();
  step.stored = step.n.cross(random.direction()) * random.number(0.1, 10);
  step.turn = angle * random.direction();
  return step;
}

TEST(TurnedWithContact, StaysPerpendicularToTheNewNormal) {
  Random random;
  for (int i = 0; i < 1000; i++) {
    const Step step = random_step(random, 0.05);
    EXPECT_NEAR(step.result().dot(step.new_normal()), 0, 1e-15 * step.stored.norm());
  }
}

// Tilting keeps the length but for the neglected fourth-order term 3/8 s^2 of 1/sqrt(1 - s), s = sin^2 of the tilt <
// 1e-4.
TEST(TurnedWithContact, TiltKeepsTheLength) {
  Random random;
  for (const double angle : {1e-5, 1e-3, 9e-3, 0.05, 0.5}) {
    for (int i = 0; i < 200; i++) {
      Step step = random_step(random, angle);
      step.turn -= step.turn.dot(step.n) * step.n;  // no spin about the normal
      const V result = from(vielto::turned_with_contact(to(step.stored), to(step.new_normal()), 0));
      EXPECT_NEAR(result.norm() / step.stored.norm(), 1, 0.375e-8 + 1e-14) << "tilt " << angle;
    }
  }
}

// Spin about the normal lengthens by sqrt(1 + angle^2): second order in the angle of one step.
TEST(TurnedWithContact, SpinKeepsTheLengthToSecondOrder) {
  const V n(0, 0, 1), stored(2, 0, 0);
  for (const double angle : {1e-4, 1e-3, 1e-2}) {
    const V result = from(vielto::turned_with_contact(to(stored), to(n), angle));
    EXPECT_NEAR(result.norm() / stored.norm() - 1, 0.5 * angle * angle, 0.13 * std::pow(angle, 4) + 1e-15);
    EXPECT_NEAR(std::atan2(result[1], result[0]), angle, angle * angle * angle);
  }
}

// Against the exact rotation (Rodrigues): the error of one step is of second order, so it falls by 4 with half the
// angle, and is below the square of the angle.
TEST(TurnedWithContact, EqualsTheExactRotationToSecondOrder) {
  Random random;
  for (int i = 0; i < 200; i++) {
    Step step = random_step(random, 4e-3);
    const double coarse = (step.result() - step.exact()).norm() / step.stored.norm();
    EXPECT_LT(coarse, 4e-3 * 4e-3);
    step.turn *= 0.5;
    const double fine = (step.result() - step.exact()).norm() / step.stored.norm();
    EXPECT_LT(fine, coarse / 3.5 + 1e-14);
  }
}

TEST(TurnedWithContact, KeepsAZeroZero) {
  const V result = from(vielto::turned_with_contact({0, 0, 0}, {0, 0, 1}, 0.1));
  EXPECT_EQ(result.norm(), 0);
}

TEST(TurnedWithContact, NormalTurnedOntoTheStoredVectorLeavesAFiniteOne) {
  const V result = from(vielto::turned_with_contact({0, 0, 3}, {0, 0, 1}, 0));
  EXPECT_TRUE(result.allFinite());
  EXPECT_LE(result.norm(), 3.0);
}

// v(x) = v_0 + w x (x - x_0) on the corners of a random triangle; the spin must come back, also where it lies in the
// plane of the triangle. Tolerance: round-off grows with the ratio of edges to height (at most about 20 here).
TEST(TriangleSpin, IsRecoveredFromAnyRigidMotion) {
  Random random;
  int tried = 0;
  while (tried < 1000) {
    const V r[3] = {random.direction(), random.direction(), random.direction()};
    if ((r[1] - r[0]).cross(r[2] - r[0]).norm() < 0.1) continue;
    tried++;
    const V w = random.number(0, 50) * random.direction(), v0 = 3 * random.direction();
    V v[3];
    for (int k = 0; k < 3; k++) v[k] = v0 + w.cross(r[k]);
    const V spin = from(vielto::triangle_spin(to(r[0]), to(r[1]), to(r[2]), to(v[0]), to(v[1]), to(v[2])));
    EXPECT_LT((spin - w).norm(), 1e-12 * (w.norm() + v0.norm()));
  }
}

TEST(TriangleSpin, OfSpinsInAndAcrossThePlaneOfTheTriangle) {
  const V r[3] = {V(1, 2, 0), V(4, 2, 0), V(2, 5, 0)};
  for (const V& w : {V(7, 0, 0), V(0, -7, 0), V(0, 0, 7)}) {
    V v[3];
    for (int k = 0; k < 3; k++) v[k] = w.cross(r[k]);
    const V spin = from(vielto::triangle_spin(to(r[0]), to(r[1]), to(r[2]), to(v[0]), to(v[1]), to(v[2])));
    EXPECT_LT((spin - w).norm(), 1e-13);
  }
}

TEST(TriangleSpin, TranslationHasNone) {
  const vielto::Vec v = {1, -2, 3};
  EXPECT_EQ(from(vielto::triangle_spin({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, v, v, v)).norm(), 0);
}

TEST(TriangleSpin, TriangleWithoutAreaHasNone) {
  const vielto::Vec v = {1, -2, 3};
  EXPECT_EQ(from(vielto::triangle_spin({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, v, {0, 0, 0}, v)).norm(), 0);
}

}  // namespace

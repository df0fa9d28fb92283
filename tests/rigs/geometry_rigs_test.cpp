// SPDX-License-Identifier: GPL-2.0-or-later
// Shear box, angle of repose and rotating drum: meshes against their drawings. Rounding errors only, unless stated.
#include <gtest/gtest.h>

#include <cmath>

#include "rig_meshes.h"

using namespace vielto_test;

namespace {

Point normal(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }
Point centre(const Triangle& t) { return (t[0] + t[1] + t[2]) / 3; }

// Area of the triangles that face `direction` in the plane through `level` along it.
double area_facing(const Triangles& triangles, const Point& direction, double level) {
  double area = 0;
  for (const Triangle& t : triangles)
    if (normal(t).dot(direction) > 1 - 1e-9 && std::fabs(centre(t).dot(direction) - level) < 1e-12)
      area += (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
  return area;
}

}  // namespace

TEST(ShearBox, LowerHalfIsFlooredWalledAndFlangedTowardsTheGrains) {
  const Rig box = rig("shearbox");
  const Triangles& lower = box.part("lower");
  EXPECT_NEAR(area_facing(lower, {0, 0, 1}, -0.015), 0.06 * 0.06, 1e-15);
  EXPECT_NEAR(area_facing(lower, {0, 0, 1}, 0), 2 * 0.012 * 0.06, 1e-15);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(area_facing(lower, {-side, 0, 0}, -0.03), 0.06 * 0.015, 1e-15);
    EXPECT_NEAR(area_facing(lower, {0, -side, 0}, -0.03), 0.06 * 0.015, 1e-15);
  }
  EXPECT_NEAR(measure(lower).area, 0.06 * 0.06 + 2 * 0.012 * 0.06 + 4 * 0.06 * 0.015, 1e-14);  // and nothing else
  EXPECT_EQ(measure(lower).crowded_edges, 0);
}

TEST(ShearBox, UpperHalfHasNoFloorAndItsFlangesLookDown) {
  const Rig box = rig("shearbox");
  const Triangles& upper = box.part("upper");
  EXPECT_NEAR(area_facing(upper, {0, 0, -1}, -0.0002), 2 * 0.012 * 0.06, 1e-15);
  EXPECT_EQ(area_facing(upper, {0, 0, 1}, 0.0002), 0);
  EXPECT_NEAR(measure(upper).area, 2 * 0.012 * 0.06 + 4 * 0.06 * (0.060 - 0.0002), 1e-14);
  EXPECT_NEAR(measure(upper).high.z(), 0.060, 1e-15);
}

// Shifted by the stated displacement, the opening of either half is still covered by the other's flange.
TEST(ShearBox, StaysTightUpToTheStatedShearDisplacement) {
  const Rig box = rig("shearbox");
  const double s = box.number("maxShearDisplacement");
  const Measure lower = measure(box.part("lower")), upper = measure(box.part("upper"));
  EXPECT_GE(lower.high.x(), 0.03 + s - 1e-15);  // under the upper half shifted by +s
  EXPECT_LE(lower.low.x(), -0.03 - s + 1e-15);
  EXPECT_LE(upper.low.x() + s, -0.03 + 1e-15);  // over the lower half
  EXPECT_GE(upper.high.x() - s, 0.03 - 1e-15);
}

// Flush walls of two meshes would both count a grain at the split: within sqrt(2 R overlap) of an edge, 0.09 mm for R =
// 0.9 mm at 0.5 % overlap. The halves stand farther apart than that and closer than a grain can pass.
TEST(ShearBox, HalvesDoNotShareAnEdge) {
  const Rig box = rig("shearbox");
  const double gap = 0.0002;
  for (const Triangle& t : box.part("lower"))
    for (const Point& p : t) EXPECT_LE(p.z(), 0);
  for (const Triangle& t : box.part("upper"))
    for (const Point& p : t) EXPECT_GE(p.z(), gap);
  EXPECT_GT(gap, 2 * std::sqrt(2 * 0.0009 * 0.005 * 0.0009));
  EXPECT_LT(gap, 0.0018 / 4);
}

TEST(ShearBox, LoadPlateIsAClosedBoxJustInsideTheUpperHalf) {
  const Rig box = rig("shearbox");
  const Measure plate = measure(box.part("plate"));
  EXPECT_EQ(plate.open_edges, 0);
  EXPECT_NEAR(plate.volume, 0.0596 * 0.0596 * 0.005, 1e-17);
  EXPECT_NEAR(plate.high.x(), 0.03 - 0.0002, 1e-15);
  EXPECT_NEAR(plate.low.y(), -0.03 + 0.0002, 1e-15);
  EXPECT_NEAR(plate.low.z(), box.number("plateBottom"), 1e-15);
  EXPECT_NEAR(plate.high.z(), measure(box.part("upper")).high.z(), 1e-15);
}

TEST(ShearBox, ThatCannotBeBuiltIsRefused) {
  EXPECT_NE(refusal("shearbox", {{"splitHeight", "0.03"}}).find("splitHeight"), std::string::npos);
  EXPECT_NE(refusal("shearbox", {{"plateGap", "0.03"}}).find("plateGap"), std::string::npos);
  EXPECT_NE(refusal("shearbox", {{"plateThickness", "0.08"}}).find("plateThickness"), std::string::npos);
  EXPECT_NE(refusal("shearbox", {{"splitGap", "0.02"}}).find("splitGap"), std::string::npos);
  EXPECT_NE(refusal("shearbox", {{"splitGap", "0"}}).find("splitGap"), std::string::npos);
}

TEST(Repose, CylinderStandsOnTheBaseAndFacesTheGrains) {
  const Rig repose = rig("repose");
  const Measure cylinder = measure(repose.part("cylinder"));
  EXPECT_EQ(cylinder.low.z(), 0);
  EXPECT_NEAR(cylinder.high.z(), 0.1, 1e-15);
  for (const Triangle& t : repose.part("cylinder")) {
    EXPECT_LT(normal(t).dot(Point(centre(t).x(), centre(t).y(), 0)), 0);
    for (const Point& p : t) EXPECT_NEAR(std::hypot(p.x(), p.y()), 0.025, 1e-15);
  }
  EXPECT_NEAR(area_facing(repose.part("base"), {0, 0, 1}, 0), 0.09, 1e-15);
  EXPECT_EQ(repose.part("base").size(), 2u);
  EXPECT_NEAR(repose.number("cylinderRadius"), 0.025 * std::cos(kPi / 36), 1e-12);  // of the chords' middles
}

TEST(Repose, DiscIsTheStatedPolygon) {
  const Rig repose = rig("repose", {{"baseShape", "disc"}, {"baseWidth", "0.1"}});
  EXPECT_NEAR(area_facing(repose.part("base"), {0, 0, 1}, 0), 24 * 0.05 * 0.05 * std::sin(2 * kPi / 48), 1e-15);
  EXPECT_EQ(repose.part("base").size(), 46u);
  EXPECT_NE(refusal("repose", {{"baseShape", "disc"}, {"baseWidth", "0.05"}}).find("baseWidth"), std::string::npos);
}

TEST(RotatingDrum, HoldsTheVolumeOfItsPolygonAndFacesTheGrains) {
  const Rig drum = rig("drum");
  EXPECT_NEAR(drum.number("meshedDrumVolume"), 0.05 * 48 * 0.075 * 0.075 * std::sin(2 * kPi / 96),
              1e-12);  // nine digits are written
  for (const char* part : {"drum", "ends"})
    for (const Triangle& t : drum.part(part)) EXPECT_GT(normal(t).dot(Point(0.025, 0, 0) - centre(t)), 0);
}

TEST(RotatingDrum, EndsCoverTheMantleFromOneEndToTheOther) {
  const Rig drum = rig("drum");
  const Measure mantle = measure(drum.part("drum"));
  EXPECT_EQ(mantle.low.x(), 0);
  EXPECT_EQ(mantle.high.x(), 0.05);
  EXPECT_NEAR(area_facing(drum.part("ends"), {1, 0, 0}, 0), 0.15 * 0.15, 1e-15);
  EXPECT_NEAR(area_facing(drum.part("ends"), {-1, 0, 0}, -0.05), 0.15 * 0.15, 1e-15);
  EXPECT_EQ(drum.part("ends").size(), 4u);
}

TEST(EveryRig, RefusesASliver) {
  EXPECT_NE(refusal("drum", {{"drumSegments", "96"}, {"drumLength", "1e-6"}}).find("deg"), std::string::npos);
}

// SPDX-License-Identifier: GPL-2.0-or-later
// Building blocks of the meshes, against closed forms. Tolerances are a few rounding errors of the quantity unless
// stated.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/surface.h"

using namespace vielto;

namespace {

Surface tilted_box() {
  const double a = 0.3;
  return box({0.01, 0.02, 0.03}, {0.025 * std::cos(a), 0.025 * std::sin(a), 0},
             {-0.01 * std::sin(a), 0.01 * std::cos(a), 0}, {0, 0, 0.001});
}

}  // namespace

TEST(Box, IsClosedWithOutwardNormalsAndTheVolumeOfItsEdges) {
  const Measure m = measure(triangulate(tilted_box()));
  EXPECT_EQ(m.triangles, 12u);
  EXPECT_EQ(m.open_edges, 0);
  EXPECT_EQ(m.crowded_edges, 0);
  EXPECT_NEAR(m.volume, 0.050 * 0.020 * 0.002, 1e-18);
  EXPECT_NEAR(m.area, 2 * (0.05 * 0.02 + 0.05 * 0.002 + 0.02 * 0.002), 1e-15);
}

TEST(Box, ListsItsLargestFacesLast) {
  for (const Surface& faces :
       {box({0, 0, 0}, {1, 0, 0}, {0, 10, 0}, {0, 0, 5}), box({0, 0, 0}, {5, 0, 0}, {0, 1, 0}, {0, 0, 10})})
    for (std::size_t i = 1; i < 6; ++i)
      EXPECT_GE(measure(triangulate({faces[i]})).area, measure(triangulate({faces[i - 1]})).area * (1 - 1e-12));
}

TEST(Measure, SeesAMissingAndAnInvertedTriangle) {
  Triangles missing = triangulate(tilted_box());
  missing.pop_back();
  EXPECT_EQ(measure(missing).open_edges, 3);
  Triangles inverted = triangulate(tilted_box());
  std::swap(inverted[0][0], inverted[0][1]);
  EXPECT_EQ(measure(inverted).open_edges, 0);
  EXPECT_EQ(measure(inverted).crowded_edges, 3);
}

// A regular prism of n sides inscribed in a circle has the base area n/2 R^2 sin(2 pi/n).
TEST(Sweep, OfACounterclockwiseCircleIsAPrismWithOutwardNormals) {
  const int n = 7;
  const auto circle = arc(0.5, 0.2, 2 * kPi, n);
  Surface prism = sweep(circle, true, -1, 2, 3);
  prism.push_back(plate(circle, -1, false));
  prism.push_back(plate(circle, 2, true));
  const Measure m = measure(triangulate(prism));
  EXPECT_EQ(m.open_edges, 0);
  EXPECT_EQ(m.crowded_edges, 0);
  EXPECT_NEAR(m.volume, 3 * n / 2.0 * 0.25 * std::sin(2 * kPi / n), 1e-14);
  EXPECT_NEAR(measure(triangulate(upright(prism))).volume, m.volume, 1e-14);
  EXPECT_NEAR(measure(triangulate(upright(prism))).high.z(), 2, 1e-14);
}

TEST(Wrap, KeepsTheAreaInsideOnePeriodAndLetsTheImagesCloseTheSurface) {
  const double length = 0.035;
  const Surface body = moved(tilted_box(), {-0.02, 0, 0});
  const Triangles cut = triangulate(wrap(body, length));
  const Measure m = measure(cut);
  EXPECT_EQ(m.low.x(), 0);
  EXPECT_EQ(m.high.x(), length);
  EXPECT_NEAR(m.area, measure(triangulate(body)).area, 1e-15);
  // Three copies side by side: every cut is closed by the next copy, only the cuts at both far ends stay open.
  Triangles row;
  for (int copy = -1; copy <= 1; ++copy)
    for (Triangle t : cut) {
      for (Point& p : t) p.x() += copy * length;
      row.push_back(t);
    }
  EXPECT_GT(m.open_edges, 0);
  EXPECT_EQ(measure(row).open_edges, m.open_edges);
  EXPECT_EQ(measure(row).crowded_edges, 0);
}

TEST(Wrap, LeavesABodyInsideThePeriodAsItIs) {
  const Surface body = moved(tilted_box(), {0.1, 0, 0});
  EXPECT_EQ(measure(triangulate(wrap(body, 0.2))).triangles, 12u);
  EXPECT_NEAR(measure(triangulate(wrap(body, 0.2))).volume, 2e-6, 1e-18);
}

TEST(Wrap, PutsAVertexNextToThePlaneOnIt) {
  const Surface body = box({0.5 + 1e-10, 0, 0}, {0.5, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const Measure m = measure(triangulate(wrap(body, 1.0)));
  EXPECT_EQ(m.triangles, 12u);
  EXPECT_EQ(m.low.x(), 0);
  EXPECT_EQ(m.high.x(), 1);
}

TEST(Triangulation, AvoidsTheTriangleWithoutAreaAtAStraightVertex) {
  const Face face{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 2, 1}, {0, 0, 1}};
  const Measure m = measure(triangulate({face}));
  EXPECT_EQ(m.triangles, 3u);
  EXPECT_NEAR(m.area, 2, 1e-14);
  EXPECT_NEAR(m.smallest_angle, kPi / 4, 1e-12);  // the best: both corners cut at 45 degrees from the middle vertex
}

TEST(Overlap, TellsTouchingSolidsFromSeparateOnes) {
  const Surface cube = box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const double s = std::sqrt(0.5);
  const Surface turned = box({0, 0, 0}, {s, s, 0}, {-s, s, 0}, {0, 0, 1});  // its corner reaches sqrt(2) along x
  EXPECT_TRUE(overlap(cube, moved(turned, {2.41, 0, 0})));
  EXPECT_FALSE(overlap(cube, moved(turned, {2.42, 0, 0})));
  EXPECT_TRUE(
      overlap(cube, moved(turned, {1.7, 1.7, 0})));  // boxes around them overlap, and so do they: 1.7 < 1 + sqrt(1/2)
  EXPECT_FALSE(
      overlap(cube, moved(turned, {1.72, 1.72, 0})));  // corner to face along the diagonal: sqrt(2) + 1 = 2.414 < 2.432
}

TEST(Radius, OfTheFarthestVertexFromTheXAxis) {
  EXPECT_NEAR(largest_radius(triangulate(box({5, 3, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}))), std::sqrt(17.0), 1e-14);
}

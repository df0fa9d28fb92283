// SPDX-License-Identifier: GPL-2.0-or-later
// The free surface of a drum's bed and its three slopes, on surfaces of known shape.
#include "rigs/drum/free_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <stdexcept>

using namespace vielto;

namespace {

const double pi = std::acos(-1.0);
constexpr double kRadius = 0.042;

// y = -a x + b x^3: steep in the middle and flat at both ends for b > 0, as a fast drum's bed. The line of least
// squares through a cubic over a window of middle c and half width h falls by a - 3 b c^2 - 3/5 b h^2.
constexpr double kA = 1.1, kB = 420;
double s_shape(double x) { return -kA * x + kB * x * x * x; }
double s_fall(double from, double to) {
  const double c = kRadius * (from + to) / 2, h = kRadius * (to - from) / 2;
  return std::atan(kA - 3 * kB * c * c - 0.6 * kB * h * h) * 180 / pi;
}

std::vector<SurfacePoint> points_of(const std::function<double(double)>& height, int points) {
  std::vector<SurfacePoint> surface;
  for (int i = 0; i < points; ++i) {
    const double x = kRadius * ((2.0 * i + 1) / points - 1);
    surface.push_back({x, height(x)});
  }
  return surface;
}

// Grains at random places that lie below the surface, in the drum, as cases/drum has them: x = -y, y = z.
std::vector<Grain> bed(const std::function<double(double)>& height, double radius, int grains,
                       std::mt19937_64& random) {
  std::uniform_real_distribution<double> one(-1, 1);
  std::vector<Grain> all;
  while (static_cast<int>(all.size()) < grains) {
    const double x = kRadius * one(random), y = kRadius * one(random), slope = (height(x + 1e-6) - height(x)) / 1e-6;
    // the distance of the centre from the surface, straight over a grain's size
    if (std::hypot(x, y) > kRadius - radius || height(x) - y < radius * std::hypot(1, slope)) continue;
    all.push_back({{0.01 * (1 + one(random)), -x, y}, radius});
  }
  return all;
}

}  // namespace

// 20 000 points are a continuous window up to 1 / 20 000 of its width at either end.
TEST(FreeSurface, TheSlopesOfACubicAreThoseOfItsLines) {
  const SurfaceAngles angles = surface_angles(points_of(s_shape, 20000), kRadius);
  EXPECT_NEAR(angles.mid, s_fall(-0.5, 0.5), 2e-3);
  EXPECT_NEAR(angles.upper, s_fall(-0.62, -0.24), 2e-3);
  EXPECT_NEAR(angles.lower, s_fall(0.24, 0.62), 2e-3);
  EXPECT_GT(angles.mid, angles.upper + 5);  // an S, and one that tells the windows apart
}

// A surface that is steeper on its uphill side: each window is its own, and a fall is positive.
TEST(FreeSurface, UphillIsAtNegativeX) {
  const auto bent = [](double x) { return x < 0 ? -std::tan(40 * pi / 180) * x : -std::tan(25 * pi / 180) * x; };
  const SurfaceAngles angles = surface_angles(points_of(bent, 84), kRadius);
  EXPECT_NEAR(angles.upper, 40, 1e-9);
  EXPECT_NEAR(angles.lower, 25, 1e-9);
  EXPECT_LT(surface_angles(points_of([](double x) { return 0.5 * x; }, 84), kRadius).mid, -26);
}

// The contour lies below the surface, whose shape no grain crosses, by a part of a grain's radius that is the same
// everywhere but for the slope: 1 degree. The sense is that of cases/drum, which lifts the bed at positive y.
TEST(FreeSurface, ABedOfGrainsHasTheSlopesOfItsSurface) {
  std::mt19937_64 random(7);
  Silhouette picture(kRadius);
  const double grain = 0.0006;
  for (int look = 0; look < 24; ++look) picture.add_look(bed(s_shape, grain, 30000, random));
  const std::vector<SurfacePoint> surface = picture.surface();
  const SurfaceAngles angles = surface_angles(surface, kRadius);
  EXPECT_NEAR(angles.mid, s_fall(-0.5, 0.5), 1);
  EXPECT_NEAR(angles.upper, s_fall(-0.62, -0.24), 1);
  EXPECT_NEAR(angles.lower, s_fall(0.24, 0.62), 1);
  for (const SurfacePoint& p : surface) {
    if (std::fabs(p.x) > 0.62 * kRadius) continue;
    EXPECT_LT(p.y, s_shape(p.x) + 1e-4) << p.x;  // a level
    EXPECT_GT(p.y, s_shape(p.x) - grain) << p.x;
  }
}

// A grain in flight in less than half of the looks is none of the surface. Half of the drum is half of its section.
TEST(FreeSurface, GrainsInFlightDoNotRaiseIt) {
  std::mt19937_64 random(8);
  Silhouette calm(kRadius), wild(kRadius);
  const auto plane = [](double x) { return -0.6 * x; };
  for (int look = 0; look < 8; ++look) {
    std::vector<Grain> grains = bed(plane, 0.0006, 30000, random);
    calm.add_look(grains);
    for (int k = 0; k < 40 && look < 3; ++k) grains.push_back({{0, 0.001 * (k - 20), 0.03}, 0.0006});
    wild.add_look(grains);
  }
  EXPECT_EQ(surface_angles(calm.surface(), kRadius).mid, surface_angles(wild.surface(), kRadius).mid);
  EXPECT_NEAR(calm.dark_area(), 0.5, 0.02);  // 0.6 mm of 42 at the mantle and at the surface are not dark everywhere
}

// A window with less than five points, or that the surface does not reach across.
TEST(FreeSurface, TooFewPointsAreRefusedWithTheirWindow) {
  const auto says = [](std::vector<SurfacePoint> points) -> std::string {
    try {
      surface_angles(points, kRadius);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(says(points_of(s_shape, 84)), "");
  EXPECT_NE(says(points_of(s_shape, 12)).find("angle_upper"), std::string::npos) << says(points_of(s_shape, 12));
  std::vector<SurfacePoint> half = points_of(s_shape, 84);
  half.resize(42);  // x < 0 only
  EXPECT_NE(says(half).find("angle_mid"), std::string::npos) << says(half);
  EXPECT_NE(says({}).find("0 points"), std::string::npos) << says({});
}

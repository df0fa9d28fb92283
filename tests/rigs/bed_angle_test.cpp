// SPDX-License-Identifier: GPL-2.0-or-later
// The dynamic angle of a drum's bed on synthetic looks: grains at random places below a plane of known slope.
#include "rigs/drum/bed_angle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/bad_input.h"

using namespace vielto;
namespace fs = std::filesystem;

namespace {

const double pi = 3.14159265358979323846;
constexpr double kRadius = 0.075, kLength = 0.05, kDiameter = 0.004;

class BedAngleOf : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              fmt::format("bed_{}_{}", testing::UnitTest::GetInstance()->current_test_info()->name(), getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string first() const { return (folder_ / "bed_1.csv").string(); }

  // Grains below a plane, `height` above the axis, that falls at `near` degrees next to the end x = 0 and at `far` in
  // the rest of the drum.
  void look(int k, int frames, double tilt, double near, double far, std::mt19937_64& random, int grains = 6000,
            double height = 0) {
    std::uniform_real_distribution<double> one(-1, 1);
    std::ofstream out(folder_ / fmt::format("bed_{}.csv", k));
    out << fmt::format(
        "# schema=1\n# rig=drum\n# turn={}\n# speed=0.083333\n# fill=0.5\n# tilt={}\n# drum_diameter=0.15\n"
        "# drum_length=0.05\n# grain_diameter={}\n# youngs_modulus=1e5\n# dt_over_tc=0.05\n# frames={}\n"
        "# seed=1\n# material=wheat\n# wall=A\n# provisional=0\nx_m,y_m,z_m,radius_m\n",
        0.2 + 0.02 * k, tilt, kDiameter, frames);
    for (int i = 0; i < grains;) {
      const double x = kLength * (0.5 + 0.5 * one(random)), y = kRadius * one(random), z = kRadius * one(random);
      const double slope = std::tan((x < kEndDiameters * kDiameter ? near : far) * pi / 180);
      if (std::hypot(y, z) > kRadius - kDiameter / 2 || z > slope * y + height * std::hypot(1, slope)) continue;
      out << fmt::format("{},{},{},{}\n", x, y, z, kDiameter / 2);
      ++i;
    }
  }

  fs::path folder_;
};

}  // namespace

// The line through the highest grains has the plane's slope: within three of its own standard uncertainties over 12
// looks, which must themselves be small enough to tell 2 degrees.
TEST_F(BedAngleOf, APlaneIsItsSlope) {
  std::mt19937_64 random(3);
  for (const double angle : {20.0, 36.0, 50.0}) {
    for (int k = 1; k <= 12; ++k) look(k, 12, 0, angle, angle, random);
    const BedAngle bed = read_bed_angle(first());
    EXPECT_EQ(bed.looks.size(), 12u);
    EXPECT_EQ(bed.grains, 6000u);
    EXPECT_NEAR(bed.angle.value, angle, 3 * bed.angle.u) << angle;
    EXPECT_LT(bed.angle.u, 1.0) << angle;
  }
}

// More than half of the circle full, the highest grains lie along the mantle; less than half, the chord is short.
TEST_F(BedAngleOf, TheMantleDoesNotBendIt) {
  std::mt19937_64 random(6);
  for (const double angle : {36.0, 50.0, 62.0})
    for (const double height : {0.03, -0.03}) {
      for (int k = 1; k <= 12; ++k) look(k, 12, 0, angle, angle, random, height > 0 ? 9000 : 3000, height);
      const BedAngle bed = read_bed_angle(first());
      EXPECT_NEAR(bed.angle.value, angle, 3 * bed.angle.u) << angle << " at " << height;
      EXPECT_LT(bed.angle.u, 1.0) << angle << " at " << height;
    }
}

// Tilted, only the grains next to the lower end count; level, all of them.
TEST_F(BedAngleOf, ATiltedDrumIsLookedAtNextToItsLowerEnd) {
  std::mt19937_64 random(4);
  for (int k = 1; k <= 6; ++k) look(k, 6, 45, 55, 30, random, 12000);
  const BedAngle tilted = read_bed_angle(first());
  EXPECT_NEAR(tilted.angle.value, 55, 3 * tilted.angle.u);
  for (const Grain& g : tilted.last) EXPECT_LT(g.x[0], kEndDiameters * kDiameter);
}

// A plane has one slope, whichever window it is seen through; too few looks, or a tilted axis, show none. Half a circle
// of grains is half of the section, but for the grains' own roundness at its edges.
TEST_F(BedAngleOf, APlaneHasItsSlopeInEveryWindow) {
  std::mt19937_64 random(9);
  for (int k = 1; k <= 18; ++k) look(k, 18, 0, 36, 36, random, 12000);
  const BedAngle bed = read_bed_angle(first());
  ASSERT_TRUE(bed.surface) << bed.no_surface;
  for (const SurfaceWindow& window : kSurfaceWindows) {
    EXPECT_LT(bed.surface->u.*window.angle, 0.5) << window.observable;
    EXPECT_NEAR(bed.surface->angles.*window.angle, 36, 4 * bed.surface->u.*window.angle) << window.observable;
  }
  EXPECT_NEAR(bed.surface->area.value, 0.5, 0.02);
  for (int k = 1; k <= 17; ++k) look(k, 17, 0, 36, 36, random);
  EXPECT_FALSE(read_bed_angle(first()).surface);
  for (int k = 1; k <= 18; ++k) look(k, 18, 45, 36, 36, random);
  EXPECT_EQ(read_bed_angle(first()).no_surface, "the axis is tilted");
}

TEST_F(BedAngleOf, RefusesLooksThatAreNotThereOrOfAnotherRun) {
  std::mt19937_64 random(5);
  look(1, 3, 0, 30, 30, random);
  look(2, 3, 0, 30, 30, random);
  EXPECT_THROW(read_bed_angle(first()), BadInput);  // no third look
  look(3, 3, 0, 30, 30, random, 5000);              // other grains
  EXPECT_THROW(read_bed_angle(first()), BadInput);
  look(3, 3, 0, 30, 30, random);
  EXPECT_NO_THROW(read_bed_angle(first()));
  look(1, 1, 0, 30, 30, random, 3);  // no surface
  EXPECT_THROW(read_bed_angle(first()), BadInput);
}

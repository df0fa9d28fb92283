// SPDX-License-Identifier: GPL-2.0-or-later
// The cone fit on synthetic heaps of known angle: grains at random places below a cone's surface.
#include "rigs/repose/cone_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "core/bad_input.h"

using namespace vielto;

namespace {

const double pi = 3.14159265358979323846;

struct Cone {
  double angle = 26;     // deg
  double height = 20;    // diameters
  double packing = 0.6;  // volume of the grains over that of the cone
  double off_axis = 0;   // diameters
  double ridge = 0;      // deg: one side steeper, the other flatter by this
};

// Places without regard to each other: the noise of the surface is that of a loose bed or worse.
Heap heap(const Cone& cone, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> one(-1, 1), height(0, 1);
  Heap h;
  h.header.grain_diameter = 0.003;
  const double d = h.header.grain_diameter, H = cone.height * d, foot = H / std::tan(cone.angle * pi / 180);
  const double reach = foot + 5 * d;
  const long tries = std::lround(cone.packing * 4 * reach * reach * H / (pi / 6 * d * d * d));
  for (long i = 0; i < tries; i++) {
    const double x = reach * one(random), y = reach * one(random), z = H * height(random);
    const double r = std::hypot(x, y);
    const double angle = cone.angle + cone.ridge * (r > 0 ? x / r : 0);
    if (z < H - r * std::tan(angle * pi / 180)) h.grains.push_back({{x + cone.off_axis * d, y, z}, d / 2});
  }
  return h;
}

}  // namespace

// Over 20 heaps the mean of the angle is the cone's within three standard uncertainties of that mean, and the stated u
// covers what a heap is off: two of u hold in 95 % of heaps, so at least 16 of 20 (probability of fewer: 0.3 %).
class ConeFitOf : public testing::TestWithParam<double> {};

TEST_P(ConeFitOf, KnownAngleIsUnbiasedAndCovered) {
  Cone cone;
  cone.angle = GetParam();
  double mean = 0, square = 0;
  int covered = 0;
  for (unsigned seed = 1; seed <= 20; seed++) {
    const ConeFit fit = cone_fit(heap(cone, seed));
    mean += fit.angle / 20;
    square += fit.angle * fit.angle / 20;
    covered += std::fabs(fit.angle - cone.angle) < 2 * fit.u;
    EXPECT_LT(fit.u, 1);
    EXPECT_EQ(fit.strip_angles.size(), 24u);
  }
  EXPECT_NEAR(mean, cone.angle, 3 * std::sqrt((square - mean * mean) / 19) + 1e-3);
  EXPECT_GE(covered, 16);
}

INSTANTIATE_TEST_SUITE_P(Degrees, ConeFitOf, testing::Values(15.0, 26.0, 38.0));

// A heap two diameters off its axis: the mean over the azimuth stays within half a degree, where the strips differ.
TEST(ConeFit, BearsAHeapOffItsAxis) {
  Cone cone;
  cone.off_axis = 2;
  EXPECT_NEAR(cone_fit(heap(cone, 1)).angle, cone.angle, 1.0);
}

// However far off its axis a heap stands: over 20 heaps the mean angle is the cone's within three standard
// uncertainties.
TEST(ConeFit, MeasuresAHeapAboutItsOwnSummit) {
  for (const double off_axis : {6.0, 15.0}) {
    Cone cone;
    cone.angle = 30;
    cone.off_axis = off_axis;
    double mean = 0, square = 0;
    for (unsigned seed = 1; seed <= 20; seed++) {
      const ConeFit fit = cone_fit(heap(cone, seed));
      EXPECT_TRUE(fit.about_summit);
      EXPECT_NEAR(fit.off_axis / 0.003, off_axis, 1);
      mean += fit.angle / 20;
      square += fit.angle * fit.angle / 20;
    }
    EXPECT_NEAR(mean, cone.angle, 3 * std::sqrt((square - mean * mean) / 19) + 1e-3) << off_axis;
  }
  EXPECT_FALSE(cone_fit(heap(Cone(), 1)).about_summit);
}

// A cone over 24 azimuths is off itself by its grains alone. Two that stand apart by their height are measured about
// the middle between them: no slope of theirs.
TEST(ConeFit, WarnsOfWhatIsNoCone) {
  const Heap one = heap(Cone(), 1);
  EXPECT_TRUE(cone_fit(one).warnings.empty());
  EXPECT_LT(cone_fit(one).off_cone, one.header.grain_diameter);
  Cone left, right;
  left.off_axis = -20;
  right.off_axis = 20;
  Heap two = heap(left, 1);
  const Heap other = heap(right, 2);
  two.grains.insert(two.grains.end(), other.grains.begin(), other.grains.end());
  const ConeFit fit = cone_fit(two);
  ASSERT_EQ(fit.warnings.size(), 1u) << fit.off_cone;
  EXPECT_NE(fit.warnings[0].find("off a cone"), std::string::npos);
}

TEST(ConeFit, ShowsAnglesThatDifferOverTheAzimuth) {
  Cone cone;
  cone.ridge = 6;
  const ConeFit even = cone_fit(heap(Cone(), 1)), uneven = cone_fit(heap(cone, 1));
  EXPECT_NEAR(uneven.angle, cone.angle, 1.0);
  EXPECT_NEAR(uneven.spread, std::sqrt(even.spread * even.spread + 6.0 * 6.0 / 2), 1.5);
}

// Sectors instead of strips of one width would hold more grains further out and flatten the line; so would the choice
// of the flank by the height of single cells. Both show as a curvature or bias that this cone does not have.
TEST(ConeFit, SeesNoCurvatureInAStraightFlank) {
  double mean = 0;
  for (unsigned seed = 1; seed <= 20; seed++) mean += cone_fit(heap(Cone(), seed)).curvature / 20;
  EXPECT_NEAR(mean, 0, 0.6);
}

TEST(ConeFit, RefusesALayerWithoutAFlank) {
  Cone cone;
  cone.height = 2;
  cone.angle = 45;
  EXPECT_THROW(cone_fit(heap(cone, 1)), BadInput);
}

TEST(ReadHeap, RefusesABrokenFile) {
  const std::string path = testing::TempDir() + "heap.csv";
  const std::string keys =
      "# schema=1\n# rig=repose\n# lift_speed=0.05\n# grain_diameter=0.003\n# cylinder_diameter=0.05\n"
      "# youngs_modulus=2e5\n# dt_over_tc=0.05\n# rest_time=1.2\n# base=plain\n# seed=1\n# material=m\n# wall=w\n"
      "# provisional=1\nx_m,y_m,z_m,radius_m\n";
  const auto fails = [&](const std::string& text, const std::string& why) {
    std::ofstream(path) << text;
    try {
      read_heap(path);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const BadInput& e) {
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  std::ofstream(path) << keys + "0,0,0.001,0.0015\n";
  EXPECT_EQ(read_heap(path).grains.size(), 1u);
  fails(keys, "holds no grain");
  fails(keys + "0,0,0.001,0.0015\n0,0,0.0", "cut off");
  fails(keys + "0,0,nan,0.0015\n", "not a finite number");
  fails(keys + "0,0,0.001,0\n", "is not above 0");
  fails(keys.substr(keys.find('\n') + 1), "lacks the key 'schema'");
}

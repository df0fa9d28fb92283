// SPDX-License-Identifier: GPL-2.0-or-later
// cases/drum from filling to the looks at the bed, and the angle that `vielto post` makes of them.
#include <nlohmann/json.hpp>

#include "rig_runner.h"

using namespace vielto_test;
namespace fs = std::filesystem;

namespace {

// Grains of 8 mm turned fast.
const std::string coarse_drum =
    "-var grainDiameter 0.008 -var youngsModulus 2e4 -var wall_youngsModulus 2e4 -var speed 0.5 -var startAngle 60 "
    "-var frames 4 -var frameAngle 10 -var maxOverlap 0.5 ";

// Where the grains lie on average, across the axis and along it.
struct Middle {
  double x = 0, y = 0, z = 0;
};
Middle middle(const Table& grains) {
  Middle m;
  const double n = static_cast<double>(grains.rows.size());
  for (std::size_t k = 0; k < grains.rows.size(); k++) {
    m.x += grains.at(k, "x_m") / n;
    m.y += grains.at(k, "y_m") / n;
    m.z += grains.at(k, "z_m") / n;
  }
  return m;
}

}  // namespace

TEST(DrumRun, TurnsABedWithAnAngle) {
  Rig rig("drum");
  rig.must("run", coarse_drum, "-var frames 18 -var frameAngle 6 -var rollingResistance 0.001 ");
  const Table first = rig.csv("run/bed_1.csv"), last = rig.csv("run/bed_18.csv");
  // 780 kg/m3 in half of the drum, of grains with the three sizes' mean mass; the chords cut off 0.07 % of the circle
  const double d = 0.008, s = 0.05 * std::sqrt(3);
  const double volume = pi / 6 * d * d * d * (2.0 / 3 + (std::pow(1 - s, 3) + std::pow(1 + s, 3)) / 6);
  EXPECT_NEAR(static_cast<double>(first.rows.size()), 0.5 * 780 * pi * 0.075 * 0.075 * 0.05 / (1400 * volume), 1);
  EXPECT_EQ(first.rows.size(), last.rows.size());
  for (std::size_t k = 0; k < last.rows.size(); k++) EXPECT_LT(std::hypot(last.at(k, "y_m"), last.at(k, "z_m")), 0.075);
  // turning from y to z (right-handed about x) lifts the bed on the side of positive y
  EXPECT_GT(middle(last).y, 0.005);
  EXPECT_LT(middle(last).z, 0);
  const Outcome done = rig.vielto("post run --test coarse");
  ASSERT_EQ(done.status, 0) << done.text;
  const auto json = nlohmann::json::parse(rig.read("run/post/drum.json"));
  EXPECT_GT(json["angle_deg"], 10);
  EXPECT_LT(json["angle_deg"], 60);
  const std::string rows = rig.read("run/post/observations.csv");
  EXPECT_NE(rows.find("coarse,fit,drum,angle,"), std::string::npos);
  // the surface is carried up at negative x and falls along x: positive slopes
  for (const std::string slope : {"angle_mid", "angle_upper", "angle_lower"}) {
    EXPECT_NE(rows.find("coarse,fit,drum," + slope + ","), std::string::npos) << rows;
    EXPECT_GT(json[slope + "_deg"], 5) << slope;
    EXPECT_LT(json[slope + "_deg"], 70) << slope;
  }
  const Table surface = rig.csv("run/post/surface.csv");
  EXPECT_GT(surface.at(10, "y_m"), surface.at(surface.rows.size() - 10, "y_m"));
}

// The tilt turns gravity: the bed rests on the end face x = 0.
TEST(DrumRun, TiltedRestsOnItsLowerEnd) {
  Rig rig("drum");
  rig.must("level", coarse_drum, "-var startAngle 10 -var frames 3 -var frameAngle 3 ");
  rig.must("tilted", coarse_drum, "-var startAngle 10 -var frames 3 -var frameAngle 3 -var tilt 60 ");
  EXPECT_NEAR(middle(rig.csv("level/bed_3.csv")).x, 0.025, 0.002);
  EXPECT_LT(middle(rig.csv("tilted/bed_3.csv")).x, 0.022);
}

class DrumRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(DrumRefuses, WithOneLine) {
  Rig rig("drum");
  const Outcome outcome = rig.rig("run", coarse_drum, GetParam().option);
  expect_refusal(rig.folder / "run", outcome, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, DrumRefuses,
    testing::Values(Refusal{"NoSpeed", "-var speed 0", {"speed is 0", "> 0"}},
                    Refusal{"NoGravity", "-var gravity 0", {"gravity is 0", "> 0"}},
                    Refusal{"NoBulkDensity", "-var bulkDensity 0", {"bulkDensity is 0", "> 0"}},
                    Refusal{"TooFull", "-var fill 0.9", {"fill is 0.9", "0.6"}},
                    Refusal{"TiltedOver", "-var tilt 90", {"tilt is 90", "0 to 80"}},
                    Refusal{"GrainTooLarge", "-var grainDiameter 0.02", {"grainDiameter is 0.02", "drumLength"}},
                    Refusal{"TwoLooks", "-var frames 2", {"frames is 2", ">= 3"}},
                    Refusal{"TimeStepOverLimit", "-var dtFraction 0.06", {"dtFraction is 0.06", "0.05"}},
                    Refusal{"UnknownWall", "-var wall marble", {"marble.par", "name an existing"}},
                    Refusal{"MisspelledParameter", "-var titl 1", {"-var titl", "no such parameter"}}),
    name_of);

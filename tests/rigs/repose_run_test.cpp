// SPDX-License-Identifier: GPL-2.0-or-later
// cases/repose from filling to the heap's grains, and the angle that `vielto post` makes of it.
#include <nlohmann/json.hpp>

#include "rig_runner.h"

using namespace vielto_test;
namespace fs = std::filesystem;

namespace {

// Asked for: 825 kg/m3 in the cylinder's inscribed circle up to 50 mm, of grains with the three sizes' mean mass.
double grains_asked() {
  const double d = 0.005, s = 0.0556 * std::sqrt(3);
  const double volume = pi / 6 * d * d * d * (2.0 / 3 + (std::pow(1 - s, 3) + std::pow(1 + s, 3)) / 6);
  return 825 * pi * std::pow(0.025 * std::cos(pi / 36), 2) * 0.05 / (1375 * volume);
}

}  // namespace

TEST(ReposeRun, LeavesAHeapOfAllGrainsWithAnAngle) {
  Rig rig("repose");
  rig.must("run", coarse_heap);
  const Table grains = rig.csv("run/heap.csv");
  EXPECT_EQ(static_cast<double>(grains.rows.size()), std::round(grains_asked()));
  double highest = 0, farthest = 0;
  for (std::size_t k = 0; k < grains.rows.size(); k++) {
    const double z = grains.at(k, "z_m"), r = grains.at(k, "radius_m");
    EXPECT_GT(z, 0.9 * r);
    highest = std::max(highest, z + r);
    farthest = std::max(farthest, std::hypot(grains.at(k, "x_m"), grains.at(k, "y_m")));
  }
  EXPECT_LT(highest, 0.045);  // it slumped from 50 mm
  EXPECT_GT(highest, 0.01);
  EXPECT_GT(farthest, 0.03);
  const Outcome done = rig.vielto("post run --test coarse");
  ASSERT_EQ(done.status, 0) << done.text;
  const auto json = nlohmann::json::parse(rig.read("run/post/repose.json"));
  EXPECT_GT(json["angle_deg"], 5);
  EXPECT_LT(json["angle_deg"], 40);
  EXPECT_NE(rig.read("run/post/observations.csv").find("coarse,fit,repose,angle,"), std::string::npos);
}

// As many clumps as spheres of the same volume and mass, each of five spheres; their number, not that of the spheres,
// is told. The room is so low that some of the three sizes are put in when the others have fallen.
TEST(ReposeRun, TakesClumps) {
  Rig rig("repose");
  const std::string corn = "-var grain fodder_corn -var fillHeight 0.03 -var cylinderHeight 0.07 ";
  rig.must("clumps", coarse_heap, corn + "-var clump yes");
  rig.must("spheres", coarse_heap, corn);
  const std::string log = rig.read("clumps/log.liggghts");
  int times = 0;
  for (std::size_t at = 0; (at = log.find("\nunfix insert\n", at)) != std::string::npos; at++) times++;
  EXPECT_GT(times, 3);
  const Table clumps = rig.csv("clumps/heap.csv"), spheres = rig.csv("spheres/heap.csv");
  EXPECT_EQ(clumps.rows.size(), 5 * spheres.rows.size());
  for (std::size_t k = 0; k < clumps.rows.size(); k++) EXPECT_GT(clumps.at(k, "z_m"), 0.7 * clumps.at(k, "radius_m"));
  const auto run = nlohmann::json::parse(rig.read("clumps/run.json"));
  EXPECT_EQ(run["parameters"]["rollingResistance"], "0");
  for (const char* file : {"../../materials/fodder_corn.clump", "../clumps.in", "../clumps_of_size.in"})
    EXPECT_TRUE(run["hashes"].contains(file)) << file;
  EXPECT_FALSE(
      nlohmann::json::parse(rig.read("spheres/run.json"))["hashes"].contains("../../materials/fodder_corn.clump"));
  const Outcome done = rig.vielto("post clumps --test coarse");
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_EQ(nlohmann::json::parse(rig.read("clumps/post/repose.json"))["grains"], spheres.rows.size());
}

// Clumps are put in over several runs: the fixed grains of a rough base are there before the first falls, and none gets
// through.
TEST(ReposeRun, HoldsClumpsOnARoughBase) {
  Rig rig("repose");
  rig.must("clumps", coarse_heap,
           "-var grain fodder_corn -var clump yes -var fillHeight 0.02 -var base rough -var baseGrain 0.6 -var "
           "baseWidth 0.2");
  const Table spheres = rig.csv("clumps/heap.csv");
  EXPECT_EQ(spheres.rows.size() % 5, 0u);
  EXPECT_GT(spheres.rows.size(), 5 * 100u);
  for (std::size_t k = 0; k < spheres.rows.size(); k++) EXPECT_GT(spheres.at(k, "z_m"), 0);
}

TEST(ReposeRun, IsDecidedByItsSeed) {
  Rig rig("repose");
  const std::string small = "-var fillHeight 0.02 ";
  rig.must("a", coarse_heap, small);
  rig.must("b", coarse_heap, small);
  rig.must("other", coarse_heap, small + "-var seed 2");
  EXPECT_EQ(rig.read("a/heap.csv"), rig.read("b/heap.csv"));
  EXPECT_NE(rig.csv("a/heap.csv").at(0, "x_m"), rig.csv("other/heap.csv").at(0, "x_m"));
}

// On a rough base fixed grains hold the foot: the heap is steeper, and they are no part of it.
TEST(ReposeRun, StandsSteeperOnARoughBase) {
  Rig rig("repose");
  rig.must("plain", coarse_heap, "-var wall_frictionAngle 5");
  rig.must("rough", coarse_heap, "-var wall_frictionAngle 5 -var base rough");
  const auto highest = [&](const std::string& run) {
    const Table grains = rig.csv(run + "/heap.csv");
    EXPECT_EQ(static_cast<double>(grains.rows.size()), std::round(grains_asked()));
    double top = 0;
    for (std::size_t k = 0; k < grains.rows.size(); k++) top = std::max(top, grains.at(k, "z_m"));
    return top;
  };
  EXPECT_GT(highest("rough"), highest("plain"));
}

class ReposeRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(ReposeRefuses, WithOneLine) {
  Rig rig("repose");
  const Outcome outcome = rig.rig("run", coarse_heap, GetParam().option);
  expect_refusal(rig.folder / "run", outcome, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, ReposeRefuses,
    testing::Values(
        Refusal{"NoLiftSpeed", "-var liftSpeed 0", {"liftSpeed is 0", "> 0"}},
        Refusal{"FillOverCylinder", "-var fillHeight 0.07", {"fillHeight is 0.07", "cylinderHeight"}},
        Refusal{"GrainTooLarge", "-var grainDiameter 0.006", {"grainDiameter is 0.006", "cylinderDiameter"}},
        Refusal{"BaseOfNoGrains", "-var base rough -var baseGrain 0", {"baseGrain is 0", "> 0"}},
        Refusal{"NoGravity", "-var gravity 0", {"gravity is 0", "> 0"}},
        Refusal{"NoBulkDensity", "-var bulkDensity 0", {"bulkDensity is 0", "> 0"}},
        Refusal{"ClumpsOfHooke", "-var grain fodder_corn -var clump yes -var law hooke", {"law hooke", "clump no"}},
        Refusal{"UnknownBase", "-var base sticky", {"base is 'sticky'", "plain or rough"}},
        Refusal{"TimeStepOverLimit", "-var dtFraction 0.06", {"dtFraction is 0.06", "0.05"}},
        Refusal{"MisspelledParameter", "-var liftspeed 1", {"-var liftspeed", "no such parameter"}},
        Refusal{"BaseTooSmall", "-var baseWidth 0.04", {"vielto geometry", "failed"}},
        Refusal{"NoClump", "-var clump yes", {"hulled_millet.clump", "missing"}},
        Refusal{"UnknownShape", "-var clump maybe", {"clump is 'maybe'", "no or yes"}},
        Refusal{"ClumpsFallThrough",
                "-var grain hulled_barley -var clump yes -var base rough",
                {"fall through", "baseGrain"}},
        Refusal{"ClumpsInAir", "-var grain fodder_corn -var clump yes -var airDrag 1", {"airDrag is 1", "clump no"}},
        Refusal{
            "ClumpsOfCohFrict", "-var grain fodder_corn -var clump yes -var law cohfrict", {"law vielto", "clump no"}},
        Refusal{"ClumpsWithRollingDashpot",
                "-var grain fodder_corn -var clump yes -var rollingDashpot on",
                {"rollingDashpot", "clump no"}},
        Refusal{"NeverAtRest", "-var restDistance 1e-12 -var mostTime 0.15", {"not at rest", "mostTime"}}),
    name_of);

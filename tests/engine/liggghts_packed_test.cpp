// SPDX-License-Identifier: GPL-2.0-or-later
/* Contacts evaluated several at once give the numbers of contacts evaluated one by one to the last digit: IEEE 754
   rounds each operation of a lane as that of a single number, none are fused, and forces are added in the same order.
   So there is no tolerance here. (The loop one by one is held to LIGGGHTS' own in liggghts_pair_loop_test.) */
#include <stdlib.h>

#include "tests/rigs/sheared_bed.h"

namespace {

using namespace vielto_test;

// Contacts at once for the programs started while this lives.
struct Lanes {
  explicit Lanes(const std::string& lanes) { setenv("VIELTO_LANES", lanes.c_str(), 1); }
  ~Lanes() { unsetenv("VIELTO_LANES"); }
};

// Those of this processor.
std::vector<std::string> lanes() {
  std::vector<std::string> found;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("x86-64-v3")) found.push_back("4");
  if (__builtin_cpu_supports("x86-64-v4")) found.push_back("8");
#else
  found.push_back("");
#endif
  return found;
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

struct Setting {
  std::string name, models, settings, extra;
  std::vector<Material> materials;
  int ranks;
};
void PrintTo(const Setting& s, std::ostream* out) { *out << s.name; }

// The sheared bed without energy accounts, which are kept one by one; grains of two types where there are two
// materials.
std::string bed(const Liggghts& run, const Setting& s) {
  std::vector<Sphere> spheres = bed_grains();
  for (std::size_t i = 0; i < spheres.size(); i++)
    if (s.materials.size() > 1) spheres[i].type = 1 + static_cast<int>(i * i % 5 > 1);
  std::string text = head(run, spheres, s.materials, 0.1, s.settings) + s.extra + bed_walls(run, "", 500, 500);
  replace(text, bed_settings, s.settings);
  replace(text, vielto_models, s.models);
  replace(text, " energy on", "");
  if (s.extra.find("group moving") != std::string::npos)
    for (const std::string fix : {"nve/sphere", "gravity"}) replace(text, "all " + fix, "moving " + fix);
  if (s.models.find("rolling") == std::string::npos)
    for (int column = 7; column <= 10; column++)
      for (const std::string name : {"pair", "wall"}) replace(text, fmt::format(" c_{}[{}]", name, column), "");
  if (s.models.find("rolling") == std::string::npos)
    replace(text, "format \"%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\"",
            "format \"%.17g %.17g %.17g %.17g %.17g\"");
  // the seam of two ranks is x = 0, in the middle of the bed
  return (s.ranks > 1 ? "processors 2 1 1\n" : "") + text + "run 8000\n";
}

class Packed : public testing::TestWithParam<Setting> {};

TEST_P(Packed, GivesTheNumbersOfContactsOneByOne) {
  const auto states = [&](const std::string& lanes) {
    const Lanes set(lanes);
    Liggghts run;
    run.script = bed(run, GetParam());
    run.must(GetParam().ranks);
    return run.read("state") + run.read("pair") + run.read("wall") + run.read("torque.csv");
  };
  const std::string one = states("1");
  EXPECT_GT(one.size(), 10000u);
  ASSERT_FALSE(lanes().empty()) << "this processor has no vector unit to test";
  for (const std::string& many : lanes()) EXPECT_TRUE(states(many) == one) << many << " contacts at once differ";
}

Material stiffer() {
  Material m;
  m.youngsModulus = 3e6, m.stiffnessRatio = 0.7, m.frictionAngle = 15, m.normalDamping = 0.1, m.rollingResistance = 0.3;
  return m;
}

const std::string adhesive =
    "fix strength all property/global adhesionStrength scalar 500\n";  // about the weight of a grain

INSTANTIATE_TEST_SUITE_P(
    , Packed,
    testing::Values(
        Setting{"OneMaterial", vielto_models, bed_settings, "", {Material()}, 1},
        Setting{"AsPrinted", vielto_models, "slidingDashpot on", "", {Material()}, 1},
        Setting{"TwoMaterials", vielto_models, bed_settings, "", {Material(), stiffer()}, 1},
        Setting{"EverySetting",
                vielto_models,
                "slidingDashpot off springFactor 1 limitForce on radiusLever off rollingDashpot on wallRadiusFactor 3",
                "",
                {Material(), stiffer()},
                1},
        Setting{"Adhesion",
                "model vielto tangential vielto cohesion adhesion rolling_friction vielto",
                bed_settings,
                adhesive,
                {Material()},
                1},
        Setting{"NoRolling", "model vielto tangential vielto", bed_settings, "", {Material()}, 1},
        Setting{"FrozenGrains",
                vielto_models,
                bed_settings,
                "group held id 1:64:7\nfix hold held freeze\n",
                {Material()},
                1},
        Setting{"SomeGrainsMove", vielto_models, bed_settings, "group moving id 1:20 25:64\n", {Material()}, 1},
        Setting{"TwoRanks", vielto_models, bed_settings, "", {Material(), stiffer()}, 2}),
    [](const auto& one) { return one.param.name; });

struct Floor {
  std::string name, motion;
  int steps;
};
void PrintTo(const Floor& f, std::ostream* out) { *out << f.name; }
class WallLoop : public testing::TestWithParam<Floor> {};

/* The wall loop, which looks at the grains near a mesh only, and LIGGGHTS' own, which it leaves a wall to that stores
   its contact forces: a floor that turns about a point off its middle, so that its edges sweep under the grains at 2
   m/s, and one that rises at 4 m/s into grains which barely move. */
TEST_P(WallLoop, GivesTheNumbersOfLiggghts) {
  std::string states[2];
  for (const bool general : {false, true}) {
    Liggghts run;
    run.script = bed(run, {"", vielto_models, bed_settings, "", {Material(), stiffer()}, 1});
    if (general) replace(run.script, "meshes floor", "meshes floor store_force_contact yes");
    replace(run.script, "rotate origin 0 0 0 axis 0 0 1 period 1", GetParam().motion);
    // the record refuses a floor that moves otherwise than it says
    const std::size_t record = run.script.find("fix record");
    run.script.replace(record, run.script.find('\n', record) - record,
                       "fix mean all ave/time 1 100 100 f_floor[1] f_floor[2] f_floor[3] f_floor[4] f_floor[5] "
                       "f_floor[6] file torque.txt");
    replace(run.script, "run 8000", fmt::format("run {}", GetParam().steps));
    run.write("floor.stl", plate_stl(0.045));
    run.must();
    states[general] = run.read("state") + run.read("wall") + run.read("torque.txt");
  }
  EXPECT_GT(states[0].size(), 10000u);
  EXPECT_TRUE(states[0] == states[1]);
}

INSTANTIATE_TEST_SUITE_P(Floor, WallLoop,
                         testing::Values(Floor{"Turns", "rotate origin 0.01 0.01 0 axis 0 0 1 period 0.2", 8000},
                                         Floor{"Rises", "wiggle amplitude 0 0 0.002 period 0.003", 1200}),
                         [](const auto& one) { return one.param.name; });

/* A floor that turns about a skew axis, with the stresses of its triangles at outputs: on one rank, and on two that
   share the floor. On one rank the record ends the run between two outputs, and then `write_dump` asks. */
class TurningMesh : public testing::TestWithParam<int> {};

TEST_P(TurningMesh, IsMovedAndStressedAsLiggghtsDoesIt) {
  const int ranks = GetParam();
  const auto states = [&](const std::string& lanes) {
    const Lanes set(lanes);
    Liggghts run;
    run.script = bed(run, {"", vielto_models, bed_settings, "", {Material(), stiffer()}, ranks});
    replace(run.script, "axis 0 0 1 period 1", "axis 0.01 -0.02 1 period 1");
    replace(run.script, "every 500 file torque.csv speed 1 axis 0 0 1",
            "every 50 file torque.csv speed 1 axis 0.01 -0.02 1");
    replace(run.script, "run 8000",
            std::string("dump mesh all mesh/vtk 700 mesh*.vtk stress vel id\n") +
                (ranks == 1 ? "fix_modify record until 0.9 1\nrun 30000\n" : "run 1400\n") +
                "write_dump all mesh/vtk end.vtk stress vel id\n");
    run.must(ranks);
    const std::string rows = run.read("torque.csv");
    const long last = std::stol(rows.substr(rows.rfind('\n', rows.size() - 2) + 1));
    if (ranks == 1) {
      EXPECT_LT(last, 30000) << "the record was to end the run";
      EXPECT_NE(last % 700, 0) << "the run ends at an output";
    }
    std::string text = run.read("state") + rows + run.read("end.vtk");
    for (long step = 700; step <= last; step += 700) text += run.read(fmt::format("mesh{}.vtk", step));
    return text;
  };
  const std::string one = states("1");
  EXPECT_NE(one.find("stress"), std::string::npos);
  for (const std::string& many : lanes()) EXPECT_TRUE(states(many) == one) << many << " vectors at once differ";
}

INSTANTIATE_TEST_SUITE_P(Ranks, TurningMesh, testing::Values(1, 2));

// In the thermo line, where LIGGGHTS' own fix gravity sums it in each step.
TEST(PackedGravity, TellsTheSameEnergy) {
  const auto energies = [](const std::string& lanes) {
    const Lanes set(lanes);
    Liggghts run;
    run.script = bed(run, {"", vielto_models, bed_settings, "", {Material()}, 1});
    replace(run.script, "run 8000", "fix energy all ave/time 10 1 10 f_gravity file energy.txt\nrun 500");
    run.must();
    return run.read("energy.txt");
  };
  const std::string one = energies("1");
  EXPECT_GT(std::count(one.begin(), one.end(), '\n'), 40);
  for (const std::string& many : lanes()) EXPECT_EQ(energies(many), one);
}

// The step, the grains and the place of a stop at the overlap limit.
TEST(PackedStop, SaysWhatContactsOneByOneSay) {
  const auto text = [&](const std::string& lanes) {
    const Lanes set(lanes);
    Liggghts run;
    Setting soft = {"", vielto_models, "slidingDashpot off maxOverlap 0.01", "", {Material()}, 1};
    soft.materials[0].youngsModulus = 1e4;
    run.script = bed(run, soft);
    const Outcome done = run.start();
    EXPECT_NE(done.status, 0);
    const std::size_t at = done.text.find("ERROR");
    return at == std::string::npos ? "no error" : done.text.substr(at);
  };
  const std::string one = text("1");
  EXPECT_NE(one.find("m with grain"), std::string::npos) << one;
  for (const std::string& many : lanes()) EXPECT_EQ(text(many), one);
}

TEST(PackedLanes, ThatThereAreNotAreRefused) {
  const Lanes set("3");
  Liggghts run;
  run.script = bed(run, {"", vielto_models, bed_settings, "", {Material()}, 1});
  expect_refusal(run.folder / "run", run.start(), {"VIELTO_LANES=3", "contacts at once", "unset it"});
}

}  // namespace

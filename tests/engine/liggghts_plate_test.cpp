// SPDX-License-Identifier: GPL-2.0-or-later
// `fix vielto/plate` through `liggghts`, against closed forms: free fall, sinking against a damper, a plate on a column
// of grains as a spring and a dashpot, its weight at rest; restart, two ranks, and what it refuses.
#include "liggghts_runner.h"

namespace {

using namespace vielto_test;

const double R = 0.005, g = 9.81, E = 1e7;
const int columns = 4;

double grain_mass() { return Sphere{1, R}.mass(); }
// Spring and dashpot of a grain on a wall with R_2 = 2 R_1: k_1 = 2 E R, k_2 = 4 E R, times c_n = 4.
double contact_spring() { return 4 * 2 * (2 * E * R) * (4 * E * R) / (6 * E * R); }
double contact_dashpot(double beta) { return 2 * std::sqrt(contact_spring() / 4 * grain_mass()) * beta; }

// Four grains on a floor and a plate at the height of their tops.
std::string column(const Liggghts& run, const std::string& plate, double beta = 0, double dt = 2e-6) {
  run.write("floor.stl", plate_stl(0.05));
  run.write("plate.stl", stl({{{0, 0, 0.1}, 0.03 * Vec::UnitX(), -0.03 * Vec::UnitY()}}));
  std::vector<Sphere> grains;
  for (const double x : {-0.02, 0.02})
    for (const double y : {-0.02, 0.02}) grains.push_back({1, R, 1375, {x, y, R}, Vec::Zero(), Vec::Zero()});
  Material material;
  material.youngsModulus = E;
  material.normalDamping = beta;
  return head(run, grains, {material}, 0.2) +
         "fix floor all mesh/surface/stress file floor.stl type 1\n"
         "fix lid all mesh/surface/stress file plate.stl type 1\n" +
         fmt::format("fix wall all wall/gran {} mesh n_meshes 2 meshes floor lid\n", vielto_models) +
         fmt::format("timestep {}\nfix move all nve/sphere\nfix gravity all gravity {} vector 0 0 -1\n", dt, g) +
         "fix plate all vielto/plate mesh lid " + plate +
         "\nvariable z equal f_plate[1]\nvariable v equal f_plate[2]\nvariable F equal f_plate[3]\n"
         "thermo_style custom step v_z v_v v_F\nthermo_modify format float %.17g\n";
}

}  // namespace

// z = z0 - g t^2/2 and v = -g t, which velocity Verlet gives exactly; what is left is the round-off of 1000 additions.
TEST(Plate, FallsFreely) {
  Liggghts run;
  run.script = column(run, "mass 0.3 start 0.15", 0, 1e-5) + "thermo 100\nrun 1000\n";
  run.must();
  const Table t = run.thermo();
  ASSERT_EQ(t.rows.size(), 11u);
  for (std::size_t k = 0; k <= 10; k++) {
    const double time = 1e-3 * static_cast<double>(k);
    EXPECT_NEAR(t.at(k, "z"), 0.15 - 0.5 * g * time * time, 1e-14);
    EXPECT_NEAR(t.at(k, "v"), -g * time, 1e-13);
    EXPECT_EQ(t.at(k, "F"), 0);
  }
}

// v = -(M g/c)(1 - exp(-c t/M)), which the fix takes step by step; what is left is round-off.
TEST(Plate, SinksAgainstItsDamper) {
  Liggghts run;
  const double M = 0.3, c = 30;
  run.script = column(run, fmt::format("mass {} damping {} start 0.15", M, c), 0, 1e-5) + "thermo 1000\nrun 4000\n";
  run.must();
  const Table t = run.thermo();
  ASSERT_EQ(t.rows.size(), 5u);
  for (std::size_t k = 1; k <= 4; k++) {
    const double expected = -M * g / c * (1 - std::exp(-c * 1e-2 * static_cast<double>(k) / M));
    EXPECT_NEAR(t.at(k, "v"), expected, 1e-11 * std::fabs(expected));
  }
}

// Let go at the tops of the grains, the plate swings about its depth at rest: two contacts in series in each column,
//   (M + n m/4) z'' + n c/2 z' + n k/2 z = -(M + n m/2) g     (a grain moves half as far as the plate)
// so z = -A (1 - exp(-s t)(cos w t + s/w sin w t)). Without the plate's velocity in the contacts the dashpots between
// grains and plate would see the grains' half of it only. Tolerance: the grain's own vibration, n m/(2 M) of A.
class PlateOnGrains : public testing::TestWithParam<double> {};

TEST_P(PlateOnGrains, SwingsAtTheClosedFormFrequencyAndDecay) {
  Liggghts run;
  const double beta = GetParam(), m = grain_mass(), M = 200 * columns * m;
  const double mass = M + 0.25 * columns * m, k = 0.5 * columns * contact_spring(),
               c = 0.5 * columns * contact_dashpot(beta);
  const double A = (M + 0.5 * columns * m) * g / k, s = c / (2 * mass), w = std::sqrt(k / mass - s * s);
  const double dt = 2e-6;
  const int steps = static_cast<int>(0.95 * 2 * pi / w / dt);
  run.script = column(run, fmt::format("mass {:.17g} start {:.17g}", M, 2 * R), beta, dt) +
               fmt::format("thermo {}\nrun {}\n", steps / 50, steps);
  run.must();
  const Table t = run.thermo();
  ASSERT_GT(t.rows.size(), 50u);
  double deepest = 0;
  for (std::size_t i = 0; i < t.rows.size(); i++) {
    const double time = t.at(i, "Step") * dt;
    const double z = -A * (1 - std::exp(-s * time) * (std::cos(w * time) + s / w * std::sin(w * time)));
    EXPECT_NEAR(t.at(i, "z") - 2 * R, z, 2.5e-3 * A) << "at " << time << " s";
    deepest = std::min(deepest, z);
  }
  EXPECT_LT(deepest, beta > 0 ? -1.8 * A : -1.98 * A);
}

INSTANTIATE_TEST_SUITE_P(SpringAndDashpot, PlateOnGrains, testing::Values(0.0, 1.0),
                         [](const auto& one) { return one.param > 0 ? "Dashpot" : "Spring"; });

// At rest the grains carry the weight: the damper takes out the swing in some 10 periods.
TEST(Plate, RestsOnTheGrainsWithItsWeight) {
  Liggghts run;
  const double M = 5, k = 0.5 * columns * contact_spring();
  run.script =
      column(run, fmt::format("mass {} damping {} start {}", M, 2 * std::sqrt(k * M), 2 * R), 0.3) + "run 60000\n";
  run.must();
  const Table t = run.thermo();
  EXPECT_NEAR(t.at(t.rows.size() - 1, "F"), M * g, 1e-9 * M * g);
  const double depth = (M + 0.5 * columns * grain_mass()) * g / k;
  EXPECT_NEAR(2 * R - t.at(t.rows.size() - 1, "z"), depth, 1e-9 * R);
}

// Position, velocity and force come back: the same motion as without a break. Without dashpots the forces of a
// restart's first step are those of the run; only the order of sums may differ.
TEST(Plate, GoesOnFromARestart) {
  Liggghts whole, broken;
  const std::string plate = "mass 1 start 0.0101";
  whole.script = column(whole, plate) + "thermo 500\nrun 4000\n";
  whole.must();
  broken.script = column(broken, plate) + "thermo 500\nrun 2000\nwrite_restart state\n";
  broken.must();
  std::string again = column(broken, plate);
  const std::size_t data = again.find("read_data"), end = again.find('\n', data);
  ASSERT_NE(data, std::string::npos);
  broken.script = again.replace(data, end - data, "read_restart state") + "thermo 500\nrun 2000\n";
  broken.must();
  const Table one = whole.thermo(), two = broken.thermo();
  ASSERT_EQ(two.at(0, "Step"), 2000);
  for (std::size_t k = 1; k <= 4; k++) {
    ASSERT_EQ(one.at(k + 4, "Step"), two.at(k, "Step"));
    EXPECT_NEAR(one.at(k + 4, "z"), two.at(k, "z"), 1e-12);
    EXPECT_NEAR(one.at(k + 4, "v"), two.at(k, "v"), 1e-10);
  }
  EXPECT_LT(two.at(1, "z"), 0.01);  // the plate had met the grains
}

TEST(Plate, MovesAlikeOnOneAndTwoRanks) {
  Table t[2];
  for (const int ranks : {1, 2}) {
    Liggghts run;
    run.script = column(run, "mass 1 start 0.0101", 0.3) + "thermo 500\nrun 3000\n";
    run.must(ranks);
    t[ranks - 1] = run.thermo();
  }
  ASSERT_EQ(t[0].rows.size(), 7u);
  for (std::size_t k = 0; k < 7; k++)
    for (const char* what : {"z", "v", "F"})
      EXPECT_NEAR(t[0].at(k, what), t[1].at(k, what), 1e-9 * (1e-6 + std::fabs(t[0].at(k, what)))) << what << k;
  EXPECT_GT(t[0].at(6, "F"), 1);
}

struct Refusal {
  std::string name, plate, word;
};
void PrintTo(const Refusal& r, std::ostream* out) { *out << r.plate; }
class PlateRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(PlateRefuses, WithAReason) {
  Liggghts run;
  run.script = column(run, GetParam().plate) + "run 1\n";
  const Outcome outcome = run.start();
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.text.find(GetParam().word), std::string::npos) << outcome.text;
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, PlateRefuses,
    testing::Values(Refusal{"NoMass", "", "mass M > 0 is required"}, Refusal{"NegativeMass", "mass -1", "mass M > 0"},
                    Refusal{"NegativeDamping", "mass 1 damping -1", "damping must be >= 0"},
                    Refusal{"UnknownMesh", "mass 1 mesh floor2", "mesh must name"},
                    Refusal{"UnknownKeyword", "mass 1 weight 2", "unknown keyword weight"},
                    Refusal{"MovedTwice", "mass 1\nfix other all vielto/plate mass 1 mesh lid", "something else moves"},
                    Refusal{"NoGravity", "mass 1\nunfix gravity", "needs a fix gravity"}),
    [](const auto& one) { return one.param.name; });

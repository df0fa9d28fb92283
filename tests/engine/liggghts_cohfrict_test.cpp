// SPDX-License-Identifier: GPL-2.0-or-later
/* CohFrictPhys through `liggghts`: bonds that hold, tear and shear off, between spheres and on walls, against closed
   forms; what neighbour lists, ranks and restarts make of a stretched bond; bad input.

     k_n = E R (equal spheres), 2 E R 2/3 (wall, R_2 = 2 R),   a_n = C_n R^2 */
#include "liggghts_runner.h"

namespace {

using namespace vielto_test;

const double R = 0.005, E = 1e6;

struct Bond {
  double frictionAngle = 25, alphaKr = 0.5, alphaKtw = 0.5, etaRoll = -1, etaTwist = -1, normalCohesion = 1e4,
         shearCohesion = 1e4;
};

std::string bond_properties(const Bond& b) {
  const std::pair<const char*, double> values[] = {{"youngsModulus", E},
                                                   {"stiffnessRatio", 0.5},
                                                   {"frictionAngle", b.frictionAngle},
                                                   {"alphaKr", b.alphaKr},
                                                   {"alphaKtw", b.alphaKtw},
                                                   {"etaRoll", b.etaRoll},
                                                   {"etaTwist", b.etaTwist},
                                                   {"normalCohesion", b.normalCohesion},
                                                   {"shearCohesion", b.shearCohesion}};
  std::string text;
  for (const auto& [name, value] : values)
    text += fmt::format("fix {0} all property/global {0} peratomtype {1}\n", name, value);
  return text;
}

const char* const bonding = "bondNewContacts on";

std::string pair_style(const Bond& b, const std::string& settings = bonding) {
  return "neighbor 0.002 bin\nneigh_modify delay 0\n" + bond_properties(b) +
         fmt::format("pair_style gran model cohfrict {}\npair_coeff * *\n", settings);
}

// Settings, grains, law and integration; the test adds its runs.
std::string start(const Liggghts& run, const std::vector<Sphere>& spheres, const Bond& b, double dt,
                  const std::string& settings = bonding) {
  return settings_head() + grains(run, spheres, 0.2) + pair_style(b, settings) +
         fmt::format("timestep {:.17g}\nfix move all nve/sphere\n", dt);
}

enum class Partner { sphere, plane, mesh };

std::string partner_name(const testing::TestParamInfo<Partner>& tested) {
  const char* const names[] = {"sphere", "plane", "mesh"};
  return names[static_cast<int>(tested.param)];
}

// Sphere 1 meets its partner at relative speed v along z; everything about to touch.
struct HeadOn {
  Partner partner;
  double v, kn, mass;
  std::vector<Sphere> spheres;

  HeadOn(Partner p, double speed) : partner(p), v(speed) {
    const Sphere s{1, R, 1375, {0.003, 0.007, 1e-12 + R}, {0, 0, -speed}, Vec::Zero()};
    spheres = {s};
    mass = s.mass();
    kn = E * R * 4 / 3;
    if (p != Partner::sphere) return;
    // what the partner does: half of the speed each
    spheres.push_back(s);
    spheres[1].x[2] = -R;
    spheres[0].v[2] = -speed / 2;
    spheres[1].v[2] = speed / 2;
    mass /= 2;
    kn = E * R;
  }
  double omega() const { return std::sqrt(kn / mass); }
  double adhesion(const Bond& b) const { return b.normalCohesion * R * R; }

  // The relative speed along z in each frame.
  std::vector<double> speeds(const Bond& b, double dt, long every, long steps, const std::string& settings) const {
    Liggghts run;
    run.script = start(run, spheres, b, dt, settings);
    run.write("plate.stl", plate_stl(0.1));
    if (partner == Partner::plane)
      run.script += "fix wall all wall/gran model cohfrict primitive type 1 zplane 0.0 " + settings + "\n";
    if (partner == Partner::mesh)
      run.script +=
          "fix plate all mesh/surface file plate.stl type 1\n"
          "fix wall all wall/gran model cohfrict mesh n_meshes 1 meshes plate " +
          settings + "\n";
    run.script += dump_grains("states", every) + fmt::format("run {}\n", steps);
    run.must();
    std::vector<double> list;
    for (const Table& frame : run.dump("states"))
      list.push_back(frame.v(0)[2] - (partner == Partner::sphere ? frame.v(1)[2] : 0));
    return list;
  }
};

class NormalBond : public testing::TestWithParam<Partner> {};

/* An unbroken bond is the spring alone: v(t) = -v cos(omega t), four periods of it, half of the time stretched.
   Tolerance: the leapfrog's omega is too large by (omega dt)^2/24; a start half a step off is sin of omega dt/2
   squared. */
TEST_P(NormalBond, HoldsAndSwings) {
  const HeadOn impact(GetParam(), 0.1);
  const Bond bond;
  ASSERT_LT(std::sqrt(impact.kn * impact.mass) * impact.v, impact.adhesion(bond));
  const double x = 0.02, dt = x / impact.omega();
  const long steps = std::lround(4 * 2 * pi / x);
  const std::vector<double> v = impact.speeds(bond, dt, 10, steps, bonding);
  for (std::size_t k = 0; k < v.size(); k++) {
    const double phase = x * 10 * static_cast<double>(k);
    EXPECT_NEAR(v[k] / impact.v, -std::cos(phase), x * x / 24 * phase + x * x / 4) << k;
  }
}

/* The bond takes the energy that it stores until it tears, a_n^2/(2 k_n): v_out^2 = v^2 - a_n^2/(k_n m).
   Tolerance: it tears at a step, at most one step late: a_n dt/m; and the leapfrog's (omega dt)^2. */
TEST_P(NormalBond, TakesItsEnergyWhenItTears) {
  const HeadOn impact(GetParam(), 0.4);
  const Bond bond;
  const double x = 0.005, dt = x / impact.omega(), a = impact.adhesion(bond);
  ASSERT_GT(std::sqrt(impact.kn * impact.mass) * impact.v, 1.2 * a);
  const double expected = std::sqrt(impact.v * impact.v - a * a / (impact.kn * impact.mass));
  const long steps = std::lround(2 * pi / x);
  EXPECT_NEAR(impact.speeds(bond, dt, steps, steps, bonding).back(), expected, a * dt / impact.mass + x * x * impact.v);
}

// No bond without the setting: elastic. Tolerance: leapfrog, a contact that ends at a step.
TEST_P(NormalBond, IsNotMadeUnlessAskedFor) {
  const HeadOn impact(GetParam(), 0.1);
  const double x = 0.005, dt = x / impact.omega();
  const long steps = std::lround(2 * pi / x);
  EXPECT_NEAR(impact.speeds(Bond(), dt, steps, steps, "").back(), impact.v, x * impact.v);
}

INSTANTIATE_TEST_SUITE_P(Partners, NormalBond, testing::Values(Partner::sphere, Partner::plane, Partner::mesh),
                         partner_name);

/* A sphere bonded to a plane and pressed on it by F_n is pushed along it by a force that grows slowly to `share` of
   a_s + F_n tan(phi). The moments have no limit, so it can only shear off. The ramp takes 80 periods of the slowest
   spring, which overshoots by 1/(2 pi 80) = 0.2 %. */
class ShearBond : public testing::TestWithParam<double> {};

TEST_P(ShearBond, HoldsUpToItsStrength) {
  Bond bond;
  bond.shearCohesion = 4e3;
  bond.alphaKr = 5;
  const double Fn = 0.2, strength = bond.shearCohesion * R * R + Fn * std::tan(bond.frictionAngle * pi / 180);
  const double kn = E * R * 4 / 3, ks = 0.5 * kn;
  const Sphere s{1, R, 1375, {-0.1, 0, R - Fn / kn}, Vec::Zero(), Vec::Zero()};
  // slowest: rolling, or sliding with it; both are faster than k_s on the mass alone would be on 7 masses
  const double period = 2 * pi * std::sqrt(7 * s.mass() / ks), dt = period / 200;
  const long steps = 80 * 200;
  Liggghts run;
  run.script = start(run, {s}, bond, dt) +
               "fix wall all wall/gran model cohfrict primitive type 1 zplane 0.0 bondNewContacts on\n" +
               fmt::format("variable push equal ramp(0,{:.17g})\n", GetParam() * strength) +
               fmt::format("fix push all addforce v_push 0 {:.17g}\n", -Fn) + dump_grains("states", steps) +
               fmt::format("run {}\n", steps);
  run.must();
  const Table last = run.dump("states").back();
  // held: the springs' own stretch, F/k_s + F R^2/k_r; let go, it slides and rolls away by far more
  const double kr = bond.alphaKr * ks * 2 * R * R, stretch = strength * (1 / ks + R * R / kr);
  if (GetParam() < 1)
    EXPECT_LT(last.x(0)[0] - s.x[0], 1.05 * stretch);
  else
    EXPECT_GT(last.x(0)[0] - s.x[0], 3 * stretch);
}

INSTANTIATE_TEST_SUITE_P(Shares, ShearBond, testing::Values(0.97, 1.03));

/* A bonded pair in flight: neighbour lists are made anew again and again, its grains go from one rank to the other, and
   half of the time the bond is stretched. Its motion relative to its flight is that of the pair that does not fly; they
   differ by round-off of positions of 0.1 m (1e-17 m a step; 6000 steps of an oscillator with omega = 3700 1/s). */
TEST(FlyingBond, IsKeptByNeighbourListsAndRanks) {
  const double v = 0.05, dt = 5e-6;
  const long steps = 6000;
  std::vector<Vec> relative[2];
  for (const int flying : {0, 1}) {
    const Vec flight = flying * Vec(3, 0.3, 0), at = flying * Vec(-0.05, 0, 0);
    const std::vector<Sphere> pair = {{1, R, 1375, at + Vec(0, R + 1e-9, 0), flight + Vec(0.02, -v, 0), {0, 5, 3}},
                                      {1, R, 1375, at - Vec(0, R, 0), flight + Vec(-0.02, v, 0), {4, 0, 3}}};
    Bond bond;
    bond.normalCohesion = bond.shearCohesion = 1e5;
    Liggghts run;
    run.script = fmt::format("processors {} 1 1\n", 1 + flying) + start(run, pair, bond, dt) +
                 dump_grains("states", steps / 10) + fmt::format("run {}\n", steps);
    run.must(1 + flying);
    for (const Table& frame : run.dump("states")) relative[flying].push_back(frame.x(0) - frame.x(1));
  }
  ASSERT_EQ(relative[0].size(), relative[1].size());
  double longest = 0;
  for (std::size_t k = 0; k < relative[0].size(); k++) {
    EXPECT_LT((relative[0][k] - relative[1][k]).norm(), 1e-14) << k;
    longest = std::max(longest, relative[0][k].norm());
  }
  EXPECT_GT(longest, 2 * R);         // it was stretched
  EXPECT_LT(longest, 2 * R + 2e-4);  // and held
}

// A restart in the moment of the greatest stretch brings the bond back: the pair goes on swinging.
TEST(StretchedBond, SurvivesARestart) {
  const HeadOn impact(Partner::sphere, 0.1);
  const double x = 0.02, dt = x / impact.omega();
  const long stretched = std::lround(1.5 * pi / x), whole = std::lround(2 * 2 * pi / x);
  const std::string move = fmt::format("timestep {:.17g}\nfix move all nve/sphere\n", dt);
  Liggghts run;
  run.script = start(run, impact.spheres, Bond(), dt) + fmt::format("run {}\nwrite_restart half.restart\n", stretched);
  run.must();
  run.script = settings_head() + "read_restart half.restart\n" + pair_style(Bond()) + move + dump_grains("states", 1) +
               fmt::format("run {}\n", whole - stretched);
  run.must();
  const std::vector<Table> frames = run.dump("states");
  EXPECT_GT((frames.front().x(0) - frames.front().x(1)).norm(), 2 * R);
  const double phase = x * static_cast<double>(whole);
  EXPECT_NEAR((frames.back().v(0)[2] - frames.back().v(1)[2]) / impact.v, -std::cos(phase),
              x * x / 24 * phase + x * x / 4);
}

/* Of equal spheres without moments, sliding is the stiffest mode: omega^2 = k_s (1/m_eff + 2 R^2/I) = 7 k_s/m, against
   2 k_n/m of the normal one and less on a wall. Printed with 12 digits. */
TEST(CohFrictTime, HalfPeriodIsThatOfTheStiffestMode) {
  Bond bond;
  bond.alphaKr = bond.alphaKtw = 0;
  Liggghts run;
  run.script = settings_head() + grains(run, {Sphere()}, 0.05) + pair_style(bond) +
               fmt::format("vielto half_period tc radius {} density 1375\nprint \"tc=${{tc}}.\"\n", R);
  const Outcome outcome = run.start();
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const std::size_t at = outcome.text.rfind("tc=");
  ASSERT_NE(at, std::string::npos);
  const double mass = 1375 * 4.0 / 3 * pi * R * R * R;
  const double expected = pi / std::sqrt(7 * 0.5 * E * R / mass);
  EXPECT_NEAR(std::stod(outcome.text.substr(at + 3)), expected, 1e-11 * expected);
}

// v = 2 m/s gives an overlap of v/omega, 2 % of the diameter and more; the limit names the grain.
TEST(CohFrictOverlap, IsLimited) {
  const HeadOn impact(Partner::sphere, 2);
  ASSERT_GT(impact.v / impact.omega(), 0.02 * 2 * R);
  Liggghts run;
  run.script = start(run, impact.spheres, Bond(), 0.02 / impact.omega(), "maxOverlap 0.02") + "run 200\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.text.find("over the limit of 2 % (maxOverlap)"), std::string::npos) << outcome.text;
}

void expect_error(const std::string& law, const std::vector<std::string>& words) {
  Liggghts run;
  run.script = settings_head() + grains(run, {Sphere()}, 0.05) + "neighbor 0.002 bin\n" + law +
               "timestep 1e-6\nfix move all nve/sphere\nrun 1\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  for (const std::string& word : words) EXPECT_NE(outcome.text.find(word), std::string::npos) << outcome.text;
}

TEST(BadInput, IsNamed) {
  const std::string style = "pair_style gran model cohfrict\npair_coeff * *\n";
  Bond bond;
  bond.normalCohesion = -1;
  expect_error(bond_properties(bond) + style, {"property normalCohesion of type 1 is -1", "[0, inf"});
  std::string text = bond_properties(Bond());
  text.replace(text.find("fix alphaKtw"), 3, "#");
  expect_error(text + style, {"property alphaKtw is missing"});
  expect_error(bond_properties(Bond()) + "pair_style gran model cohfrict wallRadiusFactor 0\npair_coeff * *\n",
               {"cohfrict: wallRadiusFactor must be > 0"});
}

}  // namespace

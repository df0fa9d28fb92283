// SPDX-License-Identifier: GPL-2.0-or-later
/* Walton and Braun's law as the rigs take it, `vielto law properties` with a card's values, through `liggghts` against
   closed forms in the card's own terms (walton_braun_law.h).

     k_1 = c_n k_n, k_n = 2 E R (equal spheres), 4 E E_w w/(E + w E_w) R (wall, R_2 = w R)
     e = exp(-pi z/sqrt(1 - z^2)), z = beta_n/sqrt(c_n): ViElTo's own restitution;  k_2 = k_1/e^2

   Tolerances, with x = sqrt(k_2/m) dt: the force sets in, turns and ends at a step instead of at the instant, which at
   each of the three misses at most an energy of (1/2) k_2 (v dt)^2, x^2 of the grain's; between them the leapfrog is of
   second order. */
#include "liggghts_runner.h"

namespace {

using namespace vielto_test;

const double R = 0.005, E = 1e6, wallE = 3e6, w = 2, cn = 4, g = 9.81;
const double betaGrain = 0.3, betaWall = 0.5;

struct Partner {
  std::string name;
  double kn, beta, bodies;  // bodies that move
};
const Partner sphere = {"sphere", 2 * E* R, betaGrain, 2};
const Partner wall = {"wall", 4 * E* wallE* w / (E + w * wallE) * R, 0.5 * (betaGrain + betaWall), 1};

double restitution(double beta) {
  const double z = beta / std::sqrt(cn);
  return std::exp(-pi * z / std::sqrt(1 - z * z));
}

const char* const models = "model walton_braun tangential vielto rolling_friction vielto";
const std::map<std::string, std::pair<double, double>> card = {{"youngsModulus", {E, wallE}},
                                                               {"stiffnessRatio", {0.5, 0.5}},
                                                               {"frictionAngle", {20, 30}},
                                                               {"normalDamping", {betaGrain, betaWall}},
                                                               {"tangentialDamping", {0, 0}},
                                                               {"rollingStiffnessFactor", {0.1, 0.1}},
                                                               {"twistingStiffnessFactor", {0.1, 0.1}},
                                                               {"rollingResistance", {0.1, 0.3}},
                                                               {"twistingResistance", {0.1, 0.1}}};

struct Case {
  double hardening = 0, maxOverlap = 0.2, dtFraction = 0.001;
  double normalDamping = betaGrain;  // of the grain; the wall's is moved by the same
};

std::string settings(const Case& one) {
  return fmt::format("springFactor {} wallRadiusFactor {} maxOverlap {}", cn, w, one.maxOverlap);
}

// Up to the integration; sets dt to a part of the shortest half period and prints both.
std::string start(const Liggghts& run, const std::vector<Sphere>& spheres, const Case& one) {
  std::string text =
      settings_head() + grains(run, spheres, 0.2, 2) + "neighbor 0.002 bin\nneigh_modify delay 0\n" +
      fmt::format("pair_style gran {} {}\n", models, settings(one)) +
      "variable law index walton_braun\nvariable adhesionStrength index 0\n" +
      fmt::format("variable springFactor index {}\nvariable unloadingHardening index {}\n", cn, one.hardening);
  for (const auto& [name, values] : card) {
    const double move = name == "normalDamping" ? one.normalDamping - betaGrain : 0;
    text += fmt::format("variable {0} index {1}\nvariable wall_{0} index {2}\n", name, values.first + move,
                        values.second + move);
  }
  return text + "vielto law properties\npair_coeff * *\n" +
         fmt::format("vielto half_period tc radius {:.17g} density 1375\n", spheres[0].radius) +
         fmt::format("variable dt equal {:.17g}*${{tc}}\ntimestep ${{dt}}\nfix move all nve/sphere\n", one.dtFraction) +
         "print \"tc=${tc}.\"\nprint \"dt=${dt}.\"\n";
}

std::string plane(const Case& one) {
  return fmt::format("fix plane all wall/gran {} primitive type 2 zplane 0.0 {}\n", models, settings(one));
}

double printed(const std::string& text, const std::string& key) {
  const std::size_t at = text.rfind("\n" + key);
  if (at == std::string::npos) {
    ADD_FAILURE() << "no " << key << " in " << text;
    return std::nan("");
  }
  return std::stod(text.substr(at + 1 + key.size()));
}

struct Impact {
  double restitution = 0;    // speed of parting over that of approach
  double time = 0;           // under force, s
  double greatest = 0;       // overlap, m
  double residual = 0;       // overlap when the force has gone, m
  double greatestForce = 0;  // N
  double x = 0, dt = 0;      // sqrt(k_2/m) dt; s
};

double effective_mass(const Partner& partner, double radius) { return Sphere{1, radius}.mass() / partner.bodies; }

// A grain flies onto its like or onto a wall at speed v; every step is looked at.
Impact impact(const Partner& partner, double v, double radius, const Case& one) {
  Liggghts run;
  std::vector<Sphere> spheres = {{1, radius, 1375, {0.003, 0.007, radius + 1e-9}, {0, 0, -v}, Vec::Zero()}};
  if (partner.name == sphere.name) {
    spheres.push_back(spheres[0]);
    spheres[1].x[2] = -radius;
    spheres[0].v[2] = -v / 2;
    spheres[1].v[2] = v / 2;
  }
  const double m = effective_mass(partner, radius), k1 = cn * partner.kn * radius / R;
  run.script =
      start(run, spheres, one) + (partner.name == wall.name ? plane(one) : "") + dump_grains("states", 1) +
      fmt::format("variable steps equal ceil({:.17g}/${{dt}})\nrun ${{steps}}\n", 1.1 * pi * std::sqrt(m / k1));
  const Outcome done = run.start();
  EXPECT_EQ(done.status, 0) << done.text;
  Impact seen;
  seen.dt = printed(done.text, "dt=");
  bool before = true;
  for (const Table& frame : run.dump("states")) {
    const double distance = frame.x(0)[2] - (partner.name == sphere.name ? frame.x(1)[2] : 0);
    const double overlap = (partner.name == sphere.name ? 2 : 1) * radius - distance;
    const double force = frame.f(0)[2];
    if (force > 0) {
      before = false;
      seen.time += seen.dt;
    } else if (!before && seen.residual == 0) {
      seen.residual = overlap;
    }
    seen.greatest = std::max(seen.greatest, overlap);
    seen.greatestForce = std::max(seen.greatestForce, force);
  }
  const Table last = run.dump("states").back();
  EXPECT_EQ(last.f(0)[2], 0);
  seen.restitution = (last.v(0)[2] - (partner.name == sphere.name ? last.v(1)[2] : 0)) / v;
  return seen;
}

class WaltonBraun : public testing::TestWithParam<Partner> {};
void PrintTo(const Partner& p, std::ostream* out) { *out << p.name; }

}  // namespace

/* At every speed and size of grain: restitution sqrt(k_1/k_2), contact time (pi/2)(sqrt(m/k_1) + sqrt(m/k_2)), greatest
   overlap v sqrt(m/k_1), residual overlap u_m (1 - k_1/k_2) and greatest force k_1 u_m. Time: a step at either end, and
   x of the turn between the branches; residual overlap: a step at the speed of parting. */
TEST_P(WaltonBraun, ImpactIsThatOfTheTwoBranches) {
  const Partner& partner = GetParam();
  const Case one;
  for (const double radius : {R, 0.6 * R})
    for (const double v : {0.05, 0.5}) {
      const double m = effective_mass(partner, radius), k1 = cn * partner.kn * radius / R;
      const double e = restitution(partner.beta), k2 = k1 / (e * e), greatest = v * std::sqrt(m / k1);
      const Impact seen = impact(partner, v, radius, one);
      const double x = std::sqrt(k2 / m) * seen.dt, second = 3 * x * x / (2 * e * e);
      SCOPED_TRACE(fmt::format("{} R {} v {}", partner.name, radius, v));
      EXPECT_NEAR(seen.restitution, e, e * second);
      EXPECT_NEAR(seen.time, pi / 2 * std::sqrt(m / k1) * (1 + e), 3 * seen.dt);
      EXPECT_NEAR(seen.greatest, greatest, greatest * second);
      EXPECT_NEAR(seen.greatestForce, k1 * greatest, k1 * greatest * second);
      EXPECT_NEAR(seen.residual, greatest * (1 - e * e), 1.01 * e * v * seen.dt);
    }
}

/* Load-dependent, without any restitution on the card (beta_n = 0, e = 1): e(v) = [1 + (h/d) v sqrt(m/k_1)]^(-1/2),
   which Walton and Braun print. Grains twice as large at the same speed rebound alike, since v sqrt(m/k_1)/d is the
   same. */
TEST_P(WaltonBraun, HardeningMakesRestitutionFallWithSpeed) {
  Partner partner = GetParam();
  Case one;
  one.hardening = 30;
  one.normalDamping = 0;
  partner.beta -= betaGrain;
  for (const double radius : {R, 0.5 * R})
    for (const double v : {0.05, 0.5}) {
      const double e0 = restitution(partner.beta);
      const double m = effective_mass(partner, radius), k1 = cn * partner.kn * radius / R;
      const double u = v * std::sqrt(m / k1), e = 1 / std::sqrt(1 / (e0 * e0) + one.hardening * u / (2 * radius));
      const Impact seen = impact(partner, v, radius, one);
      const double x = std::sqrt(k1 / m) / e * seen.dt;
      EXPECT_NEAR(seen.restitution, e, e * 3 * x * x / (2 * e * e)) << partner.name << " R " << radius << " v " << v;
    }
}

INSTANTIATE_TEST_SUITE_P(Partners, WaltonBraun, testing::Values(sphere, wall),
                         [](const auto& one) { return one.param.name; });

/* A grain let go at its touch with a plane sinks, by weight alone, to twice its elastic rest, u_m = 2 m g/k_1. From
   then on it goes up and down along the unloading branch, without loss: between u_m and u_m - 2 m g/k_2, where the
   force is just 0, with the period 2 pi sqrt(m/k_2). So a contact reloads on the branch that it unloads on, and keeps
   its residual overlap. Tolerance: x^2 of the amplitude for the turn, and a part of it for the time within a step. */
TEST(WaltonBraunPlane, ReloadsOnTheUnloadingBranch) {
  Liggghts run;
  const Case one;
  const Sphere s = {1, R, 1375, {0, 0, R}, Vec::Zero(), Vec::Zero()};
  const double m = s.mass(), e = restitution(wall.beta), k1 = cn * wall.kn, k2 = k1 / (e * e);
  const double greatest = 2 * m * g / k1, period = 2 * pi * std::sqrt(m / k2), sink = pi * std::sqrt(m / k1);
  run.script = start(run, {s}, one) + plane(one) + "fix weight all gravity 9.81 vector 0 0 -1\n" +
               dump_grains("states", 1) +
               fmt::format("variable steps equal ceil({:.17g}/${{dt}})\nrun ${{steps}}\n", sink + 3.2 * period);
  const Outcome done = run.start();
  ASSERT_EQ(done.status, 0) << done.text;
  const double dt = printed(done.text, "dt="), x = std::sqrt(k2 / m) * dt;
  double lowest = 0, highest = 1, deepest = 0;
  std::vector<double> turns;  // times of least overlap
  double before = 0, last = 0;
  for (const Table& frame : run.dump("states")) {
    const double t = dt * static_cast<double>(frame.step), overlap = R - frame.x(0)[2];
    deepest = std::max(deepest, overlap);
    if (t > sink + 2 * dt) {
      lowest = std::max(lowest, overlap);
      highest = std::min(highest, overlap);
      if (last < before && last < overlap) turns.push_back(t - dt);
    }
    before = last;
    last = overlap;
  }
  const double amplitude = 2 * m * g / k2;
  EXPECT_NEAR(deepest, greatest, 3 * x * x * greatest);
  EXPECT_NEAR(lowest, greatest, 3 * x * x * greatest + x * x * amplitude);
  EXPECT_NEAR(highest, greatest - amplitude, 3 * x * x * greatest + 2 * x * x * amplitude);
  ASSERT_EQ(turns.size(), 3u);
  EXPECT_NEAR(turns[2] - turns[0], 2 * period, 2 * dt);
}

/* The card's friction and rolling resistance: a grain on a wall, pressed by its weight (at u = m g/k_1 the loading
   branch bears it), slides with the tangent of the mean angle, tan(25 deg), and rolls with the smaller mu_r on the arm
   2 w/(1 + w) R:

     sliding without spin, for 2 v_0/(7 mu g) at least   v = v_0 - mu g t
     rolling without slip                                v = v_0 - (5/7) mu_r 2 w/(1 + w) g t

   Tolerance: the time in which the spring is wound up, cap/(k v) of sliding and cap/(k_r v/R) of rolling, with 2e-3 for
   the speed lost meanwhile; of rolling the swing of the undamped sticking spring, which the moment sets off: at most
   the deceleration over its omega, omega^2 = (7/2) k_s/m. */
TEST(WaltonBraunPlane, SlidesAndRollsAsTheCardSays) {
  const Case one;
  const double v = 0.5, m = Sphere().mass(), k1 = cn * wall.kn, mu = std::tan(25 * pi / 180), arm = 2 * w / (1 + w) * R;
  for (const bool rolls : {false, true}) {
    Liggghts run;
    const Sphere s = {1, R, 1375, {-0.1, 0, R - m * g / k1}, {v, 0, 0}, rolls ? Vec(0, v / R, 0) : Vec::Zero()};
    run.script = start(run, {s}, one) +
                 fmt::format("fix plane all wall/gran {} primitive type 2 zplane 0.0 {}\n", models, settings(one)) +
                 "fix weight all gravity 9.81 vector 0 0 -1\nvariable every equal ceil(0.005/${dt})\n"
                 "variable steps equal 4*${every}\n" +
                 "dump states all custom ${every} states id vx\ndump_modify states format \"%d %.17g\"\nrun ${steps}\n";
    const Outcome done = run.start();
    ASSERT_EQ(done.status, 0) << done.text;
    const double dt = printed(done.text, "dt=");
    const double slows = rolls ? 5.0 / 7 * 0.1 * arm / R * g : mu * g;
    const double wound =
        rolls ? 0.1 * m * g * arm / (0.1 * wall.kn * R * w * R * v / R) : mu * m * g / (0.5 * wall.kn * v);
    const double swing = rolls ? slows / std::sqrt(3.5 * 0.5 * wall.kn / m) : 0;
    std::size_t seen = 0;
    for (const Table& frame : run.dump("states")) {
      const double t = dt * static_cast<double>(frame.step);
      if (frame.step == 0) continue;
      EXPECT_NEAR(v - frame.at(0, "vx"), slows * t, slows * (wound + dt) + 2e-3 * slows * t + swing)
          << rolls << " " << t;
      seen++;
    }
    EXPECT_EQ(seen, 4u);
  }
}

/* The accounts of an impact on a plate: what the branches lose is (1/2) m v^2 (1 - e^2), booked with the normal
   direction, and nothing else is lost or held at the end. */
TEST(WaltonBraunEnergy, LossIsBooked) {
  Liggghts run;
  Case one;
  const double v = 0.5, e = restitution(wall.beta), m = effective_mass(wall, R), k1 = cn * wall.kn;
  run.write("plate.stl", plate_stl(0.05));
  run.script = start(run, {{1, R, 1375, {0.003, 0.007, R + 1e-9}, {0, 0, -v}, Vec::Zero()}}, one) +
               "fix plate all mesh/surface/stress file plate.stl type 2 reference_point 0 0 0\n" +
               fmt::format("fix wall all wall/gran {} mesh n_meshes 1 meshes plate {}\n", models, settings(one)) +
               fmt::format("variable steps equal ceil({:.17g}/${{dt}})\n", 1.2 * pi * std::sqrt(m / k1)) +
               "fix record all vielto/record every ${steps} file torque.csv speed 0 part plate plate energy on\n"
               "run ${steps}\n";
  const Outcome done = run.start();
  ASSERT_EQ(done.status, 0) << done.text;
  const Table rows = run.csv("torque.csv");
  const double kinetic = 0.5 * m * v * v, x = pi * one.dtFraction;
  EXPECT_NEAR(rows.at(0, "diss_normal_J"), kinetic * (1 - e * e), 3 * x * x * kinetic / (e * e));
  EXPECT_NEAR(rows.at(0, "kinetic_J"), kinetic * e * e, 3 * x * x * kinetic / (e * e));
  for (const char* part : {"elastic_J", "diss_tangential_J", "diss_sliding_J", "diss_rolling_J", "diss_twisting_J"})
    EXPECT_NEAR(rows.at(0, part), 0, 1e-12 * kinetic) << part;
}

/* The stiffest branch bounds the time step: pi sqrt(m/k_2) of two grains, of a grain on a wall of its own stuff
   (R_2 = w R) or of the wall's; with soft tangential springs here it is the normal one. Hardening: k_2 at maxOverlap.
   Printed with 12 digits. */
TEST(WaltonBraunTime, HalfPeriodIsThatOfTheStiffestBranch) {
  for (const double hardening : {0.0, 30.0}) {
    Case one;
    one.hardening = hardening;
    Liggghts run;
    run.script = start(run, {Sphere()}, one) + "run 0\n";
    const Outcome done = run.start();
    ASSERT_EQ(done.status, 0) << done.text;
    const double m = Sphere().mass();
    double stiffest = 0;  // k_2/m over all pairs of types; the rigs' restitution is a wall's where either is the wall
    const auto look = [&](double kn, double beta, double mass) {
      const double e = restitution(beta);
      stiffest = std::max(stiffest, cn * kn * (1 / (e * e) + hardening * one.maxOverlap) / mass);
    };
    for (const double E1 : {E, wallE})
      for (const double E2 : {E, wallE}) {
        const double beta = E1 == E && E2 == E ? sphere.beta : wall.beta;
        look(4 * E1 * E2 / (E1 + E2) * R, beta, m / 2);
        look(4 * E1 * E2 * w / (E1 + w * E2) * R, beta, m);
      }
    EXPECT_NEAR(printed(done.text, "tc="), pi / std::sqrt(stiffest), 1e-11 * pi / std::sqrt(stiffest)) << hardening;
  }
}

/* What is refused: a restitution that is none, and hardening without a limit to the overlap. */
TEST(WaltonBraunRefuses, WithOneLine) {
  const auto line = [](const std::string& script) {
    Liggghts run;
    run.script = script;
    const std::string grain = grains(run, {Sphere()}, 0.05);
    run.script = settings_head() + grain + properties({Material()}) + script + "pair_coeff * *\nrun 0\n";
    const Outcome outcome = run.start();
    EXPECT_EQ(outcome.status, 1);
    return outcome.text;
  };
  const std::string e = "fix e all property/global coefficientRestitution peratomtypepair 1 ",
                    h = "fix h all property/global unloadingHardening scalar ";
  const std::string style = fmt::format("pair_style gran {} ", models);
  const auto expect = [&](const std::string& script, const std::string& words) {
    const std::string text = line(script);
    EXPECT_NE(text.find("ERROR: " + words), std::string::npos) << text;
  };
  expect(h + "0\n" + style + "\n", "walton_braun: give 'fix ID all property/global coefficientRestitution");
  expect(e + "1.2\n" + h + "0\n" + style + "\n",
         "walton_braun: property coefficientRestitution of types 1 and 1 is 1.2");
  expect(e + "0.5\n" + style + "\n", "walton_braun: give 'fix ID all property/global unloadingHardening");
  expect(e + "0.5\n" + h + "-1\n" + style + "\n", "walton_braun: give 'fix ID all property/global unloadingHardening");
  expect(e + "0.5\n" + h + "10\n" + style + "\n", "walton_braun: an unloadingHardening > 0 needs a maxOverlap > 0");
  expect(e + "0.5\n" + h + "0\n" + style + "springFactor 0\n", "walton_braun: springFactor must be > 0");
}

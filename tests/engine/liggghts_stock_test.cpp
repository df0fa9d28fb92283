// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS' own laws as the rigs take them: `vielto law properties` with a card's values, through `liggghts`,
   against closed forms in the card's own terms; the watched models against the stock ones; time scale, overlap limit.

     k_n = 2 E R (equal spheres), 4 E E_w w/(E + w E_w) R (wall, R_2 = w R);  F = c_n k_n u
     e = exp(-pi z/sqrt(1 - z^2)), z = beta_n/sqrt(c_n): of the linear law, and of Hertz with the damping that LIGGGHTS
     gives it (Antypov & Elliott 2011, EPL 94:200004), at every speed */
#include "liggghts_runner.h"

namespace {

using namespace vielto_test;

const double R = 0.005, E = 1e6, wallE = 3e6, w = 2, cn = 4, maxOverlap = 0.05, hertzOverlap = 0.01, nu = 0.3, g = 9.81;
const double betaGrain = 0.3, betaWall = 0.5, phiGrain = 20, phiWall = 30, rollGrain = 0.1, rollWall = 0.3,
             wallRolling = 0.04;

double tangent(double degrees) { return std::tan(degrees * pi / 180); }

struct Partner {
  std::string name;
  double kn, beta, phi, arm;  // arm of the greatest rolling moment over R
};
// a plane of type 1 is a wall of the grain's stuff
const Partner sphere = {"sphere", 2 * E* R, betaGrain, phiGrain, 1};
const Partner wall = {"wall", 4 * E* wallE* w / (E + w * wallE) * R, 0.5 * (betaGrain + betaWall),
                      0.5 * (phiGrain + phiWall), 2 * w / (1 + w)};

const std::map<std::string, std::string> settings = {
    {"hertz", fmt::format("tangential_damping off maxOverlap {}", maxOverlap)},
    {"hooke", fmt::format("tangential_damping off maxOverlap {} ktToKnUser on", maxOverlap)}};

std::string models(const std::string& law) {
  return "model " + law + "/watched tangential history rolling_friction epsd2 ";
}

// Up to the integration, with the card's values mapped as in the rigs.
std::string start(const Liggghts& run, const std::string& law, const std::vector<Sphere>& spheres,
                  double dtFraction = 0.05, double wallModulus = wallE) {
  std::string text =
      settings_head() + grains(run, spheres, 0.2, 2) + "neighbor 0.002 bin\nneigh_modify delay 0\n" +
      fmt::format("pair_style gran {} {}\n", models(law), settings.at(law)) +
      fmt::format("variable law index {}\nvariable grainDiameter index {}\nvariable density index 1375\n", law, 2 * R) +
      fmt::format("variable springFactor index {}\nvariable wallRadiusFactor index {}\n", cn, w) +
      fmt::format("variable wallRolling index {}\n", wallRolling) +
      (law == "hertz"
           ? fmt::format("variable poissonsRatio index {}\nvariable hertzOverlap index {}\n", nu, hertzOverlap)
           : "");
  const std::map<std::string, std::pair<double, double>> card = {{"youngsModulus", {E, wallModulus}},
                                                                 {"normalDamping", {betaGrain, betaWall}},
                                                                 {"frictionAngle", {phiGrain, phiWall}},
                                                                 {"rollingResistance", {rollGrain, rollWall}}};
  for (const auto& [name, values] : card)
    text += fmt::format("variable {0} index {1}\nvariable wall_{0} index {2}\n", name, values.first, values.second);
  return text + "vielto law properties\npair_coeff * *\n" +
         fmt::format("vielto half_period tc radius {:.17g} density 1375\nprint \"tc=${{tc}}.\"\n", R) +
         fmt::format("variable dt equal {:.17g}*${{tc}}\ntimestep ${{dt}}\nfix move all nve/sphere\n", dtFraction);
}

std::string plane(const std::string& law, int type) {
  return fmt::format("fix plane all wall/gran {} primitive type {} zplane 0.0 {}\n", models(law), type,
                     settings.at(law));
}

double half_period(const std::string& text) {
  const std::size_t at = text.rfind("tc=");
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + 3));
}

Sphere resting(double radius, double overlap) {
  return {1, radius, 1375, {0.003, 0.007, radius - overlap}, Vec::Zero(), Vec::Zero()};
}

class Stock : public testing::TestWithParam<const char*> {
 protected:
  const std::string law = GetParam();

  double restitution(const Partner& partner, double v, double dtFraction) {
    Liggghts run;
    std::vector<Sphere> spheres = {resting(R, -1e-12)};
    spheres[0].v[2] = -v;
    if (partner.name == sphere.name) {
      spheres.push_back(spheres[0]);
      spheres[1].x[2] = -R;
      spheres[0].v[2] = -v / 2;
      spheres[1].v[2] = v / 2;
    }
    run.script = start(run, law, spheres, dtFraction) + (partner.name == wall.name ? plane(law, 2) : "");
    // long enough: Hertz' contact at 0.1 m/s lasts 4 times the shortest half period at the overlap limit
    const long steps = std::lround(10 / dtFraction);
    run.script += dump_grains("states", steps) + fmt::format("run {}\n", steps);
    run.must();
    const Table last = run.dump("states").back();
    return (last.v(0)[2] - (partner.name == sphere.name ? last.v(1)[2] : 0)) / v;
  }

  // k_n of a grain on a plane of its own type: both moduli are the grain's, mapped for a pair, whose R is half as
  // large.
  double own_wall_kn() const { return sphere.kn * (law == "hertz" ? std::sqrt(2) : std::pow(2, 0.6)); }

  // Overlap at which a grain of mass m rests on the plane: linear, or Hertz through its force at hertzOverlap.
  double rest(double load, double kn) const {
    if (law == "hooke") return load / (cn * kn);
    return std::pow(load * std::sqrt(hertzOverlap * 2 * R) / (cn * kn), 2.0 / 3);
  }
};

/* Elastic force at an overlap of 1 % of the diameter, grains at rest: c_n k_n u, also for grains of another size than
   the one that the mapping is made with, and against a wall of another modulus. The mapped moduli go through LIGGGHTS'
   variables of 15 digits, and the overlap is a difference of positions: 1e-16 R/(0.02 R). */
TEST_P(Stock, ElasticForceIsViElTosAtOnePercent) {
  for (const double radius : {R, 0.8 * R})
    for (const Partner& partner : {sphere, wall}) {
      Liggghts run;
      const double u = 0.01 * 2 * radius;
      std::vector<Sphere> spheres = {resting(radius, u)};
      if (partner.name == sphere.name) {
        spheres.push_back(spheres[0]);
        spheres[1].x[2] = -radius;
      }
      run.script = start(run, law, spheres) + (partner.name == wall.name ? plane(law, 2) : "") +
                   dump_grains("states", 1) + "run 0\n";
      run.must();
      const double expected = cn * partner.kn * radius / R * u;
      EXPECT_NEAR(run.dump("states").back().f(0)[2], expected, 1e-11 * expected) << partner.name << " " << radius;
    }
}

/* Tolerance: the contact ends up to a step late, while the dashpot alone still acts: 2 z omega dt of the speed, with
   omega dt at most pi dtFraction; the leapfrog's own error is that squared. */
TEST_P(Stock, RestitutionIsThatOfTheDampingRatio) {
  const double dtFraction = 0.001;
  for (const Partner& partner : {sphere, wall})
    for (const double v : {0.1, 1.0}) {
      const double z = partner.beta / std::sqrt(cn), e = std::exp(-pi * z / std::sqrt(1 - z * z));
      EXPECT_NEAR(restitution(partner, v, dtFraction), e, 2 * z * pi * dtFraction) << partner.name << " " << v;
    }
}

/* A grain set sliding on a level plane without spin loses mu g t as long as it slides, 2 v/(7 mu g). It rests at its
   equilibrium, so that the normal force is its weight. Tolerance: the time in which the tangential spring is wound up,
   mu m g/(k_t v) with k_t >= 2/7 of the secant stiffness, loses at most mu g times itself; and a step. */
TEST_P(Stock, SlidesWithTheTangentOfTheMeanAngle) {
  for (const int type : {1, 2}) {
    const double angle = type == 1 ? phiGrain : wall.phi, mu = tangent(angle), v = 0.2;
    const double kn = type == 2 ? wall.kn : own_wall_kn();
    Liggghts run;
    Sphere s = resting(R, 0);
    const double load = s.mass() * g, u = rest(load, kn);
    s.x = {-0.1, 0, R - u};
    s.v[0] = v;
    run.script = start(run, law, {s}) + plane(law, type) + "fix weight all gravity 9.81 vector 0 0 -1\n" +
                 dump_grains("states", 100) + "run 1000\nprint \"dt=${dt}.\"\n";
    const Outcome done = run.start();
    ASSERT_EQ(done.status, 0) << done.text;
    const double dt = 0.05 * half_period(done.text), wound = mu * load / (2.0 / 7 * load / u * v);
    int seen = 0;
    for (const Table& frame : run.dump("states")) {
      const double t = dt * static_cast<double>(frame.step);
      if (frame.step == 0 || t > 0.9 * 2 * v / (7 * mu * g)) continue;
      EXPECT_NEAR(v - frame.v(0)[0], mu * g * t, mu * g * (wound + dt) + 1e-6 * mu * g * t) << type << " " << t;
      seen++;
    }
    EXPECT_GE(seen, 3);
  }
}

/* A grain that rolls on the plane is held back by the greatest moment, mu_r F_n R 2 w/(1 + w) with the smaller mu_r
   and what the wall adds to it: 5/7 of it over m R. Tolerance: the tangential spring, which nothing damps, swings about
   its load f = m a with the amplitude f/sqrt(k_t 2/7 m) of the speed, twice. */
TEST_P(Stock, RollsAgainstTheGreatestMoment) {
  const double v = 0.4, a = 5.0 / 7 * (rollGrain + wallRolling) * wall.arm * g;
  Liggghts run;
  Sphere s = resting(R, 0);
  const double load = s.mass() * g, u = rest(load, wall.kn);
  s.x = {-0.1, 0, R - u};
  s.v[0] = v;
  s.w[1] = v / (R - u / 2);
  run.script = start(run, law, {s}) + plane(law, 2) + "fix weight all gravity 9.81 vector 0 0 -1\n" +
               dump_grains("states", 20000) + "run 20000\n";
  const Outcome done = run.start();
  ASSERT_EQ(done.status, 0) << done.text;
  const double t = 20000 * 0.05 * half_period(done.text);
  ASSERT_LT(a * t, 0.9 * v);
  const double swing = 2 * s.mass() * a / std::sqrt(2.0 / 7 * load / u * 2.0 / 7 * s.mass());
  EXPECT_LT(swing, 0.1 * a * t);
  EXPECT_NEAR(v - run.dump("states").back().v(0)[0], a * t, swing);
}

/* The same numbers as LIGGGHTS' own model, to the last digit, for three grains that meet askew and fall on a plane:
   every pair meets once. */
TEST_P(Stock, WatchedIsTheStockModel) {
  std::string dumps[2];
  for (const bool watched : {false, true}) {
    Liggghts run;
    const std::vector<Sphere> spheres = {{1, R, 1375, {0, 0, 1.3 * R}, {0.1, 0, -0.5}, {3, 5, 7}},
                                         {1, 0.8 * R, 1375, {1.9 * R, 0, R}, {-0.6, 0.1, -0.2}, {0, -9, 2}},
                                         {1, R, 1375, {0.5 * R, 2.1 * R, 2 * R}, {0, -0.7, -0.3}, {20, 0, 0}}};
    run.script = start(run, law, spheres) + plane(law, 2) + dump_grains("states", 20) + "run 600\n";
    if (!watched)
      for (const std::string ours : {"/watched", " maxOverlap 0.05"})
        for (std::size_t at; (at = run.script.find(ours)) != std::string::npos;) run.script.erase(at, ours.size());
    // the time scale is that of the watched model
    const std::size_t from = run.script.find("vielto half_period"), to = run.script.find("fix move");
    run.script.replace(from, to - from, "timestep 2e-6\n");
    run.must();
    dumps[watched] = run.read("states");
  }
  EXPECT_GT(dumps[0].size(), 5000u);
  EXPECT_EQ(dumps[0], dumps[1]);
}

/* Of any two types, as of ViElTo; with equal moduli on the cards the stiffest contact is a grain on a wall of its own
   stuff, and its stiffest mode sliding with rolling: with k_r = k_t R^2 omega^2 is (3 + sqrt(1/4 + 25/4)) k_t/m. k_t of
   hooke is 2/7 c_n k_n; of hertz, at the overlap limit, 2 (1 - v)/(2 - v) times the tangent 3/2 c_n k_n
   sqrt(maxOverlap/hertzOverlap). Printed with 12 digits. */
TEST_P(Stock, HalfPeriodIsThatOfTheStiffestMode) {
  Liggghts run;
  run.script = start(run, law, {Sphere()}, 0.05, E) + "run 0\n";
  const Outcome done = run.start();
  ASSERT_EQ(done.status, 0) << done.text;
  const double share = law == "hooke" ? 2.0 / 7 : 2 * (1 - nu) / (2 - nu) * 1.5 * std::sqrt(maxOverlap / hertzOverlap);
  const double kt = share * cn * own_wall_kn();
  const double expected = pi / std::sqrt((3 + std::sqrt(6.5)) * kt / Sphere().mass());
  EXPECT_NEAR(half_period(done.text), expected, 1e-11 * expected);
}

// 20 m/s presses two grains into each other by far more than 5 % of the diameter.
TEST_P(Stock, OverlapIsLimited) {
  Liggghts run;
  std::vector<Sphere> spheres = {resting(R, 0)};
  spheres[0].v[2] = -20;
  run.script = start(run, law, spheres) + plane(law, 2) + "run 1000\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.text.find("over the limit of 5 % (maxOverlap)"), std::string::npos) << outcome.text;
}

INSTANTIATE_TEST_SUITE_P(Laws, Stock, testing::Values("hertz", "hooke"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace

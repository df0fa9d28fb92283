// SPDX-License-Identifier: GPL-2.0-or-later
/* Head-on impacts through `liggghts` against the closed forms of the linear spring and dashpot.

     m_eff u'' + 2 sqrt(k_n m_eff) beta_n u' + c_n k_n u = 0,   omega_0^2 = c_n k_n/m_eff,   zeta = beta_n/sqrt(c_n)

   Until the overlap vanishes:

     e = exp(-pi zeta/sqrt(1 - zeta^2)),   t_c = pi/(omega_0 sqrt(1 - zeta^2))

   Until the force vanishes (limitForce on; Schwager and Poeschel 2007): u'' = 0 where omega_d t = 2 arccos(zeta), and
   there u' = -v_0 exp(-zeta omega_0 t), so

     e = exp(-2 zeta arccos(zeta)/sqrt(1 - zeta^2))

   Tolerance, with x = omega_0 dt. LIGGGHTS' leapfrog takes the dashpot's velocity half a step late, as if the mass were
   m (1 - zeta x): ln e changes by pi zeta^2 x/(2 (1 - zeta^2)^1.5). The dashpot sets in and ends at a step, not at the
   touch: at most half a step either side, each changes ln e by zeta x. The undamped rest is of second order: x^2. */
#include "contact_reference.h"

namespace {

using namespace vielto_test;

double damping_ratio(double beta, double cn) { return beta / std::sqrt(cn); }
double restitution(double zeta) { return std::exp(-pi * zeta / std::sqrt(1 - zeta * zeta)); }
double restitution_without_tension(double zeta) {
  return std::exp(-2 * zeta * std::acos(zeta) / std::sqrt(1 - zeta * zeta));
}

double tolerance_of_log(double zeta, double x) {
  return pi * zeta * zeta * x / (2 * std::pow(1 - zeta * zeta, 1.5)) + 2 * zeta * x + x * x;
}

// Two unequal spheres of unequal materials, and their k_n and m_eff by the printed formulas.
Material soft() { return Material(); }
Material hard() {
  Material m;
  m.youngsModulus = 3e6;
  return m;
}
struct Impact {
  double stiffness, mass;
  double omega(double cn) const { return std::sqrt(cn * stiffness / mass); }
};
const double v0 = 0.4;
const double R1 = 0.004, R2 = 0.006;

Impact pair_impact() {
  const Sphere a{1, R1}, b{2, R2};
  const double k1 = 2 * 1e6 * R1, k2 = 2 * 3e6 * R2;
  return {2 * k1 * k2 / (k1 + k2), a.mass() * b.mass() / (a.mass() + b.mass())};
}
Impact wall_impact(double factor) {
  const double k1 = 2 * 1e6 * R1, k2 = 2 * 3e6 * factor * R1;
  return {2 * k1 * k2 / (k1 + k2), Sphere{1, R1}.mass()};
}

enum class Partner { sphere, primitive, mesh };

struct Case {
  Partner partner;
  double cn, beta;
  bool limitForce;
};

std::string name(const testing::TestParamInfo<Case>& info) {
  const char* partners[] = {"sphere", "plane", "mesh"};
  std::string text = fmt::format("{}_cn{}_beta{}{}", partners[static_cast<int>(info.param.partner)], info.param.cn,
                                 info.param.beta, info.param.limitForce ? "_no_tension" : "");
  std::replace(text.begin(), text.end(), '.', 'p');
  return text;
}

struct Measured {
  double restitution, contact_time, greatest_overlap;
};

/* Flies onto the partner along z with v0; `steps` of the undamped contact time. The first touch lies in the middle of a
   step, where the force sets in as the leapfrog has it. */
Measured impact(const Case& c, double steps, Program program = Program::ours) {
  const bool wall = c.partner != Partner::sphere;
  const Impact physics = wall ? wall_impact(2) : pair_impact();
  const double tc = pi / physics.omega(c.cn), dt = tc / steps;
  std::vector<Material> types = {soft(), hard()};
  for (Material& type : types) type.normalDamping = c.beta;
  Liggghts run;
  std::vector<Sphere> spheres(wall ? 1 : 2);
  const double gap = 2.5 * v0 * dt;
  spheres[0] = {1, R1, 1375, {0, 0, R1 + gap}, {0, 0, -v0}, Vec::Zero()};
  if (!wall) spheres[1] = {2, R2, 1375, {0, 0, -R2}, Vec::Zero(), Vec::Zero()};
  const std::string settings = fmt::format("springFactor {} limitForce {}", c.cn, c.limitForce ? "on" : "off");
  run.script = head(run, spheres, types, 0.05, settings);
  run.write("plate.stl", plate_stl(0.04));
  if (c.partner == Partner::primitive)
    run.script += fmt::format("fix wall all wall/gran {} primitive type 2 zplane 0.0 {}\n", vielto_models, settings);
  if (c.partner == Partner::mesh)
    run.script += fmt::format(
        "fix plate all mesh/surface file plate.stl type 2\nfix wall all wall/gran {} mesh n_meshes 1 meshes plate {}\n",
        vielto_models, settings);
  run.script += fmt::format("timestep {:.17g}\nfix move all nve/sphere\n{}run {}\n", dt, dump_grains("states", 1),
                            static_cast<int>(1.6 * steps));
  run.must(1, program);

  Measured m = {0, 0, 0};
  int touching = 0;
  const std::vector<Table> frames = run.dump("states");
  for (const Table& frame : frames) {
    const double distance = frame.x(0)[2] - (wall ? 0 : frame.x(1)[2]);
    const double overlap = (wall ? R1 : R1 + R2) - distance;
    touching += overlap > 0;
    m.greatest_overlap = std::max(m.greatest_overlap, overlap);
  }
  m.contact_time = touching * dt;
  m.restitution = (frames.back().v(0)[2] - (wall ? 0 : frames.back().v(1)[2])) / v0;
  return m;
}

class NormalImpact : public testing::TestWithParam<Case> {};

TEST_P(NormalImpact, RestitutionContactTimeAndOverlapFollowTheClosedForm) {
  const Case c = GetParam();
  const double zeta = damping_ratio(c.beta, c.cn), root = std::sqrt(1 - zeta * zeta);
  const Impact physics = c.partner == Partner::sphere ? pair_impact() : wall_impact(2);
  const double omega = physics.omega(c.cn);
  for (const double steps : {50.0, 400.0}) {
    const double x = pi / steps, dt = x / omega;
    const Measured m = impact(c, steps);
    const double e = c.limitForce ? restitution_without_tension(zeta) : restitution(zeta);
    EXPECT_NEAR(std::log(m.restitution), std::log(e), tolerance_of_log(zeta, x)) << steps << " steps";
    // the overlap is largest where tan(omega_d t) = root/zeta: u = v0/omega_0 exp(-zeta omega_0 t)
    const double largest = v0 / omega * std::exp(-zeta / root * std::acos(zeta));
    EXPECT_NEAR(m.greatest_overlap / largest, 1, zeta * x + x * x) << steps << " steps";
    if (!c.limitForce) {
      // counted in steps: one step either end, and the late dashpot, sqrt(1 - zeta x) in omega_0
      const double tc = pi / (omega * root);
      EXPECT_NEAR(m.contact_time, tc, 2 * dt + zeta * x * tc) << steps << " steps";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ClosedForm, NormalImpact,
                         testing::Values(Case{Partner::sphere, 4, 0.3, false}, Case{Partner::sphere, 1, 0.3, false},
                                         Case{Partner::sphere, 4, 0, false}, Case{Partner::sphere, 4, 1.2, false},
                                         Case{Partner::sphere, 4, 0.3, true}, Case{Partner::sphere, 1, 0.3, true},
                                         Case{Partner::sphere, 1, 0.8, true}, Case{Partner::primitive, 4, 0.3, false},
                                         Case{Partner::primitive, 1, 0.3, false},
                                         Case{Partner::primitive, 1, 0.3, true}, Case{Partner::mesh, 4, 0.3, false},
                                         Case{Partner::mesh, 1, 0.3, false}, Case{Partner::mesh, 4, 0.3, true}),
                         name);

// Undamped the leapfrog is of second order: the error of the greatest overlap and of e falls by 4 with half the step.
// Damped it is of first order, because the dashpot's velocity is half a step late. The touch lies at the same place of
// a step.
TEST(NormalImpactConvergence, IsOfFirstOrderWithDashpot) {
  const Case c = {Partner::sphere, 1, 0.3, true};  // no jump of the force at the end, so only the lateness is left
  const double e = restitution_without_tension(0.3);
  const double error[3] = {impact(c, 100).restitution - e, impact(c, 200).restitution - e,
                           impact(c, 400).restitution - e};
  // ratios of a first-order error; its second-order part is of relative size x = 0.03 at 100 steps
  EXPECT_NEAR(error[0] / error[1], 2, 0.15);
  EXPECT_NEAR(error[1] / error[2], 2, 0.08);
}

TEST(NormalImpactConvergence, WithoutDashpotTheSpeedComesBackToSecondOrder) {
  const Case c = {Partner::sphere, 1, 0, false};
  for (const double steps : {50.0, 100.0, 200.0}) {
    const double x = pi / steps;
    // only the part of a step at touch and parting, in which the force grows from zero: x^2/8 at either end
    EXPECT_NEAR(impact(c, steps).restitution, 1, 0.25 * x * x) << steps;
  }
}

TEST(NormalImpactWallRadius, FactorSetsTheStiffnessOfTheWall) {
  // R_2 = factor R_1 enters k_n only: the greatest overlap v0/omega_0 tells it. Tolerance: x^2 of the leapfrog, 400
  // steps.
  for (const double factor : {1.0, 2.0, 5.0}) {
    const double omega = wall_impact(factor).omega(4), dt = pi / omega / 400;
    std::vector<Material> types = {soft(), hard()};
    for (Material& type : types) type.normalDamping = 0;
    Liggghts run;
    const std::string settings = fmt::format("wallRadiusFactor {}", factor);
    run.script = head(run, {{1, R1, 1375, {0, 0, R1}, {0, 0, -v0}, Vec::Zero()}}, types, 0.05, settings) +
                 fmt::format("fix wall all wall/gran {} primitive type 2 zplane 0.0 {}\n", vielto_models, settings) +
                 fmt::format("timestep {:.17g}\nfix move all nve/sphere\n{}run 400\n", dt, dump_grains("states", 1));
    run.must();
    double largest = 0;
    for (const Table& frame : run.dump("states")) largest = std::max(largest, R1 - frame.x(0)[2]);
    const double x = pi / 400;
    EXPECT_NEAR(largest / (v0 / omega), 1, x * x) << factor;
  }
}

// The stock program with the library preloaded computes the same numbers, to the last digit.
TEST(NormalImpactStock, StockProgramWithTheLibraryPreloadedIsTheSame) {
  for (const Case& c : {Case{Partner::sphere, 4, 0.3, false}, Case{Partner::mesh, 1, 0.3, true}}) {
    const Measured ours = impact(c, 50), stock = impact(c, 50, Program::stock);
    EXPECT_EQ(ours.restitution, stock.restitution);
    EXPECT_EQ(ours.greatest_overlap, stock.greatest_overlap);
  }
}

// The integrator that later tests use as a reference, on the closed forms. Its step, the contact time over 4000, leaves
// the first and the last step, in which the dashpot sets in and ends: zeta x each in ln e.
TEST(ContactReference, MeetsTheClosedForms) {
  for (const bool limit : {false, true}) {
    Law law;
    law.springFactor = 1;
    law.limitForce = limit;
    Material m;
    m.normalDamping = 0.4;
    const Sphere a{1, R1, 1375, {0, 0, R1 + R2}, {0, 0, -v0}, Vec::Zero()},
        b{1, R2, 1375, Vec::Zero(), Vec::Zero(), Vec::Zero()};
    Contact contact(a, b, m, m, law);
    const double tc = contact.time_scale();
    contact.run(3 * tc);
    const double e = (contact.one().v - contact.two().v)[2] / v0;
    EXPECT_NEAR(std::log(e), std::log(limit ? restitution_without_tension(0.4) : restitution(0.4)),
                2 * 0.4 * pi / 4000);
  }
}

}  // namespace

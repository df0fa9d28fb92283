// SPDX-License-Identifier: GPL-2.0-or-later
/* The eight benchmark impacts of Chung and Ooi (2011), Granular Matter 13:643, through `liggghts`: their bodies,
   speeds, restitution and friction. Tests 1 and 2 are Hertzian there; here this law's own closed forms stand. Set as
   there: no rolling and twisting resistance, no tangential dashpot, k_s/k_n = 2(1 - nu)/(2 - nu) (Mindlin's ratio of
   the material's Poisson number nu), no tension (limitForce on), c_n = 1. Every impact is also compared with the
   independent integrator.

   With x = omega_0 dt = pi/1000 and damping ratio zeta, allowed: (3 zeta x + 2 x^2) v_n (lateness, start and end of the
   dashpot; leapfrog) and, where the contact first sticks, slip counted half a step too long: a spring too long by v_t
   dt/2 for half a period of the slip, omega_t = sqrt(7/2 nu) omega_0, makes sqrt(7/2 nu) x v_t/7 <= 0.27 x v_t. For
   spins times R 5/2 of all that. */
#include "contact_reference.h"

namespace {

using namespace vielto_test;

const double steps_per_contact = 1000, x = pi / steps_per_contact;

struct Solid {
  const char* name;
  double E, poisson, density;
};

Material material(const Solid& s, double friction, double zeta) {
  Material m;
  m.youngsModulus = s.E;
  m.stiffnessRatio = 2 * (1 - s.poisson) / (2 - s.poisson);
  m.frictionAngle = std::atan(friction) * 180 / pi;
  m.normalDamping = zeta;
  m.tangentialDamping = m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  return m;
}

double restitution(double zeta) { return std::exp(-2 * zeta * std::acos(zeta) / std::sqrt(1 - zeta * zeta)); }

// Damping ratio of a wanted restitution, by bisection.
double damping_for(double e) {
  double low = 0, high = 0.999;
  for (int i = 0; i < 100; i++) (restitution((low + high) / 2) > e ? low : high) = (low + high) / 2;
  return e == 1 ? 0 : low;
}

Law law() {
  Law l;
  l.springFactor = 1;
  l.limitForce = true;
  return l;
}

const char* const settings = "springFactor 1 limitForce on";

struct Pair {
  Sphere one, two;  // two: a sphere, or not used on a plane
};

struct Result {
  Sphere one, two;
  double greatest_force, greatest_overlap, duration;  // of the first impact, of the independent integrator
};

// All impacts of one kind in one run, a plane (z = 0) or pairs along z, far from each other; compared with the
// integrator.
std::vector<Result> run_impacts(std::vector<Pair> impacts, bool plane, const Material& m,
                                std::vector<Table>* frames = nullptr) {
  const Sphere ground{1, 1, 1, Vec::Zero(), Vec::Zero(), Vec::Zero()};
  const double R = impacts[0].one.radius, closing = impacts[0].two.v[2] - impacts[0].one.v[2];
  const auto contact_of = [&](const Pair& p) {
    return plane ? Contact(p.one, ground, Vec::UnitZ(), m, m, law()) : Contact(p.one, p.two, m, m, law());
  };
  const double dt = contact_of(impacts[0]).time_scale() / steps_per_contact;
  const double spacing = 6 * std::max(R, plane ? 0 : impacts[0].two.radius);
  const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(impacts.size()))));
  std::vector<Sphere> start;
  for (std::size_t i = 0; i < impacts.size(); i++) {
    Pair& p = impacts[i];
    p.one.x = spacing * Vec(static_cast<double>(i) / side - 0.5 * side, static_cast<int>(i) % side - 0.5 * side, 0);
    p.two.x = p.one.x;
    p.one.x[2] = R + 2.5 * closing * dt;  // touches in the middle of a step
    p.two.x[2] = -p.two.radius;
    start.push_back(p.one);
    if (!plane) start.push_back(p.two);
  }
  const long steps = std::lround(1.2 * steps_per_contact);
  Liggghts run;
  run.script = head(run, start, {m}, (side + 2) * spacing, settings);
  if (plane)
    run.script += fmt::format("fix wall all wall/gran {} primitive type 1 zplane 0.0 {}\n", vielto_models, settings);
  run.script += fmt::format("timestep {:.17g}\nfix move all nve/sphere\n{}run {}\n", dt,
                            dump_grains("states", frames ? 1 : steps), steps);
  run.must();
  const std::vector<Table> all = run.dump("states");
  std::vector<Result> results;
  const double mu = std::tan(m.frictionAngle * pi / 180);
  std::size_t row = 0;
  for (const Pair& p : impacts) {
    const double slip = (p.one.v - p.two.v)[1] + p.one.w[0] * R + p.two.w[0] * p.two.radius;
    const bool sticks = m.stiffnessRatio * std::fabs(slip) < mu * closing;
    const double allowed = (3 * m.normalDamping + 2 * x) * x * closing + (sticks ? 0.27 * x * std::fabs(slip) : 0);
    Contact contact = contact_of(p);
    contact.run(static_cast<double>(steps) * dt);
    Result r = {p.one, p.two, contact.greatestForce, contact.greatestOverlap, contact.duration};
    const auto take = [&](Sphere& s, const Sphere& expected) {
      s.v = all.back().v(row), s.w = all.back().w(row++);
      EXPECT_LT((s.v - expected.v).norm(), allowed);
      EXPECT_LT((s.w - expected.w).norm() * s.radius, 2.5 * allowed);
    };
    take(r.one, contact.one());
    if (!plane) take(r.two, contact.two());
    results.push_back(r);
  }
  if (frames) *frames = all;
  return results;
}

double normal_stiffness(const Solid& s, double R1, double R2) { return 4 * s.E * R1 * R2 / (R1 + R2); }

// Greatest force v sqrt(k m), greatest overlap v sqrt(m/k), duration pi sqrt(m/k), and all speed comes back.
void expect_elastic(const Solid& solid, double R, double speed, bool plane) {
  SCOPED_TRACE(solid.name);
  Pair p = {{1, R, solid.density, Vec::Zero(), {0, 0, -speed}, Vec::Zero()},
            {1, R, solid.density, Vec::Zero(), {0, 0, plane ? 0 : speed}, Vec::Zero()}};
  std::vector<Table> frames;
  const Result r = run_impacts({p}, plane, material(solid, 0.35, 0), &frames)[0];
  const double m = plane ? p.one.mass() : 0.5 * p.one.mass(), k = normal_stiffness(solid, R, plane ? 2 * R : R);
  const double closing = plane ? speed : 2 * speed, dt = pi * std::sqrt(m / k) / steps_per_contact;
  double force = 0, overlap = 0, touching = 0;
  for (const Table& f : frames) {
    force = std::max(force, f.f(0)[2]);
    overlap = std::max(overlap, (plane ? R : 2 * R) - (f.x(0)[2] - (plane ? 0 : f.x(1)[2])));
    touching += f.f(0)[2] > 0 ? dt : 0;
  }
  EXPECT_NEAR(force / (closing * std::sqrt(k * m)), 1, x * x);
  EXPECT_NEAR(overlap / (closing * std::sqrt(m / k)), 1, x * x);
  EXPECT_NEAR(touching, pi * std::sqrt(m / k), dt);  // counted in steps
  EXPECT_NEAR(r.one.v[2] / speed, 1, x * x);
}

TEST(ChungOoi1, ElasticNormalImpactOfTwoIdenticalSpheres) {
  expect_elastic({"glass", 4.8e10, 0.20, 2800}, 0.010, 10, false);
  expect_elastic({"limestone", 2.0e10, 0.25, 2500}, 0.010, 10, false);
}

TEST(ChungOoi2, ElasticNormalImpactOfASphereOnARigidPlane) {
  expect_elastic({"aluminium alloy", 7.0e10, 0.30, 2699}, 0.1, 0.2, true);
  expect_elastic({"magnesium alloy", 4.0e10, 0.35, 1800}, 0.1, 0.2, true);
}

TEST(ChungOoi3, RestitutionOfANormalImpactIsTheOneAskedFor) {
  for (const Solid& solid : {Solid{"aluminium oxide", 3.8e11, 0.23, 4000}, Solid{"cast iron", 1.0e11, 0.25, 7000}})
    for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      const double zeta = damping_for(e);
      const Pair p = {{1, 0.0025, solid.density, Vec::Zero(), {0, 0, -3.9}, Vec::Zero()}, {}};
      const Result r = run_impacts({p}, true, material(solid, 0, zeta))[0];
      // ln e: pi zeta^2 x/(2 (1 - zeta^2)^1.5) for the late dashpot, zeta x for its start, x^2
      EXPECT_NEAR(std::log(r.one.v[2] / 3.9), std::log(e),
                  pi * zeta * zeta * x / (2 * std::pow(1 - zeta * zeta, 1.5)) + zeta * x + x * x)
          << solid.name << " " << e;
    }
}

/* Rebound of a sphere that slips throughout with slip speed `slip` (along y) at normal speed vn: rigid body values

     dv = -mu (1 + e) vn,   dw R = 5/2 of it

   where the spring is at its cap at once (k_s slip > mu k_n vn) and slip is left at the end
   (slip > 7/2 mu (1 + e) vn). Tolerance as above, and the time the spring takes to reach the cap that the dashpot's
   jump sets, 2 (mu zeta vn)^2/(nu slip). */
int expect_gross_sliding(const Sphere& before, const Sphere& after, const Material& m, double mu, double e, double vn,
                         double slip) {
  if (slip < 3.5 * mu * (1 + e) * vn) return 0;
  EXPECT_GT(m.stiffnessRatio * slip, mu * vn);
  const double zeta = m.normalDamping, change = mu * (1 + e) * vn;
  const double tolerance = (3 * zeta + 2 * x) * x * vn + 2 * std::pow(mu * zeta * vn, 2) / (m.stiffnessRatio * slip);
  EXPECT_NEAR(after.v[1] - before.v[1], -change, tolerance);
  EXPECT_NEAR((after.w[0] - before.w[0]) * before.radius, -2.5 * change, 2.5 * tolerance);
  return 1;
}

TEST(ChungOoi4, ObliqueImpactAtConstantSpeedAndVaryingAngle) {
  const double mu = 0.092, e = 0.98, speed = 3.9, R = 0.0025;
  for (const Solid& solid :
       {Solid{"aluminium oxide", 3.8e11, 0.23, 4000}, Solid{"aluminium alloy", 7.0e10, 0.33, 2700}}) {
    SCOPED_TRACE(solid.name);
    const Material m = material(solid, mu, damping_for(e));
    // all impacts of a run touch in the middle of a step only if the normal speed is the same: one run an angle
    int sliding = 0;
    for (const double degrees : {5.0, 15.0, 25.0, 35.0, 45.0, 60.0, 75.0, 85.0}) {
      SCOPED_TRACE(degrees);
      const double vt = speed * std::sin(degrees * pi / 180), vn = speed * std::cos(degrees * pi / 180);
      const Pair p = {{1, R, solid.density, Vec::Zero(), {0, vt, -vn}, Vec::Zero()}, {}};
      const Sphere after = run_impacts({p}, true, m)[0].one;
      sliding += expect_gross_sliding(p.one, after, m, mu, e, vn, vt);
      // whatever the friction, it acts at the lever R: dw R = 5/2 dv, to round-off
      EXPECT_NEAR(after.w[0] * R, 2.5 * (after.v[1] - vt), 1e-12 * speed);
    }
    EXPECT_EQ(sliding, 5);  // tan(angle) > 7/2 mu (1 + e) = 0.64: from 35 degrees on
  }
}

TEST(ChungOoi5, ObliqueImpactAtConstantNormalSpeed) {
  const double mu = 0.3, vn = 5, R = 1e-5;
  for (const Solid& solid : {Solid{"steel", 2.08e11, 0.30, 7850}, Solid{"polyethylene", 1.0e9, 0.40, 1400}}) {
    SCOPED_TRACE(solid.name);
    const Material m = material(solid, mu, 0);
    std::vector<Pair> impacts;
    const std::vector<double> incidence = {0.5, 1, 2, 3, 4, 5, 6, 6.5, 7.5, 8, 10, 12, 14};  // v_t/(mu v_n)
    for (const double psi : incidence)
      impacts.push_back({{1, R, solid.density, Vec::Zero(), {0, psi * mu * vn, -vn}, Vec::Zero()}, {}});
    const std::vector<Result> results = run_impacts(impacts, true, m);
    int sliding = 0;
    for (std::size_t i = 0; i < results.size(); i++) {
      const Sphere& after = results[i].one;
      sliding += expect_gross_sliding(impacts[i].one, after, m, mu, 1, vn, incidence[i] * mu * vn);
      // above 7 the slip that is left is 7 less, and the spin R w/(mu v_n) is -5
      if (incidence[i] > 7) {
        EXPECT_NEAR((after.v[1] + after.w[0] * R) / (mu * vn), incidence[i] - 7, 7 * 2 * x * x / mu);
        EXPECT_NEAR(after.w[0] * R / (mu * vn), -5, 5 * 2 * x * x / mu);
      }
    }
    EXPECT_EQ(sliding, 5);
  }
}

const std::vector<double> spins = {0.175, 0.3, 0.7, 1.3, 2, 4, 7, 12, 22};  // rad/s

TEST(ChungOoi6, NormalImpactOnAPlaneAtVaryingSpin) {
  const double mu = 0.4, e = 0.5, vn = 0.2, R = 0.1;
  for (const Solid& solid : {Solid{"aluminium alloy", 7.0e10, 0.33, 2700}, Solid{"copper", 1.2e11, 0.35, 8900}}) {
    SCOPED_TRACE(solid.name);
    const Material m = material(solid, mu, damping_for(e));
    std::vector<Pair> impacts;
    for (const double w : spins) impacts.push_back({{1, R, solid.density, Vec::Zero(), {0, 0, -vn}, {w, 0, 0}}, {}});
    const std::vector<Result> results = run_impacts(impacts, true, m);
    int sliding = 0;
    for (std::size_t i = 0; i < results.size(); i++)
      sliding += expect_gross_sliding(impacts[i].one, results[i].one, m, mu, e, vn, spins[i] * R);
    EXPECT_EQ(sliding, 3);  // R w > 7/2 * 0.4 * 1.5 * 0.2 = 0.42 m/s
  }
}

// Opposite spins: the surfaces do not slip, so nothing but the normal speed changes.
TEST(ChungOoi7, IdenticalSpheresWithOppositeSpinsDoNotFeelFriction) {
  const double e = 0.5, vn = 0.2, R = 0.1;
  for (const Solid& solid : {Solid{"aluminium alloy", 7.0e10, 0.33, 2700}, Solid{"copper", 1.2e11, 0.35, 8900}}) {
    SCOPED_TRACE(solid.name);
    std::vector<Pair> impacts;
    for (const double w : spins)
      impacts.push_back({{1, R, solid.density, Vec::Zero(), {0, 0, -vn}, {w, 0, 0}},
                         {1, R, solid.density, Vec::Zero(), {0, 0, vn}, {-w, 0, 0}}});
    const Material m = material(solid, 0.4, damping_for(e));
    const std::vector<Result> results = run_impacts(impacts, false, m);
    for (std::size_t i = 0; i < results.size(); i++) {
      EXPECT_NEAR(results[i].one.v[2], e * vn, (3 * m.normalDamping + 2 * x) * x * 2 * vn);
      EXPECT_LT(Vec(results[i].one.v - Vec(0, 0, results[i].one.v[2])).norm(), 1e-14);
      EXPECT_NEAR(results[i].one.w[0], spins[i], 1e-12);
      EXPECT_NEAR(results[i].two.w[0], -spins[i], 1e-12);
    }
  }
}

// The large sphere is 5 times as wide and 1000 times as dense: 125 000 times the mass, as good as a plane.
TEST(ChungOoi8, SpinningSphereOnAMuchLargerOne) {
  const double mu = 0.4, e = 0.5, vn = 0.2, R = 0.1;
  for (const Solid& solid : {Solid{"aluminium alloy", 7.0e10, 0.33, 2700}, Solid{"nylon", 2.5e9, 0.40, 1000}}) {
    SCOPED_TRACE(solid.name);
    const Material m = material(solid, mu, damping_for(e));
    std::vector<Pair> impacts;
    for (const double w : spins)
      impacts.push_back({{1, R, solid.density, Vec::Zero(), {0, 0, -vn}, {w, 0, 0}},
                         {1, 5 * R, 1000 * solid.density, Vec::Zero(), Vec::Zero(), Vec::Zero()}});
    const std::vector<Result> results = run_impacts(impacts, false, m);
    int sliding = 0;
    for (std::size_t i = 0; i < results.size(); i++)
      sliding += expect_gross_sliding(impacts[i].one, results[i].one, m, mu, e, vn, spins[i] * R);
    EXPECT_EQ(sliding, 3);
  }
}

}  // namespace

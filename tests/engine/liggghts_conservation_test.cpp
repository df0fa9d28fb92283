// SPDX-License-Identifier: GPL-2.0-or-later
// What a contact law must keep: momentum, angular momentum to its stated bound, an energy that never grows, and
// similarity (grains twice as large at equal velocities), all on many grains at once through `liggghts`.
#include <random>

#include "contact_reference.h"

namespace {

using namespace vielto_test;

// Unequal grains of two materials that fly into each other at the origin, spinning; none touches at the start. Times
// `scale`.
std::vector<Sphere> swarm(double scale = 1, int count = 90) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto random_vec = [&](double size) -> Vec { return size * Vec(unit(engine), unit(engine), unit(engine)); };
  std::vector<Sphere> spheres;
  while (static_cast<int>(spheres.size()) < count) {
    Sphere s{1 + static_cast<int>(spheres.size()) % 2,
             0.004 + 0.0015 * unit(engine),
             1400,
             random_vec(0.025),
             Vec::Zero(),
             random_vec(100)};
    s.v = -30 * s.x + random_vec(0.3);
    const auto touches = [&s](const Sphere& o) { return (s.x - o.x).norm() < s.radius + o.radius; };
    if (std::any_of(spheres.begin(), spheres.end(), touches)) continue;
    spheres.push_back(s);
  }
  for (Sphere& s : spheres) s.radius *= scale, s.x *= scale, s.w /= scale;
  return spheres;
}

std::vector<Material> two_materials(double damping) {
  return {{1.0e5, 0.5, 25, damping, damping, 0.4, 0.6, 0.10, 0.20},
          {2.5e5, 0.8, 15, damping, damping, 0.9, 0.3, 0.05, 0.40}};
}

const double dt = 3e-6;  // the stiffest contact of these soft grains has 3e-4 s: x = omega dt = pi/100

std::string swarm_script(const Liggghts& run, const std::vector<Sphere>& spheres, const std::vector<Material>& types,
                         const std::string& settings, long every, long steps) {
  return head(run, spheres, types, 0.2, settings) + fmt::format("timestep {}\nfix move all nve/sphere\n", dt) +
         "compute contacts all pair/gran/local id history delta\n" + dump_grains("states", every) +
         fmt::format(
             "dump contacts all local {0} contacts c_contacts[1] c_contacts[2] c_contacts[4] c_contacts[5] "
             "c_contacts[6] "
             "c_contacts[7] c_contacts[8] c_contacts[9] c_contacts[10] c_contacts[11]\n"
             "dump_modify contacts format \"%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\"\nrun {1}\n",
             every, steps);
}

double kinetic(const std::vector<Sphere>& spheres, const Table& frame) {
  double sum = 0;
  for (std::size_t i = 0; i < spheres.size(); i++)
    sum += 0.5 * spheres[i].mass() * frame.v(i).squaredNorm() + 0.5 * spheres[i].inertia() * frame.w(i).squaredNorm();
  return sum;
}

// Energy of all springs: 1/2 c_n k_n u^2 + F_s^2/(2 k_s) + M_r^2/(2 k_r) + M_tw^2/(2 k_tw), stiffnesses by the printed
// formulas.
double stored(const std::vector<Sphere>& spheres, const std::vector<Material>& types, const Table& contacts) {
  double sum = 0;
  for (const std::vector<double>& row : contacts.rows) {
    const Sphere &a = spheres[static_cast<std::size_t>(row[0]) - 1], &b = spheres[static_cast<std::size_t>(row[1]) - 1];
    const Contact c(a, b, types[static_cast<std::size_t>(a.type - 1)], types[static_cast<std::size_t>(b.type - 1)],
                    Law());
    const Vec F(row[2], row[3], row[4]), M(row[5], row[6], row[7]);
    sum += 0.5 * 4 * c.kn * row[9] * row[9] + 0.5 * F.squaredNorm() / c.ks;
    if (c.kr > 0) sum += 0.5 * M.squaredNorm() / c.kr;
    if (c.ktw > 0) sum += 0.5 * row[8] * row[8] / c.ktw;
  }
  return sum;
}

struct EnergyCase {
  const char* name;
  double damping, friction;
  bool moments, conserved;
};

std::string energy_name(const testing::TestParamInfo<EnergyCase>& tested) { return tested.param.name; }

class Energy : public testing::TestWithParam<EnergyCase> {};

/* Kinetic plus stored energy of a leapfrog oscillator swings by x^2/4 of its energy, x = omega dt = pi/100. Normal,
   sliding and rolling, and twisting modes each do, and a contact that sets in or opens within a step errs by as much
   once more: x^2 of the initial energy may come back. */
TEST_P(Energy, NeverGrows) {
  const EnergyCase c = GetParam();
  std::vector<Material> types = two_materials(c.damping);
  for (Material& m : types) {
    m.frictionAngle = c.friction;
    if (!c.moments) m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  }
  const std::vector<Sphere> spheres = swarm();
  Liggghts run;
  run.script = swarm_script(run, spheres, types, "", 20, 6000);
  run.must();
  const std::vector<Table> states = run.dump("states"), contacts = run.dump("contacts");
  ASSERT_EQ(states.size(), contacts.size());
  const double first = kinetic(spheres, states[0]), swing = std::pow(pi / 100, 2) * first;
  double least = first;
  std::size_t most = 0;
  for (std::size_t k = 0; k < states.size(); k++) {
    const double now = kinetic(spheres, states[k]) + stored(spheres, types, contacts[k]);
    EXPECT_LT(now, least + swing) << "step " << states[k].step;
    if (c.conserved) {
      EXPECT_NEAR(now, first, swing) << "step " << states[k].step;
    }
    least = std::min(least, now);
    most = std::max(most, contacts[k].rows.size());
  }
  EXPECT_GT(most, 12u);  // a crowd, not single impacts
  if (!c.conserved) {
    EXPECT_LT(least, 0.95 * first);  // and energy is indeed lost
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, Energy,
                         testing::Values(EnergyCase{"normal_springs_only_keep_it", 0, 0, false, true},
                                         EnergyCase{"friction_without_dashpots", 0, 20, true, false},
                                         EnergyCase{"springs_that_never_slide", 0, 89, true, false},
                                         EnergyCase{"dashpots_and_friction", 0.3, 20, true, false},
                                         EnergyCase{"strong_dashpots", 1, 20, true, false}),
                         energy_name);

/* Momentum is kept to round-off: forces are equal and opposite bit by bit, so only sums of N grains over n steps round,
   sqrt(6000) 1e-16 of the sum of all momenta; 1e-13 leaves room. With radiusLever off the levers add up to the distance
   and angular momentum is kept to round-off too. */
TEST(Momentum, IsKeptToRoundOff) {
  const std::vector<Sphere> spheres = swarm();
  for (const bool shortened : {false, true}) {
    Liggghts run;
    run.script = swarm_script(run, spheres, two_materials(0.3), shortened ? "radiusLever off" : "", 400, 6000);
    run.must();
    double scale = 0, scale_turn = 0;
    for (const Sphere& s : spheres) {
      scale += s.mass() * s.v.norm();
      scale_turn += s.mass() * s.x.norm() * s.v.norm() + s.inertia() * s.w.norm();
    }
    Vec first = Vec::Zero(), first_turn = Vec::Zero();
    const std::vector<Table> states = run.dump("states");
    for (const Table& frame : states) {
      Vec linear = Vec::Zero(), turn = Vec::Zero();
      for (std::size_t i = 0; i < spheres.size(); i++) {
        linear += spheres[i].mass() * frame.v(i);
        turn += spheres[i].mass() * frame.x(i).cross(frame.v(i)) + spheres[i].inertia() * frame.w(i);
      }
      if (frame.step == 0) first = linear, first_turn = turn;
      EXPECT_LT((linear - first).norm(), 1e-13 * scale) << "step " << frame.step;
      if (shortened) {
        EXPECT_LT((turn - first_turn).norm(), 1e-13 * scale_turn) << "step " << frame.step;
      }
    }
  }
}

/* With the printed levers R_i a contact turns the pair by the moment u_n n x F_t, of its moments (R_1 + R_2) n x F_t at
   most the part u_n/(R_1 + R_2): the stated bound. Sliding in one direction (no rolling), so that impulses add up. */
TEST(AngularMomentum, IsKeptToOverlapOverSumOfRadii) {
  Material m;
  m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  m.frictionAngle = 10;
  const double R1 = 0.004, R2 = 0.006;
  const std::vector<Sphere> start = {{1, R1, 1400, {0, 0, 0}, {0.5, 1.5, 0}, {0, 0, 50}},
                                     {1, R2, 1400, {R1 + R2 + 1e-6, 0, 0}, Vec::Zero(), Vec::Zero()}};
  for (const bool shortened : {false, true}) {
    Liggghts run;
    run.script = swarm_script(run, start, {m}, shortened ? "radiusLever off" : "", 1, 600);
    run.must();
    double overlap = 0;
    Vec turn[2];
    const std::vector<Table> states = run.dump("states");
    for (const Table* frame : {&states.front(), &states.back()}) {
      Vec& sum = turn[frame == &states.back()];
      sum.setZero();
      for (std::size_t i = 0; i < 2; i++)
        sum += start[i].mass() * frame->x(i).cross(frame->v(i)) + start[i].inertia() * frame->w(i);
    }
    for (const Table& frame : states) overlap = std::max(overlap, R1 + R2 - (frame.x(0) - frame.x(1)).norm());
    double transferred = 0;
    for (std::size_t i = 0; i < 2; i++)
      transferred += start[i].inertia() * (states.back().w(i) - states.front().w(i)).norm();
    ASSERT_GT(overlap, 0);
    const double change = (turn[1] - turn[0]).norm();
    if (shortened) {
      EXPECT_LT(change, 1e-13 * start[0].mass() * 0.5 * (R1 + R2));  // round-off of 600 steps
    } else {
      EXPECT_LT(change, overlap / (R1 + R2) * transferred);
      EXPECT_GT(change, 0.3 * overlap / (R1 + R2) * transferred);  // the bound is not idle: mean over largest overlap
    }
  }
}

/* Similarity: places and radii times s, velocities as they are, spins over s, time times s. Every force then grows by
   s^2, every moment by s^3 and every velocity stays. For s = 2 all factors are powers of two and even the rounding is
   the same; for s = 3 rounding grows through the collisions, by about 1/angle = distance/radius each: a few hundred
   times after two collisions. */
class Similarity : public testing::TestWithParam<double> {};

TEST_P(Similarity, ForcesGrowWithTheSquareAndMomentsWithTheCube) {
  const double s = GetParam(), tolerance = s == 2 ? 1e-14 : 1e-9;
  std::vector<std::vector<Table>> states;
  for (const double scale : {1.0, s}) {
    const std::vector<Sphere> spheres = swarm(scale, 30);
    Liggghts run;
    run.script =
        head(run, spheres, two_materials(0.3), 0.2 * scale, "") +
        fmt::format("fix wall all wall/gran {} primitive type 1 zplane {:.17g}\n", vielto_models, -0.03 * scale) +
        fmt::format("timestep {:.17g}\nfix move all nve/sphere\n{}run 4000\n", dt * scale, dump_grains("states", 200));
    run.must();
    states.push_back(run.dump("states"));
  }
  double greatest_force = 0, greatest_moment = 0;
  for (std::size_t k = 0; k < states[0].size(); k++) {
    const Table &small = states[0][k], &large = states[1][k];
    for (std::size_t i = 0; i < small.rows.size(); i++) {
      // scales of this swarm: 1 N, 5e-3 N m, 1 m/s, 0.05 m, 200 rad/s
      EXPECT_LT((large.f(i) / (s * s) - small.f(i)).norm(), tolerance);
      EXPECT_LT((large.torque(i) / (s * s * s) - small.torque(i)).norm(), 5e-3 * tolerance);
      EXPECT_LT((large.v(i) - small.v(i)).norm(), tolerance);
      EXPECT_LT((large.w(i) * s - small.w(i)).norm(), 200 * tolerance);
      EXPECT_LT((large.x(i) / s - small.x(i)).norm(), 0.05 * tolerance);
      greatest_force = std::max(greatest_force, small.f(i).norm());
      greatest_moment = std::max(greatest_moment, small.torque(i).norm());
    }
  }
  EXPECT_GT(greatest_force, 0.5);
  EXPECT_GT(greatest_moment, 5e-4);
}

INSTANTIATE_TEST_SUITE_P(Factors, Similarity, testing::Values(2.0, 3.0));

}  // namespace

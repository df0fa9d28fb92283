// SPDX-License-Identifier: GPL-2.0-or-later
/* One sphere on a plane under gravity, through `liggghts`: rolling, spinning and sliding that decay at the cap, and the
   slope at which the sphere leaves.

     I = 2/5 m R^2,   L = 2 R_1R_2/(R_1 + R_2),   R_2 = wallRadiusFactor R_1,   F_n = m g cos(slope) */
#include "contact_reference.h"

namespace {

using namespace vielto_test;

const double R = 0.005, g = 9.81, dt = 1e-5;  // contact time 3.6e-4 s at c_n = 4: 36 steps

double mass() { return Sphere{1, R}.mass(); }
double kn(const Material& m, double factor) { return 4 * m.youngsModulus * R * factor / (1 + factor); }
double rolling_length(double factor) { return 2 * factor / (1 + factor) * R; }

enum class Wall { primitive, mesh };

// A sphere that touches the plane z = 0 with the overlap of its weight; the script up to the gravity fix.
std::string sphere_on_plane(const Liggghts& run, Sphere s, const Material& m, const std::string& settings, Wall wall,
                            double factor = 2, double cn = 4) {
  s.x[2] = R - mass() * g / (cn * kn(m, factor));
  std::string text = head(run, {s}, {m}, 0.3, settings);
  run.write("plate.stl", plate_stl(0.25));
  if (wall == Wall::mesh)
    text += "fix plate all mesh/surface file plate.stl type 1\n" +
            fmt::format("fix wall all wall/gran {} mesh n_meshes 1 meshes plate {}\n", vielto_models, settings);
  else
    text += fmt::format("fix wall all wall/gran {} primitive type 1 zplane 0.0 {}\n", vielto_models, settings);
  return text + fmt::format("timestep {}\nfix move all nve/sphere\n", dt);
}

std::string level_gravity() { return fmt::format("fix gravity all gravity {} vector 0 0 -1\n", g); }

class RollingSphere : public testing::TestWithParam<std::tuple<Wall, double, double>> {};

/* Rolling without slip: m dv/dt = f and I dw/dt = -f R - M with v = w R, so

     dv/dt = -M R/(I + m R^2) = -(5/7) mu_r g L/R,   w = v/R

   Tolerance: once the start's oscillations are damped out every force is constant and the leapfrog exact; 1e-6 relative
   is left to them. */
TEST_P(RollingSphere, SlowsDownAtTheCappedRollingMoment) {
  const auto [wall, factor, muR] = GetParam();
  Material m;
  m.rollingResistance = muR;
  Liggghts run;
  const double v0 = 0.4;
  const std::string settings = fmt::format("wallRadiusFactor {}", factor);
  const double a = 5.0 / 7 * muR * g * rolling_length(factor) / R;
  const long half = std::lround(0.4 * v0 / a / dt);  // stops after v0/a
  run.script =
      sphere_on_plane(run, {1, R, 1375, {-0.1, 0.01, 0}, {v0, 0, 0}, {0, v0 / R, 0}}, m, settings, wall, factor) +
      level_gravity() + dump_grains("states", half) + fmt::format("run {}\n", 2 * half);
  run.must();
  const std::vector<Table> frames = run.dump("states");
  ASSERT_EQ(frames.size(), 3u);
  const double slope = (frames[2].v(0)[0] - frames[1].v(0)[0]) / (static_cast<double>(half) * dt);
  EXPECT_NEAR(slope / -a, 1, 1e-6);
  for (const Table& f : frames) EXPECT_NEAR(f.w(0)[1] * R / f.v(0)[0], 1, 1e-6);
  EXPECT_NEAR(frames[2].torque(0)[1] / (-0.4 * mass() * R * a), 1, 1e-6);  // I dw/dt
}

INSTANTIATE_TEST_SUITE_P(Walls, RollingSphere,
                         testing::Combine(testing::Values(Wall::primitive, Wall::mesh), testing::Values(1.0, 2.0, 5.0),
                                          testing::Values(0.1, 0.3)));

// wallRolling adds to mu_r on walls: the sphere slows down as if both made one resistance. Two spheres know nothing of
// it.
TEST(WallRolling, AddsToTheResistanceOfWallsOnly) {
  Material m;
  m.rollingResistance = 0.1;
  const double v0 = 0.4, factor = 2, a = 5.0 / 7 * (0.1 + 0.2) * g * rolling_length(factor) / R;
  const long half = std::lround(0.4 * v0 / a / dt);
  for (const Wall wall : {Wall::primitive, Wall::mesh}) {
    Liggghts run;
    run.script = sphere_on_plane(run, {1, R, 1375, {-0.1, 0.01, 0}, {v0, 0, 0}, {0, v0 / R, 0}}, m,
                                 "wallRadiusFactor 2 wallRolling 0.2", wall, factor) +
                 level_gravity() + dump_grains("states", half) + fmt::format("run {}\n", 2 * half);
    run.must();
    const std::vector<Table> frames = run.dump("states");
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_NEAR((frames[2].v(0)[0] - frames[1].v(0)[0]) / (static_cast<double>(half) * dt) / -a, 1, 1e-6);
  }
  const auto met = [&](const std::string& settings) {
    Liggghts run;
    const std::vector<Sphere> spheres = {{1, R, 1375, {0, 0, 0}, {0.2, 0, 0}, {30, 0, 20}},
                                         {1, R, 1375, {2 * R + 1e-5, 0.001, 0}, {-0.2, 0, 0}, {0, 40, -10}}};
    run.script = head(run, spheres, {m}, 0.3, settings) + fmt::format("timestep {}\nfix move all nve/sphere\n", dt) +
                 dump_grains("states", 200) + "run 200\n";
    run.must();
    return run.dump("states").back();
  };
  const Table with = met("wallRolling 0.2"), without = met("");
  for (std::size_t i = 0; i < 2; i++) EXPECT_EQ((with.w(i) - without.w(i)).norm(), 0);
  EXPECT_GT((with.w(0) - Vec(30, 0, 20)).norm(), 1);
}

/* Spinning about the normal: I dw/dt = -mu_tw tan(phi') m g L, so dw/dt = -(5/2) mu_tw tan(phi') g L/R^2; the sphere
   stays where it is. */
TEST(SpinningSphere, SlowsDownAtTheCappedTwistingMoment) {
  for (const Wall wall : {Wall::primitive, Wall::mesh})
    for (const double factor : {2.0, 5.0}) {
      Material m;
      m.twistingResistance = 0.2;
      Liggghts run;
      const double rate = 2.5 * 0.2 * std::tan(25 * pi / 180) * g * rolling_length(factor) / (R * R), w0 = 300;
      const long half = std::lround(0.4 * w0 / rate / dt);
      run.script = sphere_on_plane(run, {1, R, 1375, {0.011, 0.02, 0}, Vec::Zero(), {0, 0, w0}}, m,
                                   fmt::format("wallRadiusFactor {}", factor), wall, factor) +
                   level_gravity() + dump_grains("states", half) + fmt::format("run {}\n", 2 * half);
      run.must();
      const std::vector<Table> frames = run.dump("states");
      EXPECT_NEAR((frames[2].w(0)[2] - frames[1].w(0)[2]) / (-rate * static_cast<double>(half) * dt), 1, 1e-6);
      EXPECT_LT((frames[2].x(0) - frames[0].x(0)).norm(), 1e-12);
    }
}

/* Thrown without spin: friction acts at the lever R, so m v R + I w is kept and the sphere ends in rolling at 5/7 v_0,
   with or without a tangential dashpot; without rolling resistance it keeps that speed. While it slides without dashpot
   v = v_0 - tan(phi') g t. */
TEST(SlidingSphere, EndsRollingAtFiveSevenths) {
  for (const bool dashpot : {true, false}) {
    Material m;
    m.rollingStiffnessFactor = 0;
    m.tangentialDamping = dashpot ? 0.3 : 0.0;
    Liggghts run;
    const double v0 = 0.7, mu = std::tan(25 * pi / 180);
    const double stop = 2 * v0 / (7 * mu * g);  // of the slip, without dashpot
    const long steps = std::lround(0.5 * stop / dt);
    run.script = sphere_on_plane(run, {1, R, 1375, {-0.1, 0, 0}, {v0, 0, 0}, Vec::Zero()}, m, "", Wall::primitive) +
                 level_gravity() + dump_grains("states", steps) + fmt::format("run {}\n", 8 * steps);
    run.must();
    const std::vector<Table> frames = run.dump("states");
    // one spring relaxes when it reaches the cap: half a period of the slip, 2 steps of 1e-5 s
    if (!dashpot) {
      EXPECT_NEAR(frames[1].v(0)[0], v0 - mu * g * 0.5 * stop, mu * g * 3 * dt);
    }
    for (std::size_t k = 3; k <= 8; k++) {
      const Vec v = frames[k].v(0), w = frames[k].w(0);
      EXPECT_NEAR(v[0] + 0.4 * R * w[1], v0, 1e-12 * v0);  // kept to round-off at every moment
      // an undamped slip spring goes on ringing: its energy is at most (m g mu)^2/(2 k_s), of reduced mass 2/7 m
      const double ringing = dashpot ? 1e-7 : mu * g * std::sqrt(3.5 * mass() / (0.5 * kn(m, 2)));
      EXPECT_NEAR(v[0], 5.0 / 7 * v0, ringing);
      EXPECT_NEAR(w[1] * R, 5.0 / 7 * v0, 2.5 * ringing);
    }
  }
}

// ---- a slope ----

struct Slope {
  const char* name;
  double frictionAngle, muR, factor;
  Wall wall;
};

std::string slope_name(const testing::TestParamInfo<Slope>& tested) { return tested.param.name; }

/* Gravity is tilted slowly to a slope with tan = `share` of the smaller limit, then kept there. 0.1 s are 57 periods of
   the rolling spring (omega^2 = k_r/(7/5 m R^2)), so the undamped spring overshoots by 1/(2 pi 57) = 0.3 % only. */
struct Released {
  double tangent, displacement, speed, rolling;  // x and v_x at the end, w_y R
};

const double tilt_time = 0.1, hold_time = 0.1;

Released tilt(const Slope& s, double share, const std::string& settings) {
  Material m;
  m.frictionAngle = s.frictionAngle;
  m.rollingResistance = s.muR;
  const double limit = std::min(std::tan(s.frictionAngle * pi / 180), s.muR * rolling_length(s.factor) / R);
  const double angle = std::atan(share * limit) * 180 / pi;
  Liggghts run;
  run.script = sphere_on_plane(run, {1, R, 1375, {0.001, 0.01, 0}, Vec::Zero(), Vec::Zero()}, m,
                               fmt::format("wallRadiusFactor {} {}", s.factor, settings), s.wall, s.factor) +
               fmt::format("variable angle equal ramp(0,{:.17g})\nfix gravity all gravity {} chute v_angle\nrun {}\n",
                           angle, g, std::lround(tilt_time / dt)) +
               fmt::format("variable angle equal {:.17g}\n{}run {}\n", angle,
                           dump_grains("states", std::lround(hold_time / dt)), std::lround(hold_time / dt));
  run.must();
  const Table last = run.dump("states").back();
  return {share * limit, last.x(0)[0] - 0.001, last.v(0)[0], last.w(0)[1] * R};
}

class SphereOnSlope : public testing::TestWithParam<Slope> {};

// Below: it stays, held by the springs at F (1/k_s + R^2/k_r), F = m g sin(slope), and rings by 0.3 % of that at most.
TEST_P(SphereOnSlope, StaysBelowTheSmallerLimit) {
  const Slope s = GetParam();
  const Released r = tilt(s, 0.98, "");
  const Material m;
  const double F = mass() * g * r.tangent / std::sqrt(1 + r.tangent * r.tangent);
  const double k = kn(m, s.factor), elastic = F * (1 / (0.5 * k) + R * R / (0.5 * k * s.factor * R * R));
  EXPECT_NEAR(r.displacement / elastic, 1, 0.003);
}

/* Above: it leaves. Where rolling gives way first, dv/dt = 5/7 g (sin - mu_r L/R cos), rolling without slip. Where
   friction does, the dashpot of the default setting brakes it to m g (sin - tan(phi') cos)/gamma_s; without
   (slidingDashpot off) it is dv/dt = g (sin - tan(phi') cos), and nothing rolls. The last 0.02/1.02 of the tilt is
   under growing surplus: half of that time is added, which leaves the curvature of sin and cos over 2 % of a slope of
   0.2, and the ringing: 0.5 %. */
TEST_P(SphereOnSlope, LeavesAboveTheSmallerLimit) {
  const Slope s = GetParam();
  const double sliding = std::tan(s.frictionAngle * pi / 180), rolling = s.muR * rolling_length(s.factor) / R;
  for (const bool dashpot : {true, false}) {
    const Released r = tilt(s, 1.02, dashpot ? "" : "slidingDashpot off");
    const double cosine = 1 / std::sqrt(1 + r.tangent * r.tangent);
    const double surplus = g * cosine * (r.tangent - std::min(sliding, rolling));
    const double time = hold_time + 0.5 * 0.02 / 1.02 * tilt_time;
    if (rolling < sliding) {
      EXPECT_NEAR(r.speed / (5.0 / 7 * surplus * time), 1, 0.005);
      EXPECT_NEAR(r.rolling / r.speed, 1, 0.001);
    } else if (dashpot) {
      const double gamma = 2 * std::sqrt(0.5 * kn(Material(), s.factor) * mass()) * 0.3;
      EXPECT_NEAR(r.speed / (mass() * surplus / gamma), 1, 0.001);
    } else {
      EXPECT_NEAR(r.speed / (surplus * time), 1, 0.005);
      EXPECT_LT(std::fabs(r.rolling), 0.001 * r.speed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Limits, SphereOnSlope,
                         testing::Values(Slope{"rolling_gives_way", 25, 0.15, 2, Wall::primitive},
                                         Slope{"rolling_gives_way_on_a_mesh", 25, 0.15, 2, Wall::mesh},
                                         Slope{"rolling_gives_way_wall_radius_1", 25, 0.15, 1, Wall::primitive},
                                         Slope{"rolling_gives_way_wall_radius_5", 25, 0.15, 5, Wall::primitive},
                                         Slope{"friction_gives_way", 10, 1, 2, Wall::primitive},
                                         Slope{"friction_gives_way_on_a_mesh", 10, 1, 2, Wall::mesh}),
                         slope_name);

}  // namespace

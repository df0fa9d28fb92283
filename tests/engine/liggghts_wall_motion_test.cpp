// SPDX-License-Identifier: GPL-2.0-or-later
/* Moving mesh walls, through `liggghts`: the law sees the wall's spin, so a grain that rides a turning wall rolls on
   nothing, and rolling and twisting couples appear on the mesh. Stock meaning of a mesh/surface/stress: f_ID[1..3] is
   the force of the grains on the mesh, f_ID[4..6] their torque about the reference point. */
#include "contact_reference.h"

namespace {

using namespace vielto_test;

const double R = 0.005, dt = 1e-5;

double mass() { return Sphere{1, R}.mass(); }
double kn() { return 4 * Material().youngsModulus * R * 2 / 3; }  // sphere on a wall, R_2 = 2 R_1

std::string mesh_wall(const Liggghts& run, const std::string& stl, const std::string& settings = "") {
  run.write("plate.stl", stl);
  return "fix plate all mesh/surface/stress file plate.stl type 1 reference_point 0 0 0\n" +
         fmt::format(
             "fix wall all wall/gran {} mesh n_meshes 1 meshes plate {}\ntimestep {}\nfix move all nve/sphere\n",
             vielto_models, settings, dt);
}

const char* const thermo_mesh =
    "variable fx equal f_plate[1]\nvariable fy equal f_plate[2]\nvariable fz equal f_plate[3]\n"
    "variable mx equal f_plate[4]\nvariable my equal f_plate[5]\nvariable mz equal f_plate[6]\n"
    "thermo_style custom step v_fx v_fy v_fz v_mx v_my v_mz\nthermo_modify format float %.17g lost ignore norm no\n";

/* A plate faces the axis (y through the origin) at distance D and turns about it; a sphere rides on its inner side,
   pressed on by m Omega^2 (D - R). Nothing slips or rolls relative to the plate, so no tangential force and no moment
   act at all. Did the wall hand over no spin, the rolling moment would stand at its cap. The first quarter of the turn
   is left out: the plate sets out with a jerk, whose swing the dashpots soon damp out. With the printed lever R, u more
   than the distance from the plate, the sphere lags behind: its orbit has Omega (1 - u/(D - R)), its force so much less
   than the load (and u is 1.4 % less, as the late dashpot bears gamma_n Omega^2 D dt/2). */
TEST(RidingAPlate, FeelsNoRollingMoment) {
  Material m;
  m.rollingResistance = 0.5;
  const double D = 0.05, omega = 30, period = 2 * pi / omega;
  const double load = mass() * omega * omega * (D - R), u = load / (4 * kn());
  const Sphere s{1, R, 1375, {0, 0, -D + R - u}, {-omega * (D - R + u), 0, 0}, {0, omega, 0}};
  Liggghts run;
  run.script =
      head(run, {s}, {m}, 0.2) + mesh_wall(run, plate_stl(0.04, {0, 0, -D})) +
      fmt::format("fix turn all move/mesh mesh plate rotate origin 0 0 0 axis 0 1 0 period {:.17g}\n", period) +
      dump_grains("states", 100) + fmt::format("run {}\n", std::lround(period / dt));
  run.must();
  const double cap = 0.5 * load * 4.0 / 3 * R;
  for (const Table& f : run.dump("states")) {
    if (static_cast<double>(f.step) * dt < 0.25 * period) continue;
    EXPECT_NEAR(f.f(0).norm() / load, 1 - u / (D - R), 0.02 * u / (D - R)) << f.step;
    EXPECT_LT(f.torque(0).norm(), 1e-6 * cap) << f.step;
    EXPECT_NEAR(f.w(0)[1] / omega, 1, 1e-6) << f.step;
  }
}

/* A turntable: a sphere rides a level plate that turns about its normal, at a distance r from the axis. Friction holds
   it with m Omega^2 r towards the axis, and the rolling moment with R times that; both are stored forces that turn with
   the plate. The sphere stays at its place on the plate, further out by the stretch of the springs,

     m Omega^2 r (1/k_s + R^2/k_r)

   but for a creep towards the axis with Omega^2 r dt/2 (1e-5 m/s here): LIGGGHTS hands over the grain's velocity of
   half a step before, which points outwards by that. A stored force that turned more slowly than the plate would leave
   the radius. Tolerance: the start's swing, damped but for the rolling spring, leaves 1 % of the force, 10 % of the
   stretch. */
TEST(RidingATurntable, IsHeldByForcesThatTurnWithThePlate) {
  Material m;
  m.rollingResistance = 0.3;
  const double g = 9.81, omega = 8, r = 0.03, period = 2 * pi / omega, force = mass() * omega * omega * r;
  const Sphere s{1, R, 1375, {r, 0, R - mass() * g / (4 * kn())}, {0, omega * r, 0}, {0, 0, omega}};
  Liggghts run;
  run.script =
      head(run, {s}, {m}, 0.2) + mesh_wall(run, plate_stl(0.1)) +
      fmt::format("fix gravity all gravity {} vector 0 0 -1\n", g) +
      fmt::format("fix turn all move/mesh mesh plate rotate origin 0 0 0 axis 0 0 1 period {:.17g}\n", period) +
      dump_grains("states", 1000) + fmt::format("run {}\n", std::lround(2 * period / dt));
  run.must();
  const double stretch = force * (1 / (0.5 * kn()) + R * R / (0.5 * kn() * 2 * R * R));
  for (const Table& f : run.dump("states")) {
    const double time = static_cast<double>(f.step) * dt;
    if (time < 0.5 * period) continue;
    const Vec outward(std::cos(omega * time), std::sin(omega * time), 0), along = Vec::UnitZ().cross(outward);
    const Vec x = f.x(0) - r * outward, F = f.f(0);
    const double creep = omega * omega * r * dt / 2 * time;
    EXPECT_NEAR(x.dot(outward), stretch - creep, 0.1 * stretch + 0.01 * creep) << f.step;
    EXPECT_NEAR(x.dot(along), 0, 0.1 * stretch) << f.step;
    EXPECT_NEAR(F.dot(outward), -force, 0.01 * force) << f.step;
    EXPECT_NEAR(F.dot(along), 0, 0.01 * force) << f.step;
    EXPECT_NEAR(f.w(0)[2], omega, 1e-3 * omega) << f.step;
  }
}

/* A level plate turns about its normal under a sphere at rest on the axis. The twisting couple stands at its cap
   T = mu_tw tan(phi') m g L and spins the sphere up at T/I; then it rides and the couple swings about zero. The mesh
   bears -T. */
TEST(PlateUnderASphere, SpinsItUpAtTheCapAndThenCarriesItAlong) {
  const double g = 9.81, omega = 40, T = 0.1 * std::tan(25 * pi / 180) * mass() * g * 4.0 / 3 * R;
  const double until = omega / (T / (0.4 * mass() * R * R));
  const long steps = std::lround(0.5 * until / dt);
  Liggghts run;
  run.script =
      head(run, {{1, R, 1375, {0, 0, R - mass() * g / (4 * kn())}, Vec::Zero(), Vec::Zero()}}, {Material()}, 0.2) +
      mesh_wall(run, plate_stl(0.1)) + thermo_mesh + fmt::format("fix gravity all gravity {} vector 0 0 -1\n", g) +
      fmt::format("fix turn all move/mesh mesh plate rotate origin 0 0 0 axis 0 0 1 period {:.17g}\n", 2 * pi / omega) +
      dump_grains("states", steps) + fmt::format("thermo {0}\nrun {1}\n", steps, 4 * steps);
  run.must();
  const std::vector<Table> frames = run.dump("states");
  const Table thermo = run.thermo();
  // half way: at the cap since the spring filled up, T/(k_tw omega) = a few steps at most
  EXPECT_NEAR(frames[1].w(0)[2], 0.5 * omega, 1e-3 * omega);
  EXPECT_NEAR(frames[1].torque(0)[2] / T, 1, 1e-9);
  EXPECT_NEAR(thermo.at(1, "mz") / -T, 1, 1e-9);
  // carried along: the undamped spring swings by T at most, a speed of T/sqrt(k_tw I)
  const double ktw = 0.5 * 0.5 * kn() * 2 * R * R, swing = T / std::sqrt(ktw * 0.4 * mass() * R * R);
  for (std::size_t k = 3; k <= 4; k++) {
    EXPECT_NEAR(frames[k].w(0)[2], omega, 1.01 * swing);
    EXPECT_NEAR(thermo.at(k, "mz"), -frames[k].torque(0)[2], 1e-12 * T);
  }
  EXPECT_LT(swing, 0.1 * omega);
}

/* Whatever the contact does: force and torque of the mesh against those of the grain. LIGGGHTS puts the force at the
   point of the plane, R - u_n from the centre; the grain's lever is R (radiusLever on) or R - u_n/2 (off). So, about
   the origin,

     T_mesh + x x F + T_grain = -u_n n x F (on), -u_n/2 n x F (off):   at most u_n/R of the moment R F_t

   Both sides are sums of the same products: round-off of the moments. A sphere dropped with slip and spin on a plate
   that turns about a skew axis. */
TEST(MeshTorque, IsOppositeToTheGrainsWithItsCouples) {
  for (const bool shortened : {false, true}) {
    const std::string settings = shortened ? "radiusLever off" : "";
    const Sphere s{1, R, 1375, {0.02, 0.03, R + 1e-6}, {0.5, -0.3, -0.4}, {20, 60, 90}};
    Liggghts run;
    run.script = head(run, {s}, {Material()}, 0.2, settings) + mesh_wall(run, plate_stl(0.1), settings) + thermo_mesh +
                 "fix turn all move/mesh mesh plate rotate origin 0 0 0 axis 1 2 10 period 2\n" +
                 dump_grains("states", 1) + "thermo 1\nrun 60\n";
    run.must();
    const std::vector<Table> frames = run.dump("states");
    const Table thermo = run.thermo();
    ASSERT_EQ(frames.size(), thermo.rows.size());
    int touching = 0;
    for (std::size_t k = 1; k < frames.size(); k++) {
      const Vec F = frames[k].f(0), T = frames[k].torque(0), x = frames[k].x(0);
      if (F.norm() == 0) continue;
      touching++;
      const Vec meshF = thermo.vec(k, "fx", "fy", "fz"), meshT = thermo.vec(k, "mx", "my", "mz");
      EXPECT_LT((meshF + F).norm(), 1e-14 * F.norm());
      // the plate has turned by omega t about the skew axis
      const double angle = 2 * pi / 2 * static_cast<double>(frames[k].step) * dt;
      const Vec n = Eigen::AngleAxisd(angle, Vec(1, 2, 10).normalized()) * Vec::UnitZ();
      const double u = R - x.dot(n);
      const Vec rest = meshT + x.cross(F) + T;
      EXPECT_LT((rest + (shortened ? 0.5 : 1) * u * n.cross(F)).norm(), 1e-12 * (x.norm() + R) * F.norm());
      EXPECT_LE(rest.norm(), u * F.norm());
    }
    EXPECT_GT(touching, 20);
  }
}

/* Spun up by a turning plate and against a resting one the same relative motion gives the same force: a sphere with
   spin -Omega on a plate at rest, and a sphere without spin on a plate that turns with Omega about the axis through its
   centre, parallel to the plate. In the frame of the plate both are one impact, but for inertial forces: m v_n Omega
   t_c and Omega^2, below 2 % here, and the turn of the plate itself, 30 rad/s * 0.4 ms = 1.2 %. */
TEST(TurningPlate, RollsTheSphereAsTheSphereWouldRollOnIt) {
  Material m;
  m.tangentialDamping = 0;
  m.frictionAngle = 1;  // little friction, so that the rolling moment shows
  m.rollingResistance = 2;
  double spin[2];
  for (const bool turning : {false, true}) {
    const double omega = 30;
    const Sphere s{1, R, 1375, {0, 0, R + 1e-6}, {0, 0, -0.4}, {0, turning ? 0 : -omega, 0}};
    Liggghts run;
    run.script = head(run, {s}, {m}, 0.2) + mesh_wall(run, plate_stl(0.03));
    if (turning)
      run.script += fmt::format("fix turn all move/mesh mesh plate rotate origin 0 0 {} axis 0 1 0 period {:.17g}\n", R,
                                2 * pi / omega);
    run.script += dump_grains("states", 60) + "run 60\n";
    run.must();
    spin[turning] = (run.dump("states").back().w(0) - s.w)[1];
  }
  EXPECT_GT(spin[0], 1);
  EXPECT_NEAR(spin[1] / spin[0], 1, 0.05);
}

// A plate that is dragged along but does not turn has no spin: bit for bit the impact of a sphere with the opposite
// velocity.
TEST(MovingPlate, WithoutTurningHasNoSpin) {
  Vec v[2], w[2];
  for (const bool moving : {false, true}) {
    const Sphere s{1, R, 1375, {0, 0, R + 1e-6}, {moving ? 0 : -0.25, 0, -0.5}, {5, 0, 7}};
    Liggghts run;
    run.script = head(run, {s}, {Material()}, 0.2) + mesh_wall(run, plate_stl(0.03));
    if (moving) run.script += "fix pull all move/mesh mesh plate linear 0.25 0 0\n";
    run.script += dump_grains("states", 60) + "run 60\n";
    run.must();
    const Table last = run.dump("states").back();
    v[moving] = last.v(0) - Vec(moving ? 0.25 : 0, 0, 0);
    w[moving] = last.w(0);
  }
  // the same numbers but for the rounding of v - v_wall
  EXPECT_LT((v[0] - v[1]).norm(), 1e-13);
  EXPECT_LT((w[0] - w[1]).norm(), 1e-11);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
/* Drag of the air, through `liggghts`. The reference integrates m dv/dt = m g - (pi/8) C_D rho D^2 v^2 of one sphere
   with C_D(Re) as Schiller and Naumann write it, by Runge's fourth-order rule in steps of a twentieth. */
#include "liggghts_runner.h"

namespace {

using namespace vielto_test;

const double air = 1.2, viscosity = 1.8e-5;  // kg/m3, Pa s

double deceleration(double v, double D, double density) {
  const double Re = air * v * D / viscosity;
  const double drag = Re < 1000 ? 24 / Re * (1 + 0.15 * std::pow(Re, 0.687)) : 0.44;
  const double force = pi / 8 * drag * air * D * D * v * v, mass = density * pi / 6 * D * D * D;
  return v > 0 ? force / mass : 0;
}

double speed_after(double v, double time, double g, double scale, double D, double density, double dt) {
  const auto rate = [&](double at) { return g - scale * deceleration(at, D, density); };
  for (long k = 0; k < std::lround(time / dt); k++) {
    const double a = rate(v), b = rate(v + 0.5 * dt * a), c = rate(v + 0.5 * dt * b), d = rate(v + dt * c);
    v += dt / 6 * (a + 2 * b + 2 * c + d);
  }
  return v;
}

struct Fall {
  double v, g, scale, D, time;
};

class AirDrag : public testing::TestWithParam<Fall> {};

/* A grain of 8 mm stands for one of D: it flies as that one would. LIGGGHTS takes the drag of the half step's velocity:
   its error is of first order, dt times the rate a/v at most over the time, here 100 times that of the reference. */
TEST_P(AirDrag, IsThatOfTheRealGrain) {
  const auto [v, g, scale, D, time] = GetParam();
  const double dt = 1e-5, density = 1375;
  const Sphere grain{1, 0.004, density, {0.001, 0.002, 0.05}, {0.6 * v, 0, -0.8 * v}, {3, 0, 0}};
  Liggghts run;
  const long steps = std::lround(time / dt);
  run.script =
      head(run, {grain}, {Material()}, 1.0) +
      fmt::format("timestep {}\nfix move all nve/sphere\nfix gravity all gravity {} vector 0.6 0 -0.8\n", dt, g) +
      fmt::format("fix drag all vielto/drag scale {} diameter {} density {}\n", scale, D, density) +
      dump_grains("states", steps) + fmt::format("run {}\n", steps);
  run.must();
  const Table last = run.dump("states").back();
  const double expected = speed_after(v, time, g, scale, D, density, dt / 20), speed = last.v(0).norm();
  const double rate = scale * deceleration(std::max(v, expected), D, density) / std::max(v, expected);
  EXPECT_NEAR(speed, expected, 2 * dt * rate * std::max(v, expected));
  EXPECT_NEAR(last.v(0)[0] / speed, 0.6, 1e-12);
  EXPECT_EQ(last.w(0)[0], 3);
  EXPECT_GT(std::fabs(speed - v - g * time), 20 * dt * rate * v) << "the drag was seen";
}

// Millet falling to its terminal velocity; thrown fast, Re over 1000; a dust grain in Stokes' range; four times the
// drag.
INSTANTIATE_TEST_SUITE_P(Flights, AirDrag,
                         testing::Values(Fall{0.01, 9.81, 1, 0.0018, 0.05}, Fall{12, 0, 1, 0.0018, 0.02},
                                         Fall{0.02, 0, 1, 1e-4, 0.02}, Fall{2, 0, 4, 0.0018, 0.03}));

TEST(AirDragInput, IsChecked) {
  for (const char* words : {"scale 0 diameter 0.0018 density 1375", "scale 1 diameter -1 density 1375",
                            "scale 1 diameter 0.0018", "scale 1 size 0.0018 density 1375"}) {
    Liggghts run;
    run.script = head(run, {Sphere()}, {Material()}, 0.05) + "fix drag all vielto/drag " + words + "\n";
    const Outcome outcome = run.start();
    EXPECT_NE(outcome.status, 0) << outcome.text;
    EXPECT_NE(outcome.text.find("scale"), std::string::npos) << outcome.text;
  }
}

}  // namespace

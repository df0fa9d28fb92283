// SPDX-License-Identifier: GPL-2.0-or-later
// `fix vielto/record` through `liggghts`: rows are means, signs, parts, energy accounts against closed forms, and the
// stops that keep a false number from becoming a result.
#include "contact_reference.h"

namespace {

using namespace vielto_test;

const double R = 0.005, g = 9.81, dt = 1e-5;
const double half_of_last_digit = 5e-9;  // relative, of rows with 9 digits

double mass() { return Sphere{1, R}.mass(); }
double kn() { return 4 * Material().youngsModulus * R * 2 / 3; }  // on a wall, R_2 = 2 R_1
double resting_height() { return R - mass() * g / (4 * kn()); }

// Meshes a and b: level plates side by side, b from x = 0.05 on; gravity down.
std::string plates(const Liggghts& run, const std::string& settings = "") {
  run.write("a.stl", plate_stl(0.05));
  run.write("b.stl", plate_stl(0.05, {0.1, 0, 0}));
  return "fix a all mesh/surface/stress file a.stl type 1 reference_point 0 0 0\n"
         "fix b all mesh/surface/stress file b.stl type 1 reference_point 0.1 0 0\n" +
         fmt::format("fix wall all wall/gran {} mesh n_meshes 2 meshes a b {}\n", vielto_models, settings) +
         fmt::format("timestep {}\nfix move all nve/sphere\nfix gravity all gravity {} vector 0 0 -1\n", dt, g);
}

Sphere resting(double x, double y) { return {1, R, 1375, {x, y, resting_height()}, Vec::Zero(), Vec::Zero()}; }

void expect_relative(double value, double expected, double relative = half_of_last_digit) {
  EXPECT_NEAR(value, expected, relative * std::fabs(expected));
}

// Grains at rest on two plates: torque about the axis is y m g for the part that carries them; the weight is in the
// forces. Gravity's own moment is the opposite. Tolerance: the last digit of the file.
TEST(RecordRows, RestingGrainsLoadTheirPartByWeightTimesLever) {
  Liggghts run;
  run.script = head(run, {resting(0.01, 0.03), resting(-0.02, 0.01), resting(0.11, -0.02)}, {Material()}, 0.3) +
               plates(run) +
               "fix record all vielto/record every 50 file torque.csv speed 2 axis 1 0 0 origin 0 0.005 0 part tray a "
               "part drum b "
               "header material millet header note two words speed 2\nrun 200\n";
  run.must();
  const Table t = run.csv("torque.csv");
  ASSERT_EQ(t.rows.size(), 4u);
  const double W = mass() * g;
  for (std::size_t k = 0; k < 4; k++) {
    const double step = 50.0 * static_cast<double>(k + 1);
    EXPECT_EQ(t.at(k, "step"), step);
    expect_relative(t.at(k, "time_s"), step * dt);
    expect_relative(t.at(k, "turn"), 2 * step * dt);
    EXPECT_EQ(t.at(k, "idle_Nm"), 0);
    expect_relative(t.at(k, "tray_Nm"), W * (0.025 + 0.005));
    expect_relative(t.at(k, "drum_Nm"), W * -0.025);
    expect_relative(t.at(k, "gravity_Nm"), -W * (0.025 + 0.005 - 0.025));
    expect_relative(t.at(k, "tray_Fz_N"), 2 * W);
    expect_relative(t.at(k, "drum_Fz_N"), W);
    EXPECT_NEAR(t.at(k, "tray_Fx_N"), 0, 1e-15);
    EXPECT_EQ(t.at(k, "contacts"), 3);
    EXPECT_EQ(t.at(k, "grains"), 3);
    expect_relative(t.at(k, "overlap_mean"), W / (4 * kn()) / (2 * R), 1e-8);
    expect_relative(t.at(k, "overlap_max"), W / (4 * kn()) / (2 * R), 1e-8);
    EXPECT_NEAR(t.at(k, "kinetic_J"), 0, 1e-25);
  }
  const std::string text = run.read("torque.csv");
  for (const char* line :
       {"# material=millet\n", "# note=two words\n", "# speed=2\n", "# dt=1e-05\n", "# interval_steps=50\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

// The stock program knows the fix once a ViElTo pair_style has been given, and writes the same file.
TEST(RecordRows, OfTheStockProgramWithTheLibraryPreloadedAreTheSame) {
  std::string text[2];
  for (const Program program : {Program::ours, Program::stock}) {
    Liggghts run;
    const Sphere thrown{1, R, 1375, {0, 0.02, R + 1e-6}, {0.3, 0.1, -0.2}, {20, 70, 100}};
    run.script = head(run, {thrown}, {Material()}, 0.3) + plates(run) +
                 "fix record all vielto/record every 20 file torque.csv speed 1 part tray a part drum b\nrun 100\n";
    run.must(1, program);
    text[program == Program::stock] = run.read("torque.csv");
  }
  EXPECT_EQ(text[0], text[1]);
  EXPECT_GT(text[0].size(), 500u);
}

// A row is the mean over its steps, neither a sample nor shifted: against the mean of what the mesh shows at every
// single step, for a grain that bounces, slips and spins. `each` adds one column a mesh; the vector of the fix holds
// the last row.
TEST(RecordRows, AreMeansOverTheStepsOfTheirInterval) {
  Liggghts run;
  const Sphere thrown{1, R, 1375, {0.045, 0.02, R + 1e-6}, {0.3, 0.1, -0.2}, {20, 70, 100}};
  run.script = head(run, {thrown, resting(0.1, 0.03)}, {Material()}, 0.3) + plates(run) +
               "fix turn all move/mesh mesh b rotate origin 0.1 0 0 axis 0 0 1 period 1\n"
               "fix record all vielto/record every 40 file torque.csv speed 1 axis 0 0 1 origin 0.1 0 0 part paddles a "
               "b each paddles\n"
               "variable ma equal -f_a[6]+0.1*f_a[2]\nvariable mb equal -f_b[6]\nvariable fa equal -f_a[3]\nvariable "
               "fb equal -f_b[3]\n"
               "variable last equal f_record[2]\nvariable turn equal f_record[1]\n"
               "thermo_style custom step v_ma v_mb v_fa v_fb v_last v_turn\nthermo_modify format float %.17g\nthermo "
               "1\nrun 400\n";
  run.must();
  const Table rows = run.csv("torque.csv"), steps = run.thermo();
  ASSERT_EQ(rows.rows.size(), 10u);
  ASSERT_EQ(steps.rows.size(), 401u);
  double greatest = 0;
  for (std::size_t k = 0; k < 10; k++) {
    double ma = 0, mb = 0, force = 0;
    for (std::size_t i = 40 * k + 1; i <= 40 * (k + 1); i++) {
      ma += steps.at(i, "ma") / 40, mb += steps.at(i, "mb") / 40;
      force += (steps.at(i, "fa") + steps.at(i, "fb")) / 40;
    }
    const double tolerance = half_of_last_digit * (std::fabs(ma) + std::fabs(mb)) + 1e-16;
    EXPECT_NEAR(rows.at(k, "paddles_Nm"), ma + mb, tolerance);
    EXPECT_NEAR(rows.at(k, "paddle1_Nm"), ma, tolerance);
    EXPECT_NEAR(rows.at(k, "paddle2_Nm"), mb, tolerance);
    expect_relative(rows.at(k, "paddles_Fz_N"), force);
    EXPECT_NEAR(steps.at(40 * (k + 1), "last"), ma + mb, 1e-12 * greatest + 1e-15);
    expect_relative(steps.at(40 * (k + 1), "turn"), rows.at(k, "turn"));
    greatest = std::max(greatest, std::fabs(ma + mb));
  }
  EXPECT_GT(greatest, 1e-5);
}

// A plate turns under a sphere at rest: the drive supplies the twisting couple T = mu_tw tan(phi') m g L, positive,
// whichever way the plate turns, and half of its work heats the contact (the other half is the sphere's spin).
// T/k_tw/omega, the filling of the spring, is 0.1 % of the spin-up.
TEST(RecordSign, TorqueIsPositiveWhereTheDriveSupplies) {
  const double omega = 40, T = 0.1 * std::tan(25 * pi / 180) * mass() * g * 4.0 / 3 * R, I = 0.4 * mass() * R * R;
  const long steps = std::lround(0.5 * omega * I / T / dt / 100) * 100;  // half way to the plate's speed
  for (const int direction : {1, -1}) {
    Liggghts run;
    run.script = head(run, {resting(0, 0)}, {Material()}, 0.3) + plates(run) +
                 fmt::format("fix turn all move/mesh mesh a rotate origin 0 0 0 axis 0 0 {} period {:.17g}\n",
                             direction, 2 * pi / omega) +
                 fmt::format(
                     "fix record all vielto/record every {0} file torque.csv speed {1:.17g} axis 0 0 {2} part plate a "
                     "energy on\n"
                     "run {0}\n",
                     steps, omega / (2 * pi), direction);
    run.must();
    const Table t = run.csv("torque.csv");
    const double time = static_cast<double>(steps) * dt, spin = T / I * time;
    expect_relative(t.at(0, "plate_Nm"), T, 1e-3);
    expect_relative(t.at(0, "work_J"), T * omega * time, 1e-3);
    expect_relative(t.at(0, "kinetic_J"), 0.5 * I * spin * spin, 3e-3);
    expect_relative(t.at(0, "diss_twisting_J"), T * omega * time - 0.5 * I * spin * spin, 3e-3);
    EXPECT_NEAR(t.at(0, "diss_sliding_J"), 0, 1e-12);
  }
}

/* Energy lost to each mechanism in cases with a closed form. Normal dashpot: 1/2 m v^2 (1 - e^2) with e of the impact.
   Sliding: a sphere thrown without spin that ends rolling has lost 1/7 m v^2. Rolling: braked from v by dv at the
   capped moment, 7/10 m (v^2 - v'^2). */
TEST(RecordEnergy, DissipationByMechanismMeetsTheClosedForms) {
  {
    Material m;
    m.normalDamping = 0.6;  // zeta = 0.3 with c_n = 4
    Liggghts run;
    const double v = 0.2, e = std::exp(-pi * 0.3 / std::sqrt(1 - 0.09)), x = std::sqrt(4 * kn() / mass()) * 1e-6;
    run.script = head(run, {{1, R, 1375, {0, 0, R + 2.5e-6 * v}, {0, 0, -v}, Vec::Zero()}}, {m}, 0.3) + plates(run) +
                 "unfix gravity\ntimestep 1e-6\n"
                 "fix record all vielto/record every 500 file torque.csv speed 0 part plate a energy on\nrun 500\n";
    run.must();
    const Table t = run.csv("torque.csv");
    const double lost = 0.5 * mass() * v * v * (1 - e * e);
    // first order in x: the dashpot acts from the first step on and half a step late (see the head-on impacts)
    expect_relative(t.at(0, "diss_normal_J"), lost, 3 * 0.3 * x);
    EXPECT_NEAR(t.at(0, "elastic_J"), 0, 1e-20);
    /* Against the kinetic energy that went, the account is right to second order: what is left of taking the force at
       the end of the step is pi/2 zeta x^2/(1 - e^2) of it, and the spring at the first and last step, of which only a
       part lies in the contact, is unknown by up to 1/4 x^2 of the kinetic energy each. */
    const double kinetic = 0.5 * mass() * v * v, taken = kinetic - t.at(0, "kinetic_J");
    const double second = x * x * (0.25 * (1 + e * e) + 0.5 * pi * 0.3) / (1 - e * e);
    EXPECT_NEAR(t.at(0, "diss_normal_J") / taken, 1, second);
    EXPECT_LT(second, 0.5 * 0.3 * x);  // a first order would be seen
  }
  {
    Material m;
    m.rollingStiffnessFactor = 0;
    m.tangentialDamping = 0;
    Liggghts run;
    const double v = 0.5, mu = std::tan(25 * pi / 180);
    Sphere thrown = resting(-0.04, 0);
    thrown.v[0] = v;
    run.script = head(run, {thrown}, {m}, 0.3) + plates(run) +
                 "fix record all vielto/record every 4000 file torque.csv speed 0 part plate a energy on\nrun 4000\n";
    run.must();
    const Table t = run.csv("torque.csv");
    // less what the slip spring keeps ringing with: its cap m g mu, (m g mu)^2/(2 k_s)
    const double ringing = std::pow(mass() * g * mu, 2) / (kn());
    EXPECT_NEAR(t.at(0, "diss_sliding_J"), mass() * v * v / 7, ringing);
    EXPECT_LT(ringing, 1e-3 * mass() * v * v / 7);
  }
  {
    Material m;
    Liggghts run;
    const double v = 0.3, a = 5.0 / 7 * 0.1 * g * 4.0 / 3, time = 0.1, after = v - a * time;
    Sphere rolling = resting(-0.04, 0);
    rolling.v[0] = v, rolling.w[1] = v / R;
    run.script = head(run, {rolling}, {m}, 0.3) + plates(run) +
                 "fix record all vielto/record every 10000 file torque.csv speed 0 part plate a energy on\nrun 10000\n";
    run.must();
    const Table t = run.csv("torque.csv");
    // the rolling spring fills up first and keeps its energy: T^2/(2 k_r), of 1e-4 of the whole
    expect_relative(t.at(0, "diss_rolling_J"), 0.7 * mass() * (v * v - after * after), 1e-3);
  }
}

/* A shaken crowd on a turning plate: shaft work plus the start's energy is kinetic, elastic and potential energy plus
   all dissipation. The accounts take the leapfrog's velocities in the middle of a step against forces at its end, first
   order in x = omega dt = 0.03 where dashpots act: 1 % of what is dissipated, as asked of every reported power. */
TEST(RecordEnergy, ShaftWorkIsDissipationPlusChangeOfEnergy) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 40; i++)
    spheres.push_back({1,
                       0.004,
                       1375,
                       {0.009 * (i % 4) - 0.013, 0.009 * (i / 4 % 4) - 0.013, 0.0045 + 0.009 * (i / 16)},
                       {0.1 * std::sin(i), 0.1 * std::cos(2 * i), 0},
                       {5, 0, 10.0 * std::sin(3 * i)}});
  Liggghts run;
  run.write("tray.stl", tray_stl(0.02));
  run.script = head(run, spheres, {Material()}, 0.3) +
               "fix tray all mesh/surface/stress file tray.stl type 1 reference_point 0 0 0\n" +
               fmt::format("fix wall all wall/gran {} mesh n_meshes 1 meshes tray\n", vielto_models) +
               fmt::format("timestep 3e-6\nfix move all nve/sphere\nfix gravity all gravity {} vector 0 0 -1\n", g) +
               "fix turn all move/mesh mesh tray rotate origin 0 0 0 axis 0 0 1 period 0.25\n"
               "fix record all vielto/record every 1000 file torque.csv speed 4 axis 0 0 1 part tray tray energy "
               "on\nrun 40000\n";
  run.must();
  const Table t = run.csv("torque.csv");
  double kinetic = 0, potential = 0;
  for (const Sphere& s : spheres) {
    kinetic += 0.5 * s.mass() * s.v.squaredNorm() + 0.5 * s.inertia() * s.w.squaredNorm();
    potential += s.mass() * g * s.x[2];
  }
  double dissipated = 0;
  for (std::size_t k = 0; k < t.rows.size(); k++) {
    dissipated = 0;
    for (const char* way :
         {"diss_normal_J", "diss_tangential_J", "diss_sliding_J", "diss_rolling_J", "diss_twisting_J"}) {
      EXPECT_GE(t.at(k, way), 0) << way;
      dissipated += t.at(k, way);
    }
    const double now = t.at(k, "kinetic_J") + t.at(k, "elastic_J") + t.at(k, "potential_J");
    EXPECT_NEAR(now + dissipated, kinetic + potential + t.at(k, "work_J"), 0.01 * dissipated + 1e-7) << "row " << k;
  }
  EXPECT_GT(dissipated, 1e-4);
  EXPECT_GT(t.at(39, "work_J"), 1e-4);
}

// The idling model's noise is one normal number a row: mean and spread of 400 rows within four standard errors.
TEST(RecordIdling, HasItsMeanAndItsNoise) {
  Liggghts run;
  run.script = head(run, {resting(0, 0)}, {Material()}, 0.3) + plates(run) +
               "fix record all vielto/record every 1 file torque.csv speed 1 part tray a idle 3 0.05 7\nrun 400\n";
  run.must();
  const Table t = run.csv("torque.csv");
  double mean = 0, spread = 0;
  for (std::size_t k = 0; k < 400; k++) mean += t.at(k, "idle_Nm") / 400;
  for (std::size_t k = 0; k < 400; k++) spread += std::pow(t.at(k, "idle_Nm") - mean, 2) / 399;
  EXPECT_NEAR(mean, 3, 4 * 0.15 / 20);
  EXPECT_NEAR(std::sqrt(spread), 0.15, 4 * 0.15 / std::sqrt(800.0));
}

// ---- stops ----

struct Stop {
  const char* name;
  std::vector<Sphere> spheres;
  std::string settings, more, words;  // words: what the one line must say
};

void PrintTo(const Stop& s, std::ostream* out) { *out << s.name; }

std::string stop_name(const testing::TestParamInfo<Stop>& tested) { return tested.param.name; }

class RecordStops : public testing::TestWithParam<Stop> {};

TEST_P(RecordStops, WithOneLineThatNamesGrainAndStep) {
  const Stop& s = GetParam();
  Liggghts run;
  run.script = head(run, s.spheres, {Material()}, 0.2, s.settings) + plates(run, s.settings) + s.more + "run 2000\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 1);
  std::istringstream in(outcome.text);
  std::vector<std::string> errors;
  for (std::string line; std::getline(in, line);)
    if (line.find("ERROR") != std::string::npos) errors.push_back(line);
  ASSERT_EQ(errors.size(), 1u) << outcome.text;
  std::istringstream wanted(s.words);
  for (std::string word; std::getline(wanted, word, '|');)
    EXPECT_NE(errors[0].find(word), std::string::npos) << word << " in: " << errors[0];
}

const char* const record = "fix record all vielto/record every 100 file torque.csv speed 1 part tray a ";

INSTANTIATE_TEST_SUITE_P(
    Reasons, RecordStops,
    testing::Values(
        // grain 2 flies out of the box at x = 0.2 after 0.02 m at 1.9 m/s, in step 1053; the last row is that of step
        // 1000
        Stop{"lost_grain",
             {resting(0, 0), {1, R, 1375, {0.18, 0.02, 0.1}, {1.9, 0, 0}, Vec::Zero()}},
             "",
             std::string("thermo_modify lost ignore norm no\n") + record + "\n",
             "step 1100|1 of 2 grains|grain 2 was lost|(0.199 0.02"},
        // 0.03 m times the weight of 7.063e-3 N
        Stop{"torque_over_its_limit",
             {resting(0, 0), resting(0, 0.03)},
             "",
             std::string(record) + "maxTorque 1e-4\n",
             "step 1 |torque of tray|0.0002119 N m|limit of 0.0001 N m (maxTorque)|acts on grain"},
        // half period sqrt-wise 3.6e-4 s of the wall: 1e-5 s is 0.03 of it
        Stop{"time_step_over_its_limit",
             {resting(0, 0)},
             "",
             std::string(record) + "dtLimit 0.01\n",
             "time step 1e-05 s|over the limit 0.01|take at most"},
        // thrown down at 1 m/s: overlap v/omega_0 = 1.2e-4 m
        Stop{"overlap_over_its_limit",
             {resting(0.03, 0), {1, R, 1375, {0, 0, R + 1e-6}, {0, 0, -1}, Vec::Zero()}},
             "maxOverlap 0.005",
             "",
             "overlap of grain 2|of mesh a|limit of 0.5 % (maxOverlap)"},
        Stop{"overlap_of_a_pair",
             {{1, R, 1375, {0, 0, 0.04}, Vec::Zero(), Vec::Zero()},
              {1, R, 1375, {0, 0, 0.051}, {0, 0, -2}, Vec::Zero()}},
             "maxOverlap 0.005",
             "",
             "overlap of grain |grain 1|grain 2|maxOverlap"},
        Stop{"mesh_in_two_parts",
             {resting(0, 0)},
             "",
             std::string(record) + "part shaft b a\n",
             "mesh a stands in part tray and again in part shaft|name it once"},
        Stop{"mesh_twice_in_a_part",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 file t.csv speed 1 part tray a a\n",
             "mesh a stands in part tray and again in part tray"},
        Stop{
            "part_given_twice", {resting(0, 0)}, "", std::string(record) + "part tray b\n", "part tray is given twice"},
        Stop{"part_named_as_a_column",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 file t.csv speed 1 part idle a\n",
             "part idle has the name of a column"},
        Stop{"part_with_a_comma",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 file t.csv speed 1 part a,b a\n",
             "part a,b|without commas"},
        Stop{"half_a_step",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 7.5 file t.csv speed 1 part tray a\n",
             "Expected integer parameter"},
        Stop{"speed_in_rad_per_s",
             {resting(0, 0)},
             "",
             "fix turn all move/mesh mesh a rotate origin 0 0 0 axis 0 0 1 period 0.5\n"
             "fix record all vielto/record every 10 file t.csv speed 12.566 axis 0 0 1 part tray a\n",
             "mesh a of part tray does not turn as fix record says|speed 12.566 1/s|not rad/s"},
        Stop{"axis_other_than_the_motion",
             {resting(0, 0)},
             "",
             "fix turn all move/mesh mesh a rotate origin 0 0 0 axis 0 0 1 period 0.5\n"
             "fix record all vielto/record every 10 file t.csv speed 2 axis 0 0 -1 part tray a\n",
             "mesh a of part tray does not turn|axis 0 0 -1"},
        Stop{"origin_other_than_the_motion",
             {resting(0, 0)},
             "",
             "fix turn all move/mesh mesh a rotate origin 0 0.001 0 axis 0 0 1 period 0.5\n"
             "fix record all vielto/record every 10 file t.csv speed 2 axis 0 0 1 part tray a\n",
             "mesh a of part tray does not turn|through origin 0 0 0"},
        Stop{"drum_that_moves",
             {resting(0, 0)},
             "",
             "fix turn all move/mesh mesh a linear 0 0 0.01\n"
             "fix record all vielto/record every 10 file t.csv speed 2 axis 0 0 1 part tray b part drum a\n",
             "mesh a of part drum moves|0.01 m/s"},
        Stop{"no_such_mesh",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 file t.csv speed 1 part tray c\n",
             "part tray"},
        Stop{"mesh_that_records_no_torque",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 file t.csv speed 1 part tray gravity\n",
             "fix gravity is no mesh/surface/stress"},
        Stop{"no_file",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 speed 1 part tray a\n",
             "file F is required"},
        Stop{"folder_that_is_not_there",
             {resting(0, 0)},
             "",
             "fix record all vielto/record every 10 file no/where.csv speed 1 part tray a\n",
             "cannot write no/where.csv"},
        Stop{"unknown_keyword", {resting(0, 0)}, "", std::string(record) + "interval 3\n", "unknown keyword interval"},
        Stop{"keyword_without_value",
             {resting(0, 0)},
             "",
             std::string(record) + "maxTorque\n",
             "keyword maxTorque lacks a value"}),
    stop_name);

// A rotor that nothing turns is told of at a speed, whether it never had a motion or has one of zero; a standing part
// is not.
TEST(RecordMotion, WarnsOfARotorThatStandsStill) {
  const std::string words = "Warning: mesh a of part tray stands still";
  const auto text = [](const std::string& motion, const std::string& parts) {
    Liggghts run;
    run.script = head(run, {resting(0, 0)}, {Material()}, 0.2) + plates(run) + motion +
                 "fix record all vielto/record every 10 file t.csv axis 0 0 1 " + parts + "\nrun 10\n";
    const Outcome outcome = run.start();
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return outcome.text;
  };
  EXPECT_NE(text("", "speed 2 part tray a").find(words), std::string::npos);
  EXPECT_NE(text("fix turn all move/mesh mesh a linear 0 0 0\n", "speed 2 part tray a").find(words), std::string::npos);
  EXPECT_EQ(text("", "speed 2 standing tray a").find(words), std::string::npos);
  EXPECT_EQ(text("", "speed 0 part tray a").find(words), std::string::npos);
  // 48 1/min, given as such
  EXPECT_NE(text("", "speed 48 standing tray a").find("Warning: speed is 48 1/s; is that 1/min?"), std::string::npos);
  EXPECT_EQ(text("", "speed 9 standing tray a").find("1/min"), std::string::npos);
}

// On two ranks a stop that only one of them sees ends both, with its line.
TEST(RecordStopsOnTwoRanks, OverlapOverItsLimitEndsBoth) {
  Liggghts run;
  run.script = head(run, {resting(0.03, 0), {1, R, 1375, {0, 0, R + 1e-6}, {0, 0, -1}, Vec::Zero()}}, {Material()}, 0.2,
                    "maxOverlap 0.005") +
               plates(run, "maxOverlap 0.005") + "run 2000\n";
  const Outcome outcome = run.start(2);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.text.find("overlap of grain 2"), std::string::npos) << outcome.text;
}

}  // namespace

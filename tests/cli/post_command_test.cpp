// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto post` through its command line, on synthetic records with a known answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/observation_table.h"
#include "tests/cli/command_test.h"
#include "tests/rigs/synthetic_record.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vielto_test::content;
const double kPi = std::acos(-1.0);

class PostCommand : public vielto_test::CommandTest {
 protected:
  void SetUp() override {
    // Without noise every answer is exact.
    quiet_.noise = 0;
    quiet_.idle_noise = 0;
    idle_ = quiet_;
    idle_.fill = 0;
  }

  int post(const std::string& arguments) { return vielto("post " + arguments); }
  json power(const std::string& run = "run") { return json::parse(content(folder_ / run / "post" / "power.json")); }
  void expect_refusal(const std::string& arguments, const std::string& start) {
    EXPECT_EQ(post(arguments), 2) << arguments;
    EXPECT_EQ(err_.rfind("vielto: " + start, 0), 0u) << "expected: " << start << "\ngot: " << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
    EXPECT_EQ(out_, "");
  }

  SyntheticRecord quiet_, idle_;
};

/* A start-up of half a turn, then 2.25 turns of a rotor that repeats in quarters: eleven quarters of which two hold the
   start-up, over a fifth of the torque. Its curves are those of whole turns, whichever quarter they begin with. */
TEST_F(PostCommand, ARecordInPartsOfATurnNeedNotEndWithATurn) {
  SyntheticRecord parts = quiet_;
  parts.turn_parts = 4;
  parts.turns = 2.75;
  parts.noise = 0.002;
  parts.start_up = 0.3;
  parts.start_up_turns = 0.1;
  parts.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  const json p = power();
  EXPECT_EQ(p["turns_total"], 2.75);
  EXPECT_EQ(double(p["turn_first"]) + double(p["turns_averaged"]), 2.75);
  EXPECT_GE(double(p["turn_first"]), 0.5);
  EXPECT_LE(double(p["turn_first"]), 0.75);
  EXPECT_NEAR(p["torque_Nm"], 4.125, 4 * double(p["torque_u_Nm"]) + 0.3 * std::exp(-5.0) * 22 / 4);
  const double half = kPi / 72;
  EXPECT_NEAR(p["torque_ripple"], 0.02 * std::sin(half) / half / 4.125, 3 * double(p["torque_ripple_u"]));
  EXPECT_NE(out_.find("of 2.75 averaged"), std::string::npos) << out_;
  // without the key, three whole turns are needed and two are there
  parts.turn_parts = 1;
  parts.write(folder_ / "run");
  expect_refusal("run", "run/torque.csv: has 2 whole turns");
}

TEST_F(PostCommand, PartsThatPhasesReachOverAreRefused) {
  quiet_.turn_parts = 5;
  quiet_.write(folder_ / "run");
  expect_refusal("run", "run/torque.csv, line ");
  EXPECT_NE(err_.find("turn_parts"), std::string::npos) << err_;
  EXPECT_NE(err_.find("divisor of 72"), std::string::npos) << err_;
}

// Slice: 4 * 0.15 + 0.1 + 0.05 = 0.75 N m; whole shaft times 22/4: 4.125 N m. Records are printed with nine digits.
TEST_F(PostCommand, PowerAndNumbersOfASteadyRecord) {
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  const json p = power();
  const double watt = 2 * kPi * 1.21 * 4.125;
  EXPECT_NEAR(p["torque_Nm"], 4.125, 1e-7);
  EXPECT_NEAR(p["power_W"], watt, 1e-6);
  EXPECT_NEAR(p["parts"]["paddles"]["torque_Nm"], 3.3, 1e-7);
  EXPECT_NEAR(p["parts"]["stems"]["torque_Nm"], 0.55, 1e-7);
  EXPECT_NEAR(p["parts"]["shaft"]["torque_Nm"], 0.275, 1e-7);
  EXPECT_NEAR(p["parts"]["drum"]["torque_Nm"], -0.4 * 4.125, 1e-7);
  // N_P = P / (0.114^5 1.21^3 825), N_C = 0.114^2 1.21^2 825/6175, both by hand.
  EXPECT_NEAR(double(p["N_P"]) / (watt / (1.92541458e-5 * 1.771561 * 825)), 1, 1e-7);
  EXPECT_NEAR(p["N_C"], 0.012996 * 1.4641 * 825 / 6175, 1e-9);
  EXPECT_NEAR(double(p["N_PC"]) / (double(p["N_P"]) * double(p["N_C"])), 1, 1e-12);
  EXPECT_NEAR(p["Fr_M"], 0.114 * 1.4641 / 9.81, 1e-12);
  EXPECT_NEAR(p["thesis_power_W"], 36.77, 0.007);  // the published table
  EXPECT_NEAR(p["relative_gap"], watt / double(p["thesis_power_W"]) - 1, 1e-7);
  EXPECT_EQ(p["turns_total"], 10);
  EXPECT_EQ(p["turns_averaged"], 10);
  EXPECT_EQ(p["turn_first"], 0);
  EXPECT_EQ(p["stationary"], true);
  EXPECT_EQ(p["provisional"], true);
  EXPECT_EQ(p["scale_uncertainty"], 0.05);
  EXPECT_TRUE(p["power_loaded_W"].is_null());
  EXPECT_TRUE(p["power_idle_W"].is_null());
  EXPECT_TRUE(p["quality"]["ok"]);
  EXPECT_EQ(p["quality"]["lost_grains"], 0);
  // One paddle swings by 0.02 N m, 22 of them 90 degrees apart by sqrt(2) of it, with a standard deviation of 1 of it;
  // a phase of 5 degrees averages a cosine down by sin(2.5 deg)/2.5 deg.
  const double half = kPi / 72;
  EXPECT_NEAR(p["torque_ripple"], 0.02 * std::sin(half) / half / 4.125, 1e-8);
  EXPECT_EQ(err_, "");
}

TEST_F(PostCommand, IdlingIsSubtractedByTheMeasurementChainOnly) {
  idle_.idle = 0.5;
  quiet_.write(folder_ / "run");
  idle_.write(folder_ / "idle");
  ASSERT_EQ(post("run --idle idle"), 0) << err_;
  const json p = power();
  const double omega = 2 * kPi * 1.21;
  // The idling torque is the whole machine's: 0.6 N m loaded, not times 22/4.
  EXPECT_NEAR(p["power_loaded_W"], omega * (4.125 + 0.6), 1e-6);
  EXPECT_NEAR(p["power_idle_W"], omega * 0.5, 1e-6);
  EXPECT_NEAR(p["power_W"], omega * 4.125, 1e-6);
  const auto rows = vielto::read_observations((folder_ / "run/post/observations.csv").string());
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].observable, "power_loaded");
  EXPECT_NEAR(rows[0].value, omega * 4.725, 1e-6);
  EXPECT_EQ(rows[1].observable, "power_idle");
  EXPECT_EQ(rows[2].observable, "torque_ripple");
}

TEST_F(PostCommand, ObservationRowsCarryTheConditions) {
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run/torque.csv --test M7 --role check --moisture 0.089 --wall steel"), 0) << err_;
  const auto rows = vielto::read_observations((folder_ / "run/post/observations.csv").string());
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[2].observable, "paddle_share_carried");
  EXPECT_EQ(rows[3].observable, "paddle_share_entering");
  EXPECT_EQ(rows[4].observable, "paddle_share_leaving");
  EXPECT_EQ(rows[0].test, "M7");
  EXPECT_EQ(rows[0].role, vielto::Role::check);
  EXPECT_EQ(rows[0].apparatus, "mixer");
  EXPECT_EQ(rows[0].observable, "power");
  EXPECT_EQ(rows[0].unit, "W");
  EXPECT_EQ(rows[0].speed, 1.21);
  EXPECT_EQ(rows[0].fill, 0.15);
  EXPECT_EQ(rows[0].moisture, 0.089);
  EXPECT_FALSE(rows[0].tilt);
  EXPECT_EQ(rows[0].wall, "steel");
  EXPECT_EQ(rows[0].material, "hulled_millet");
  ASSERT_EQ(post("run"), 0);
  EXPECT_EQ(vielto::read_observations((folder_ / "run/post/observations.csv").string())[0].test, "n1.21-l0.15");
}

TEST_F(PostCommand, PhaseCurvesArePerPart) {
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  std::istringstream in(content(folder_ / "run/post/phase.csv"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "phase_deg,paddle_Nm,paddles_Nm,stems_Nm,shaft_Nm,rotor_Nm,rotor_u_Nm,drum_Nm");
  for (int i = 0; i < 72; ++i) {
    ASSERT_TRUE(std::getline(in, line));
    double phase = 0, paddle = 0, paddles = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &phase, &paddle, &paddles), 3);
    EXPECT_EQ(phase, 5 * i + 2.5);
    EXPECT_NEAR(paddle, 0.15 + 0.02 * mean_cosine(i / 72.0, (i + 1) / 72.0, 0), 1e-7);
    EXPECT_NEAR(paddles, 22 * 0.15 + 0.02 * std::sqrt(2.0) * mean_cosine(i / 72.0, (i + 1) / 72.0, kPi / 4), 1e-7);
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST_F(PostCommand, WholeDrumNeedsNoPaddleColumns) {
  quiet_.slice = 0;
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  EXPECT_NEAR(power()["torque_Nm"], 22 * 0.15 + 0.15, 1e-7);
}

// The start-up (e-folding 0.3 turns, ten times the spread of a turn) is left out: only its first turn matters, 0.97 of
// it.
TEST_F(PostCommand, StartUpIsLeftOutAtWholeTurns) {
  quiet_.noise = 0.02;
  quiet_.rho = 0.5;
  quiet_.start_up = 1;
  quiet_.start_up_turns = 0.2;
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  const json p = power();
  EXPECT_GE(p["turn_first"], 1);
  EXPECT_EQ(int(p["turn_first"]) + int(p["turns_averaged"]), 10);
  EXPECT_NEAR(p["torque_Nm"], 4.125, 4 * double(p["torque_u_Nm"]) + 5.5 * std::exp(-5.0) / 5 / 9);
}

// Whole pipeline, start-up included: the 95 % interval holds the true torque. Steady or refused, nothing is picked by
// hand. 200 records of 12 turns, rho 0.95 a row (tau 39 rows, 22 effective samples). Tolerance: three binomial standard
// deviations (6 %), and 3 % for what is chosen from the data (which turns to keep).
TEST_F(PostCommand, IntervalCoversTheTrueTorqueOfRecordsWithAStartUp) {
  SyntheticRecord synthetic;
  synthetic.turns = 12;
  synthetic.noise = 0.15;
  synthetic.rho = 0.95;
  synthetic.start_up = 1;
  synthetic.start_up_turns = 0.3;
  int accepted = 0, covered = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) {
    synthetic.seed = seed;
    synthetic.write(folder_ / "run");
    const int status = post("run --json");
    ASSERT_TRUE(status == 0 || status == 2) << err_;
    if (status != 0) continue;
    ++accepted;
    const json p = json::parse(out_);
    covered += std::fabs(double(p["torque_Nm"]) - 4.125) <= double(p["torque_u95_Nm"]) ? 1 : 0;
  }
  EXPECT_GE(accepted, 105);
  EXPECT_NEAR(covered / double(accepted), 0.95, 0.06 + 0.03);
}

TEST_F(PostCommand, JsonGoesToStandardOutputAlone) {
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run --json"), 0);
  EXPECT_EQ(json::parse(out_), power());
  ASSERT_EQ(post("run"), 0);
  EXPECT_EQ(out_, content(folder_ / "run/post/table.txt"));
  for (const char* text : {"hulled_millet (provisional), fill 0.15, 1.21 1/s, slice of 4 of 22 paddles, seed 1",
                           "steady turns 1 to 10", "mixing power", " W\n", "published equation", "time step over t_c"})
    EXPECT_NE(out_.find(text), std::string::npos) << text;
}

// A second run of the same command changes nothing.
TEST_F(PostCommand, IsRepeatable) {
  quiet_.noise = 0.05;
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0);
  const std::string first = content(folder_ / "run/post/power.json");
  ASSERT_EQ(post("run"), 0);
  EXPECT_EQ(content(folder_ / "run/post/power.json"), first);
  for (const auto& file : fs::directory_iterator(folder_ / "run/post"))
    EXPECT_NE(file.path().extension(), ".partial") << file.path();
}

TEST_F(PostCommand, ViolatedLimitsAreSaidLoudlyAndMarked) {
  quiet_.energy = quiet_.gravity = true;
  quiet_.noise = 0.01;
  const auto warning = [&](const SyntheticRecord& record, const std::string& text) {
    record.write(folder_ / "run");
    EXPECT_EQ(post("run"), 0) << err_;
    EXPECT_NE(err_.find("vielto: WARNING: run/torque.csv: " + text), std::string::npos) << text << "\n" << err_;
    EXPECT_NE(out_.find("WARNING: " + text), std::string::npos) << out_;
    EXPECT_FALSE(power()["quality"]["ok"]);
  };
  SyntheticRecord r = quiet_;
  r.dt_over_tc = 0.06;
  warning(r, "time step is 0.06 t_c");
  r = quiet_;
  r.overlap_mean = 0.006;
  warning(r, "mean overlap is 0.6 %");
  r = quiet_;
  r.overlap_max = 0.08;
  warning(r, "greatest overlap is 8 %");
  r = quiet_;
  r.lost_grains = 2;
  warning(r, "2 grains were lost");
  r = quiet_;
  r.energy_gap = 0.03;
  warning(r, "work exceeds dissipation and stored energy by +3 %");
  r = quiet_;
  r.gravity_gap = 0.075;
  warning(r, "rotor, drum and gravity torque leave +10 % of the rotor torque");
  r = quiet_;
  r.keys = {{"mass_kg", "0.533"}};
  warning(r, "the grains weigh 0.533 kg where the fill asks for 1.067 kg");
  r.keys = {{"mass_kg", "2.986"}};
  warning(r, "the grains weigh 2.986 kg where");
  r.keys["mass_target_kg"] = "2.986";  // 0.15 x 825 kg/m3 x 0.0474 m3 x 4/22 is 1.0665 kg
  warning(r, "mass_target_kg is 2.986, but fill, bulk_density and drum_volume make 1.066 kg");
}

// One row of 720 that alone moves the mean by a tenth: 0.1 x 0.75 N m x 720 = 54 N m. Beside noise of 0.02 N m every
// such row lies far off, so that a hundredth is the limit.
TEST_F(PostCommand, ALoneIntervalThatMovesTheMeanIsNamed) {
  quiet_.energy = quiet_.gravity = false;
  const double rotor = quiet_.rotor_mean();
  for (const double share : {0.006, 0.015, 0.1}) {
    SyntheticRecord r = quiet_;
    r.noise = 0.02;
    r.change = [&](int row, std::map<std::string, double>& values) {
      if (row == 396) values["stems_Nm"] += share * rotor * 720;  // the middle of turn 5
    };
    r.write(folder_ / "run");
    ASSERT_EQ(post("run --turns 10"), 0) << err_;
    const bool named = err_.find("the torque near turn 5.50") != std::string::npos;
    EXPECT_EQ(named, share > 0.01) << share << err_;
  }
}

TEST_F(PostCommand, BalancesAreReportedWhereRecorded) {
  quiet_.energy = quiet_.gravity = true;
  quiet_.energy_gap = 0.004;
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  const json q = power()["quality"];
  EXPECT_NEAR(q["energy_closure_relative"], 0.004, 1e-6);
  EXPECT_NEAR(q["torque_balance_relative"], 0, 1e-7);
  EXPECT_TRUE(q["ok"]);
  // each mechanism has a fifth of what the shaft's work leaves when the rest is missing
  for (const char* loss : {"normal", "tangential", "sliding", "rolling", "twisting"})
    EXPECT_NEAR(power()["losses"][loss]["power_W"], 0.2 * 0.996 * power()["power_W"].get<double>(), 1e-5) << loss;
  SyntheticRecord plain;
  plain.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  EXPECT_TRUE(power()["quality"]["energy_closure_relative"].is_null());
  EXPECT_TRUE(power()["quality"]["torque_balance_Nm"].is_null());
  EXPECT_TRUE(power()["losses"].is_null());
}

TEST_F(PostCommand, ASampleHoweverWildIsAveragedNotDropped) {
  quiet_.change = [](int i, std::map<std::string, double>& row) {
    if (i == 400) row["stems_Nm"] += 720;  // in the sixth turn of ten
  };
  quiet_.write(folder_ / "run");
  ASSERT_EQ(post("run"), 0) << err_;
  const json p = power();
  const double turns = p["turns_averaged"];
  EXPECT_NEAR(p["torque_Nm"], 4.125 + 5.5 * 720 / 72 / turns, 1e-6);
  EXPECT_LT(int(p["turn_first"]), 6);
}

TEST_F(PostCommand, RefusesTooFewTurnsAndSaysHowManyMore) {
  quiet_.turns = 2.9;
  quiet_.write(folder_ / "run");
  expect_refusal("run", "run/torque.csv: has 2 whole turns, and 3 steady ones are asked for; run at least 1 more");
  quiet_.turns = 4;
  quiet_.write(folder_ / "run");
  expect_refusal("run --turns 6",
                 "run/torque.csv: has 4 whole turns, and 6 steady ones are asked for; run at least 2 more");
  EXPECT_EQ(post("run --turns 2"), 2);
  EXPECT_EQ(post("run --allow-short"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "run/post"));
}

TEST_F(PostCommand, RefusesARecordThatDriftsAllAlong) {
  quiet_.noise = 0.01;
  quiet_.drift = 0.05;
  quiet_.write(folder_ / "run");
  EXPECT_EQ(post("run"), 2);
  EXPECT_NE(err_.find("has 10 whole turns"), std::string::npos) << err_;
  EXPECT_NE(err_.find("run at least"), std::string::npos) << err_;
  EXPECT_FALSE(fs::exists(folder_ / "run/post"));
}

TEST_F(PostCommand, RefusesIdlingRecordsThatAreNone) {
  quiet_.write(folder_ / "run");
  idle_.write(folder_ / "idle");
  expect_refusal("idle", "idle/torque.csv: is an idling record (fill 0)");
  expect_refusal("run --idle run", "run/torque.csv: is not an idling record (fill 0.15)");
  expect_refusal("run --idle nowhere", "nowhere: cannot be read");
  idle_.speed = 1.2125;  // 0.2 % faster
  idle_.write(folder_ / "fast");
  expect_refusal("run --idle fast", "fast/torque.csv: idles at 1.2125 1/s, the loaded record ran at 1.21 1/s");
  idle_.speed = 1.211;  // 0.08 %
  idle_.write(folder_ / "near");
  EXPECT_EQ(post("run --idle near"), 0) << err_;
  idle_.speed = 1.21;
  idle_.idle = 0;
  idle_.write(folder_ / "still");
  expect_refusal("run --idle still", "still/torque.csv, column idle_Nm: has no positive mean");
  idle_.idle = 0.6;
  idle_.turns = 2;
  idle_.write(folder_ / "short");
  expect_refusal("run --idle short", "short/torque.csv: has 2 whole turns");
}

TEST_F(PostCommand, RefusesBrokenRecordsInOneLineAndWritesNothing) {
  expect_refusal("run", "run: cannot be read");
  fs::create_directories(folder_ / "run");
  expect_refusal("run", "run: holds no record of a rig; name a run folder with torque.csv,");
  const std::string good = quiet_.text();
  const auto write = [&](const std::string& text) { std::ofstream(folder_ / "run/torque.csv") << text; };
  write("");
  expect_refusal("run", "run/torque.csv: is empty");
  write(good.substr(0, good.size() - 9));
  expect_refusal("run", "run/torque.csv, line 744: is cut off");
  write(good.substr(0, good.find("# dt=")) + good.substr(good.find("# dt_over_tc")));
  expect_refusal("run", "run/torque.csv: lacks the key 'dt'");
  std::string text = good;
  write(text.replace(text.rfind(",3000,"), 6, ",nan,"));
  expect_refusal("run", "run/torque.csv, line 744, column grains: 'nan' is not a finite number");
  EXPECT_FALSE(fs::exists(folder_ / "run/post"));
  EXPECT_EQ(post(""), 2);
}

TEST_F(PostCommand, RefusesAMachineThatTurnsBackwards) {
  quiet_.paddle_mean = -0.15;
  quiet_.write(folder_ / "run");
  expect_refusal("run", "run/torque.csv: the mean torque of the rotor is -2.475 N m");
}

// A name that no table can hold is refused before anything is written.
TEST_F(PostCommand, RefusesATestNameWithAComma) {
  quiet_.write(folder_ / "run");
  expect_refusal("run --test a,b", "run/post/observations.csv, line 2, column test: holds a comma");
  EXPECT_FALSE(fs::exists(folder_ / "run/post/power.json"));
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// What an effect on the measurement chain makes of a value, against hand calculation, and what its file is refused for.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/bad_input.h"
#include "gap/library/effect.h"

using namespace vielto;
using namespace vielto::gap;

namespace {

namespace fs = std::filesystem;
const std::string kLibraries = VIELTO_SOURCE_DIR "/libraries/";
const double pi = std::acos(-1.0);

class MeasurementChain : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "vielto-test-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  // One transform of the mixer's power with these lines.
  Effect read(const std::string& lines) const {
    const std::string path = (folder_ / "drive.toml").string();
    std::ofstream(path) << "name = \"drive\"\nkind = \"measurement\"\nunit = \"1\"\nprior_low = 0.0\nprior_high = 1.0\n"
                           "source = \"hand calculation\"\n[[apply.transform]]\napparatus = \"mixer\"\n"
                           "observable = \"power\"\nfactor = 1.0\n"
                        << lines;
    return read_effect(path, Settings::read(kLibraries + "diagnosis.toml"));
  }
  std::string refusal(const std::string& lines) const {
    try {
      read(lines);
    } catch (const BadInput& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

Observation at_speed(double speed) {
  Observation row;
  row.test = "day1";
  row.apparatus = "mixer";
  row.observable = "power";
  row.speed = speed;
  return row;
}

const char* const kEfficiency = "efficiency = {condition = \"speed\", at = [0.5, 1.0, 2.0], value = [0.6, 0.8, 0.9]}\n";

// The slope of a reading is that of the readings beside it.
void expect_slope(const Transform& t, const Observation& row, double y, double s) {
  const double h = 1e-5 * y;
  const double slope = (t.reading(row, y + h, s).value - t.reading(row, y - h, s).value) / (2 * h);
  EXPECT_NEAR(t.reading(row, y, s).slope, slope, 1e-8 * std::fabs(slope));
}

}  // namespace

TEST_F(MeasurementChain, PowersOfConditions) {
  const std::string of = "power_of = {speed = 0.5}\nreference = {speed = 1.0}\n";
  const Observation row = at_speed(4);
  // g = 0.1 sqrt(4) = 0.2
  EXPECT_DOUBLE_EQ(read("operation = \"scale\"\n" + of).transforms[0].reading(row, 10, 0.1).value, 12);
  EXPECT_DOUBLE_EQ(read("operation = \"add\"\n" + of).transforms[0].reading(row, 10, 0.1).value, 10.2);
  EXPECT_DOUBLE_EQ(read("operation = \"exponential\"\n" + of).transforms[0].reading(row, 10, 0.1).value,
                   10 * std::exp(0.2));
  EXPECT_DOUBLE_EQ(read("operation = \"efficiency\"\n" + of).transforms[0].reading(row, 10, 0.1).value, 12.5);
  for (const char* operation : {"scale", "add", "exponential", "efficiency"}) {
    const Transform t = read("operation = \"" + std::string(operation) + "\"\n" + of).transforms[0];
    EXPECT_EQ(t.reading(row, 10, 0).value, 10) << operation;
    EXPECT_EQ(t.reading(row, 10, 0).slope, 1) << operation;
    expect_slope(t, row, 10, 0.1);
  }
}

// A gear of efficiency 0.8 takes in 10/0.8; half of its losses, 10/0.9; between its points straight lines: 0.85 at 1.5.
TEST_F(MeasurementChain, AnEfficiencyOverSpeed) {
  const Transform t = read(std::string("operation = \"efficiency\"\n") + kEfficiency).transforms[0];
  EXPECT_DOUBLE_EQ(t.reading(at_speed(1), 10, 1).value, 12.5);
  EXPECT_DOUBLE_EQ(t.reading(at_speed(1), 10, 0.5).value, 10 / 0.9);
  EXPECT_DOUBLE_EQ(t.reading(at_speed(1.5), 10, 1).value, 10 / 0.85);
  EXPECT_DOUBLE_EQ(t.reading(at_speed(0.5), 10, 1).value, 10 / 0.6);
  EXPECT_DOUBLE_EQ(t.reading(at_speed(2), 10, 1).value, 10 / 0.9);
  expect_slope(t, at_speed(1.5), 10, 0.7);
}

// Copper loss c (T + T_idle)^2 less that of the idling run, c T_idle^2, at 0.5 and 2 1/s for 20 and 80 W; T = P/(2 pi
// n).
TEST_F(MeasurementChain, CopperLossGoesWithTheTorqueSquared) {
  const double c = 0.05, idle = 3;  // W/(N m)^2, N m
  const double torque = 50 / (2 * pi), s = c * torque * torque / 50;
  const Transform t =
      read(
          "operation = \"scale\"\nreference = {value = 50.0, speed = 1.0}\nterms = [{coefficient = 1, power_of = "
          "{value = 1, speed = -2}}, {coefficient = " +
          std::to_string(2 * idle / torque) + ", power_of = {speed = -1}}]\n")
          .transforms[0];
  for (const auto& [n, power] : {std::pair(0.5, 20.0), std::pair(2.0, 80.0)}) {
    const double load = power / (2 * pi * n);
    const double read_off = power + c * std::pow(load + idle, 2) - c * idle * idle;
    EXPECT_NEAR(t.reading(at_speed(n), power, s).value, read_off, 1e-5 * power);  // the coefficient has six decimals
    expect_slope(t, at_speed(n), power, s);
  }
}

// The effects of the folder at the ends of the thesis's range: a worm gear and copper losses flatten the growth with
// speed, by the exponents that their formulas give (the curve has three decimals and straight lines between its
// points).
TEST_F(MeasurementChain, TheDriveFlattensTheGrowthWithSpeed) {
  const Settings settings = Settings::read(kLibraries + "diagnosis.toml");
  const auto exponent = [&](const char* name, double s, double slow, double fast) {
    const Effect effect = read_effect(kLibraries + "effects/" + name + ".toml", settings);
    const Transform& t = *effect.transform_of("mixer", "power");
    return std::log(t.reading(at_speed(1.58), fast, s).value / fast /
                    (t.reading(at_speed(0.48), slow, s).value / slow)) /
           std::log(1.58 / 0.48);
  };
  const auto eta = [](double n) {
    const double lead = 10 * pi / 180, a = 20 * pi / 180, v = pi * 0.036 * 15 * n / std::cos(lead);
    const double mu = 0.103 * std::exp(-1.185 * std::pow(v, 0.45)) + 0.012;
    return (std::cos(a) - mu * std::tan(lead)) / (std::cos(a) + mu / std::tan(lead));
  };
  const double speeds = std::log(1.58 / 0.48);
  EXPECT_NEAR(exponent("worm_gear", 1, 30, 75), std::log(eta(0.48) / eta(1.58)) / speeds, 2e-3);
  const auto copper = [](double p, double n, double s) { return 1 + s * (p / 50 / n / n + 1 / n); };
  EXPECT_NEAR(exponent("motor_copper", 0.06, 30, 75),
              std::log(copper(75, 1.58, 0.06) / copper(30, 0.48, 0.06)) / speeds, 1e-12);
  EXPECT_LT(exponent("worm_gear", 1, 30, 75), -0.07);
  EXPECT_LT(exponent("motor_copper", 0.06, 30, 75), -0.1);
  EXPECT_GT(exponent("drive_loss", 0.1, 30, 75), 0);  // losses that grow with speed go the other way
}

// One and the same weight of 8 N m at 0.48 and 1.58 1/s: the ratio of its readings by the formulas. Copper: s (T0 + 2
// T0/2) over T0, 2 s/n.
TEST_F(MeasurementChain, ADeadWeightAtTwoSpeedsTellsTheDrivesApart) {
  const Settings settings = Settings::read(kLibraries + "diagnosis.toml");
  const auto ratio = [&](const char* name, double s) {
    const Effect effect = read_effect(kLibraries + "effects/" + name + ".toml", settings);
    const Transform& t = *effect.transform_of("bench", "dead_weight_gain");
    return t.reading(at_speed(0.48), 1, s).value / t.reading(at_speed(1.58), 1, s).value;
  };
  EXPECT_NEAR(ratio("worm_gear", 1), 0.8507 / 0.7733, 2e-3);  // efficiencies of the formula, three decimals in the file
  EXPECT_NEAR(ratio("motor_copper", 0.06), (1 + 0.12 / 0.48) / (1 + 0.12 / 1.58), 1e-12);
  EXPECT_NEAR(ratio("drive_loss", 0.1), (1 + 0.1 * std::sqrt(0.48)) / (1 + 0.1 * std::sqrt(1.58)), 1e-12);
  EXPECT_DOUBLE_EQ(ratio("sensor_gain", 0.1), 1);
}

TEST_F(MeasurementChain, BadInputIsOneLine) {
  const std::string operation = "operation = \"efficiency\"\n";
  const auto refused = [&](const std::string& lines, std::vector<std::string> words) {
    const std::string text = refusal(operation + lines);
    for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
  };
  const auto curve = [](const std::string& at, const std::string& value) {
    return "efficiency = {condition = \"speed\", at = " + at + ", value = " + value + "}\n";
  };
  refused(curve("[0.5, 1]", "[0.8, 1.2]"), {"drive.toml", "value", "efficiency 1.2", "up to 1"});
  refused(curve("[0.5, 1]", "[0, 0.8]"), {"efficiency 0", "above 0"});
  refused(curve("[1, 0.5]", "[0.7, 0.8]"), {"at", "falls from 1 to 0.5", "rising"});
  refused(curve("[0.5, 1]", "[0.7]"), {"value", "two numbers"});
  refused(curve("[0.5, 1]", "[0.7, 0.8, 0.9]"), {"value", "3 numbers for 2"});
  refused(curve("[0.5, \"fast\"]", "[0.7, 0.8]"), {"at", "two numbers"});
  refused("efficiency = {condition = \"colour\", at = [1, 2], value = [0.5, 0.6]}\n", {"condition", "no condition"});
  refused("power_of = {value = 1}\n", {"reference", "value"});
  refused("terms = []\n", {"terms", "no list"});
  refused("power_of = {speed = 1}\nterms = [{coefficient = 1, power_of = {speed = 1}}]\nreference = {speed = 1}\n",
          {"power_of", "beside terms"});

  const auto at_run = [&](const std::string& lines, const Observation& row, double s, std::vector<std::string> words) {
    const Transform t = read(operation + lines).transforms[0];
    try {
      t.reading(row, 10, s);
      ADD_FAILURE() << lines;
    } catch (const BadInput& e) {
      for (const std::string& word : words) EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
  };
  at_run(kEfficiency, at_speed(2.5), 1, {"day1", "speed 2.5", "outside", "0.5 to 2"});
  at_run(kEfficiency, at_speed(0.4), 1, {"speed 0.4", "0.5 to 2"});
  at_run(kEfficiency, Observation(), 1, {"has no speed"});
  at_run(kEfficiency, at_speed(0.5), 3, {"loses 1.2", "prior_high"});
}

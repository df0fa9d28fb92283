// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto fit`, `vielto predict` and `vielto compare` through the real command line.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kSource = VIELTO_SOURCE_DIR;
const std::string kMillet = " --bulk-density 825 --bulk-cohesion 6175";
const std::string kHeader =
    "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material\n";

struct Outcome {
  int status;
  std::string text;
};

Outcome run(const std::string& arguments, const char* streams = "2>/dev/null") {
  FILE* pipe = popen((VIELTO_BIN_DIR "/vielto " + arguments + " " + streams).c_str(), "r");
  Outcome outcome{};
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.text.append(buffer, n);
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class Regression : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("vielto_regression_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string path(const std::string& name) { return (folder / name).string(); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return path(name);
  }
  // Standard error of a refused command: one line, and nothing left behind.
  std::string refusal(const std::string& arguments) {
    const auto files = [&] { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); };
    const auto before = files();
    const Outcome outcome = run(arguments, "2>&1 >/dev/null");
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_EQ(files(), before) << arguments;
    return outcome.text;
  }
  json result(const std::string& arguments) {
    const Outcome outcome = run(arguments + " --json");
    EXPECT_EQ(outcome.status, 0) << arguments;
    return json::parse(outcome.text, nullptr, false);
  }
  fs::path folder;
};

// Power in W of N_PC = b0 l^b1 N_C^b2 Fr_M^b3 in a mixer of lever L, with the definitions of physics and nothing else.
double power_of(double b0, double b1, double b2, double b3, double l, double n, double rho, double c,
                double lever = 0.114) {
  const double cohesion = lever * lever * n * n * rho / c, froude = lever * n * n / 9.81;
  return b0 * std::pow(l, b1) * std::pow(cohesion, b2) * std::pow(froude, b3) * c * std::pow(lever, 3) * n;
}

// Rows of a 4 x 4 grid; `noise` is relative, u = 2 %.
std::string grid(const std::string& material, double rho, double c, double noise = 0, unsigned seed = 1,
                 double lever = 0.114) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::ostringstream rows;
  rows.precision(12);
  for (const double l : {0.10, 0.15, 0.20, 0.25})
    for (const double n : {0.48, 0.85, 1.21, 1.58}) {
      const double p = power_of(15.68, 1.04, 0.1, -0.25, l, n, rho, c, lever) * (1 + noise * normal(random));
      rows << material << "_" << l << "_" << n << ",fit,mixer,power," << p << "," << 0.02 * p << ",W," << n << "," << l
           << ",0.089,,,,," << material << "\n";
    }
  return rows.str();
}

TEST_F(Regression, OneMaterialGivesTheSumOfExponentsAndNoSeparateOnes) {
  const std::string table = write("t.csv", kHeader + grid("millet", 825, 6175));
  const json j = result("fit " + table + kMillet);
  EXPECT_FALSE(j["identifiable"].get<bool>());
  EXPECT_FALSE(j["coefficients"].contains("B2") || j["coefficients"].contains("B3"));
  EXPECT_NEAR(j["coefficients"]["B1"]["value"].get<double>(), 1.04, 1e-9);
  const json sum = j["combinations"]["B2+B3"];
  EXPECT_NEAR(sum["value"].get<double>(), -0.15, 1e-9);
  EXPECT_NEAR(sum["booklet"].get<double>(), -0.15, 1e-12);
  EXPECT_LT(sum["low95"].get<double>(), -0.15);
  EXPECT_GT(sum["high95"].get<double>(), -0.15);
  const std::string text = run("fit " + table + kMillet).text;
  EXPECT_NE(text.find("not determined"), std::string::npos);
}

TEST_F(Regression, FixingOneExponentGivesTheBookletsEquation) {
  const json j = result("fit " + write("t.csv", kHeader + grid("millet", 825, 6175)) + kMillet + " --fix B3=-0.25");
  EXPECT_TRUE(j["identifiable"].get<bool>());
  EXPECT_NEAR(j["coefficients"]["B0"]["value"].get<double>(), 15.68, 1e-7);
  EXPECT_NEAR(j["coefficients"]["B2"]["value"].get<double>(), 0.1, 1e-9);
  EXPECT_TRUE(j["coefficients"]["B3"]["fixed"].get<bool>());
}

// B2(N_PC) = B2(N_P) + 1, since N_PC = N_C N_P.
TEST_F(Regression, PowerNumbersExponentOfCohesionIsSmallerByOne) {
  const json j = result("fit " + write("t.csv", kHeader + grid("millet", 825, 6175)) + kMillet + " --number N_P");
  EXPECT_NEAR(j["combinations"]["B2+B3"]["value"].get<double>(), -1.15, 1e-9);
}

TEST_F(Regression, TwoMaterialsTellTheExponentsApartWithinTheirIntervals) {
  const std::string table = write("t.csv", kHeader + grid("a", 825, 6175, 0.02, 1) + grid("b", 700, 2600, 0.02, 2));
  write("a.par",
        "variable bulkDensity index 825 # kg/m3 | 1 | test\nvariable bulkCohesion index 6175 # Pa | 1 | test\n");
  write("b.par",
        "variable bulkDensity index 700 # kg/m3 | 1 | test\nvariable bulkCohesion index 2600 # Pa | 1 | test\n");
  const json j = result("fit " + table + " --material " + path("a.par") + " --material " + path("b.par"));
  EXPECT_TRUE(j["identifiable"].get<bool>());
  EXPECT_TRUE(j["combinations"].empty());
  const std::map<std::string, double> truth = {{"B0", 15.68}, {"B1", 1.04}, {"B2", 0.1}, {"B3", -0.25}};
  for (const auto& [name, value] : truth) {
    EXPECT_LT(j["coefficients"][name]["low95"].get<double>(), value) << name;
    EXPECT_GT(j["coefficients"][name]["high95"].get<double>(), value) << name;
  }
  EXPECT_EQ(j["residuals"].size(), 32u);
  EXPECT_EQ(j["residuals_by_group"]["l"].size(), 4u);
}

// Two mixers of one shape and two sizes tell N_C (~ L^2) from Fr_M (~ L) with one material.
TEST_F(Regression, TwoMixerSizesTellTheExponentsApart) {
  write("small.par", "variable powerLever index 0.114 # m | 0 | test\n");
  write("large.par", "variable powerLever index 0.300 # m | 0 | test\n");
  const std::string a = write("a.csv", kHeader + grid("millet", 825, 6175));
  const std::string b = write("b.csv", kHeader + grid("millet", 825, 6175, 0, 1, 0.300));
  const json j =
      result("fit " + a + " " + b + kMillet + " --mixer " + path("small.par") + " --mixer " + path("large.par"));
  EXPECT_TRUE(j["identifiable"].get<bool>());
  EXPECT_NEAR(j["coefficients"]["B2"]["value"].get<double>(), 0.1, 1e-8);
  EXPECT_NEAR(j["coefficients"]["B3"]["value"].get<double>(), -0.25, 1e-8);
}

TEST_F(Regression, AGroupThatIsConstantIsMergedIntoTheFactor) {
  const json j =
      result("fit " + write("t.csv", kHeader + grid("millet", 825, 6175)) + " --groups l,Fr_M,L_d/W_kl --material " +
             write("millet.par", "variable bulkDensity index 825\nvariable bulkCohesion index 6175\n") + " --mixer " +
             kSource + "/cases/mixer/mixer.par");
  EXPECT_TRUE(j["identifiable"].get<bool>());
  EXPECT_NEAR(j["merged"]["B4"]["value"].get<double>(), 15.3, 1e-9);
  EXPECT_FALSE(j["coefficients"].contains("B4"));
  EXPECT_NEAR(j["coefficients"]["B3"]["value"].get<double>(), -0.15, 1e-9);  // Fr_M alone carries the speed
}

TEST_F(Regression, LoadedLessIdlePowerIsFitted) {
  std::string rows;
  for (const double l : {0.1, 0.2, 0.25})
    for (const double n : {0.5, 1.0, 1.5}) {
      const double p = power_of(15.68, 1.04, 0.1, -0.25, l, n, 825, 6175);
      std::ostringstream test, conditions;
      test << "t" << l << "_" << n;
      conditions << n << "," << l << ",,,,,,millet\n";
      for (const auto& [name, value] :
           {std::pair<const char*, double>{"power_loaded", p + 12}, {"power_idle", 12}, {"power", 999}})
        rows += test.str() + ",fit,mixer," + name + "," + std::to_string(value) + ",0.5,W," + conditions.str();
    }
  const json j = result("fit " + write("t.csv", kHeader + rows) + kMillet);
  EXPECT_NEAR(j["combinations"]["B2+B3"]["value"].get<double>(), -0.15, 1e-5);  // 6 decimals of the rows
}

TEST_F(Regression, RowsOfRoleCheckArePredictedNotFitted) {
  const double p = 2 * power_of(15.68, 1.04, 0.1, -0.25, 0.15, 1, 825, 6175);
  const json j = result("fit " +
                        write("t.csv", kHeader + grid("millet", 825, 6175) + "held,check,mixer,power," +
                                           std::to_string(p) + ",1,W,1,0.15,,,,,,millet\n") +
                        kMillet);
  EXPECT_NEAR(j["coefficients"]["B1"]["value"].get<double>(), 1.04, 1e-9);
  EXPECT_NEAR(j["check"]["maximum"].get<double>(), 0.5, 1e-6);
}

// Prediction from the file of a fit in one material, at speeds and fills of its range, is the equation's power.
TEST_F(Regression, FittedFilePredictsThePowerBetweenItsRows) {
  const std::string table = write("t.csv", kHeader + grid("millet", 825, 6175));
  ASSERT_EQ(run("fit " + table + kMillet + " --out " + path("e.json")).status, 0);
  const json j =
      result("predict --equation " + path("e.json") + kMillet + " --speeds 0.6,1.4 --fills 0.12 --mixing-time 100");
  for (const json& p : j["predictions"]) {
    const double expected = power_of(15.68, 1.04, 0.1, -0.25, 0.12, p["speed"], 825, 6175);
    EXPECT_NEAR(p["power"].get<double>(), expected, 1e-8 * expected);
    EXPECT_LT(p["low95"].get<double>(), expected);
    EXPECT_GT(p["high95"].get<double>(), expected);
    EXPECT_NEAR(p["energy"]["value"].get<double>(), 100 * expected, 1e-6 * expected);  // J = W s
  }
}

TEST_F(Regression, PredictionOutsideTheFittedRangeIsRefusedUnlessAskedFor) {
  const std::string thesis = "predict --thesis" + kMillet;
  EXPECT_NE(refusal(thesis + " --speeds 1 --fills 0.3").find("l = 0.3 is outside 0.1 to 0.25"), std::string::npos);
  refusal(thesis + " --speeds 2 --fills 0.2 --out " + path("o.csv"));
  const Outcome asked = run(thesis + " --speeds 1 --fills 0.3 --extrapolate");
  EXPECT_EQ(asked.status, 0);
  EXPECT_NE(asked.text.find("OUTSIDE THE FITTED RANGE"), std::string::npos);
}

TEST_F(Regression, AnotherMaterialThanTheOneFittedIsRefused) {
  run("fit " + write("t.csv", kHeader + grid("millet", 825, 6175)) + kMillet + " --out " + path("e.json"));
  EXPECT_NE(refusal("predict --equation " + path("e.json") +
                    " --bulk-density 825 --bulk-cohesion 3000 --speeds 0.6 --fills 0.15")
                .find("does not determine B3 apart"),
            std::string::npos);
}

// P = K l^1.04: the fill for a power p is (p/K)^(1/1.04).
TEST_F(Regression, LargestFillForAMotorInvertsTheEquation) {
  const double limit = 50, k = power_of(15.68, 1.04, 0.1, -0.25, 1, 1.21, 825, 6175);
  const json j = result("predict --thesis" + kMillet + " --speeds 0.5,1.21 --motor-power 60 --idle-power 10");
  EXPECT_NEAR(j["largest_fill"][1]["expected"].get<double>(), std::pow(limit / k, 1 / 1.04), 1e-9);
  const double upper = std::exp(1.95996 * 0.137 / 2.0772);  // the booklet's error, doc/theory/equation.md
  EXPECT_NEAR(j["largest_fill"][1]["safe"].get<double>(), std::pow(limit / upper / k, 1 / 1.04), 1e-5);
  EXPECT_EQ(j["largest_fill"][0]["expected"].get<double>(), 0.25);  // the motor is strong enough for the whole range
}

// The committed table of the booklet's equation is what its documented command makes (doc/theory/equation.md).
TEST_F(Regression, CommittedTableOfTheBookletsEquationIsReproduced) {
  ASSERT_EQ(run("predict --thesis --mixer " + kSource + "/cases/mixer/mixer.par --material " + kSource +
                "/materials/hulled_millet.par --wall " + kSource + "/materials/steel.par --moisture 0.089 " +
                "--speeds 0.48,0.85,1.21,1.58 --fills 0.10,0.15,0.20,0.25 --out " + path("thesis.csv"))
                .status,
            0);
  const auto content = [](const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  };
  EXPECT_EQ(content(path("thesis.csv")), content(kSource + "/cases/mixer/results/thesis_equation.observations.csv"));
}

TEST_F(Regression, TablesAreComparedSideBySide) {
  const std::string a = write("a.csv", kHeader + "x,fit,mixer,power,20,3,W,1,0.15,,,,,,millet\n");
  const std::string b = write("b.csv", kHeader + "y,fit,mixer,power,23,4,W,1,0.15,,,,,,millet\n");
  const json j = result("compare " + a + " " + b + " --out " + path("pairs.csv"));
  EXPECT_NEAR(j["pairs"][0]["relative_gap"].get<double>(), 0.15, 1e-12);
  EXPECT_NEAR(j["pairs"][0]["z"].get<double>(), 0.6, 1e-12);
  EXPECT_TRUE(fs::exists(path("pairs.csv")));
}

// One line naming file, line and column for every kind of bad table.
TEST_F(Regression, BadTablesAreRefusedWithTheirPlace) {
  const std::string good = "x,fit,mixer,power,20,3,W,1,0.15,,,,,,millet\n";
  const struct {
    const char* rows;
    const char* place;
  } cases[] = {
      {"y,fit,mixer,power,nan,3,W,1,0.15,,,,,,millet\n", "line 3, column value"},
      {"y,fit,mixer,power,20,0,W,1,0.15,,,,,,millet\n", "line 3, column u"},
      {"y,fit,mixer,power,20,3,kW,1,0.15,,,,,,millet\n", "line 3, column unit"},
      {"x,fit,mixer,power,20,3,W,1,0.15,,,,,,millet\n", "line 3, column observable"},
      {"y,fit,mixer,power,20,3,W,,0.15,,,,,,millet\n", "line 3, column speed"},
      {"y,fit,mixer,power,20,3,W,1,,,,,,,millet\n", "line 3, column fill"},
      {"y,fit,mixer,power,-20,3,W,1,0.15,,,,,,millet\n", "line 3, column value"},
      {"y,fit,mixer,power_loaded,20,3,W,1,0.15,,,,,,millet\n", "line 3, column observable"},
      {"y,fit,mixer,power_loaded,20,3,W,1,0.15,,,,,,millet\ny,fit,mixer,power_idle,40,3,W,1,0.15,,,,,,millet\n",
       "line 3, column value: power_loaded, 20 W, is below power_idle, 40 W"},
      {"y,fit,mixer,power_loaded,20,3,W,1,0.15,,,,,,millet\ny,fit,mixer,power_idle,21,3,W,1,0.15,,,,,,millet\n",
       "line 3, column value: the grain's power is -1 W"},
      {"y,fit,mixer,power,20,3\n", "line 3"},
  };
  for (const auto& c : cases) {
    const std::string text =
        refusal("fit " + write("t.csv", kHeader + good + c.rows) + kMillet + " --out " + path("e.json"));
    EXPECT_NE(text.find("t.csv, " + std::string(c.place)), std::string::npos) << text;
  }
}

TEST_F(Regression, OtherBadInputIsRefusedInOneLine) {
  const std::string table = write("t.csv", kHeader + grid("millet", 825, 6175));
  const std::string two = write("two.csv", kHeader + grid("millet", 825, 6175) + grid("wheat", 780, 5000));
  const std::string fit = "fit " + table + kMillet;
  EXPECT_NE(refusal("fit " + path("none.csv") + kMillet).find("none.csv"), std::string::npos);
  EXPECT_NE(refusal(fit + " --fix B9=1").find("--fix B9=1"), std::string::npos);
  EXPECT_NE(refusal(fit + " --fix B3=x").find("--fix B3=x"), std::string::npos);
  EXPECT_NE(refusal(fit + " --groups l,colour").find("'colour' is no group"), std::string::npos);
  EXPECT_NE(refusal(fit + " --groups l,L_d/W_kl").find("--mixer"), std::string::npos);
  EXPECT_NE(refusal("fit " + two + kMillet).find("line 2, column material"), std::string::npos);
  EXPECT_NE(refusal("fit " + write("few.csv", kHeader + "x,fit,mixer,power,20,3,W,1,0.15,,,,,,millet\n") + kMillet)
                .find("few.csv"),
            std::string::npos);
  EXPECT_NE(refusal("predict --equation " + table + kMillet + " --speeds 1 --fills 0.15").find("is no JSON"),
            std::string::npos);
}

// Three errors, each pair correlated by -0.6, cannot be: the variance of their sum would be negative.
TEST_F(Regression, ACovarianceThatIsNotPositiveDefiniteIsRefused) {
  const std::string table =
      write("t.csv", kHeader + "x,fit,mixer,power,20,1,W,0.5,0.15,,,,,,m\n" +
                         "y,fit,mixer,power,30,1,W,1,0.15,,,,,,m\n" + "z,fit,mixer,power,40,1,W,1.5,0.15,,,,,,m\n");
  write("t.covariance.csv",
        "test_a,observable_a,test_b,observable_b,covariance\n"
        "x,power,y,power,-0.6\nx,power,z,power,-0.6\ny,power,z,power,-0.6\n");
  EXPECT_NE(refusal("fit " + table + kMillet + " --groups Fr_M")
                .find("t.covariance.csv: the covariance matrix is not positive definite"),
            std::string::npos);
  EXPECT_EQ(run("fit " + table + kMillet + " --groups Fr_M --unweighted").status, 0);
}

TEST_F(Regression, AnotherNameOfTheOneMaterialIsNoted) {
  const json j = result("fit " + write("t.csv", kHeader + grid("millet", 825, 6175)) + " --material " + kSource +
                        "/materials/hulled_millet.par");
  EXPECT_NE(j["notes"].dump().find("the rows name the material 'millet', the card is 'hulled_millet'"),
            std::string::npos);
}

// The same table with speeds in revolutions per minute; 1.58 1/s is the fastest of the booklet, Fr_M 0.029.
TEST_F(Regression, RevolutionsPerMinuteAreAskedAbout) {
  const auto notes = [&](double factor) {
    std::ostringstream rows;
    for (const double l : {0.1, 0.15, 0.2})
      for (const double n : {0.5, 0.8, 1.2, 1.5})
        rows << "t" << l << "_" << n << ",fit,mixer,power," << power_of(8.2, 1, 0.1, -0.2, l, n, 825, 6175) << ",0.1,W,"
             << factor * n << "," << l << ",,,,,,\n";
    return result("fit " + write("t.csv", kHeader + rows.str()) + kMillet)["notes"].dump();
  };
  EXPECT_EQ(notes(1).find("is that 1/min?"), std::string::npos);
  EXPECT_NE(notes(60).find("t.csv, line 2: speed 30 1/s and Fr_M 10.5: is that 1/min?"), std::string::npos)
      << notes(60);
}

TEST_F(Regression, HelpNamesTheOptionsOfEachCommand) {
  for (const auto& [command, option] :
       {std::pair<const char*, const char*>{"fit", "--fix"}, {"predict", "--motor-power"}, {"compare", "--ignore"}}) {
    const Outcome help = run(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.text.find(option), std::string::npos);
  }
}

}  // namespace

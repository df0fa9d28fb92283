// SPDX-License-Identifier: GPL-2.0-or-later
// Reduction of loaded and idling power, and two tables side by side, against hand-worked numbers.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/bad_input.h"
#include "equation/comparison.h"

namespace {

using namespace vielto;
namespace fs = std::filesystem;

const std::string kHeader =
    "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material\n";
const std::string kCovarianceHeader = "test_a,observable_a,test_b,observable_b,covariance\n";

class Tables : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("vielto_tables_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
  }
  fs::path folder;
};

std::string power(const std::string& test, double value, double u, double speed,
                  const std::string& observable = "power") {
  return test + ",fit,mixer," + observable + "," + std::to_string(value) + "," + std::to_string(u) + ",W," +
         std::to_string(speed) + ",0.15,,,,,,millet\n";
}

// 40 - 12 = 28 W; u^2 = 3^2 + 4^2 - 2*5 = 15.
TEST_F(Tables, LoadedLessIdleIsThePowerAndItsCovarianceCounts) {
  const std::string path = write("a.csv", kHeader + power("t", 40, 3, 1, "power_loaded") +
                                              power("t", 12, 4, 1, "power_idle") + power("t", 99, 1, 1, "power"));
  write("a.covariance.csv", kCovarianceHeader + "t,power_loaded,t,power_idle,5\n");
  const ReducedTable table = read_reduced_table(path);
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0].observable, "power");
  EXPECT_DOUBLE_EQ(table.rows[0].value, 28);
  EXPECT_DOUBLE_EQ(table.rows[0].u, std::sqrt(15));
}

// One idling run under two tests: idle errors fully shared, cov = u_idle^2 = 16.
TEST_F(Tables, ASharedIdlingRunCorrelatesThePowers) {
  const std::string path =
      write("a.csv", kHeader + power("s", 40, 3, 1, "power_loaded") + power("s", 12, 4, 1, "power_idle") +
                         power("t", 50, 3, 1, "power_loaded") + power("t", 12, 4, 1, "power_idle"));
  write("covariance.csv", kCovarianceHeader + "s,power_idle,t,power_idle,16\n");
  const ReducedTable table = read_reduced_table(path);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_DOUBLE_EQ(table.covariance.coeff(0, 1), 16);
  EXPECT_DOUBLE_EQ(table.covariance.coeff(0, 0), 25);
}

TEST_F(Tables, LoadedPowerWithoutIdlingIsRefusedWithItsLine) {
  const std::string path = write("a.csv", kHeader + power("s", 40, 3, 1) + power("t", 40, 3, 1, "power_loaded"));
  try {
    read_reduced_table(path);
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("line 3, column observable"), std::string::npos) << error.what();
  }
}

// Less power with grain than without by over three of its u, hypot(3, 4) W, is a mix-up; 14 W below is not.
TEST_F(Tables, LoadedPowerBelowIdlingIsRefusedWithItsLine) {
  const auto table = [&](double loaded) {
    return write("a.csv", kHeader + power("s", loaded, 3, 1, "power_loaded") + power("s", 40, 4, 1, "power_idle"));
  };
  EXPECT_DOUBLE_EQ(read_reduced_table(table(26)).rows.at(0).value, -14);
  try {
    read_reduced_table(table(24));
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("line 2, column value: power_loaded, 24 W, is below power_idle, 40 W"),
              std::string::npos)
        << error.what();
  }
}

// 20 against 23 W with u 3 and 4: gap 15 %, z = 3/5; 30 against 27 W with u 2 and 2: z = -3/sqrt(8). Independent:
// chi2 = 0.36 + 1.125. Matched by speed, whatever the names.
TEST_F(Tables, PairsHaveRelativeGapAndZ) {
  const ReducedTable a = read_reduced_table(write("a.csv", kHeader + power("x", 20, 3, 0.5) + power("y", 30, 2, 1)));
  const ReducedTable b = read_reduced_table(
      write("b.csv", kHeader + power("p", 27, 2, 1) + power("q", 23, 4, 0.5) + power("r", 1, 1, 1.5)));
  const Comparison c = compare(a, b, {});
  ASSERT_EQ(c.pairs.size(), 2u);
  EXPECT_EQ(c.pairs[0].b.test, "q");
  EXPECT_NEAR(c.pairs[0].gap, 0.15, 1e-12);
  EXPECT_NEAR(c.pairs[0].z, 0.6, 1e-12);
  EXPECT_NEAR(c.pairs[1].z, -3 / std::sqrt(8), 1e-12);
  EXPECT_NEAR(c.chi2.value(), 0.36 + 1.125, 1e-12);
  EXPECT_EQ(c.only_b, std::vector<std::string>{"r power"});
  EXPECT_TRUE(c.only_a.empty());
  EXPECT_NEAR(c.summaries.at(0).rms_gap, std::sqrt((0.15 * 0.15 + 0.1 * 0.1) / 2), 1e-12);
}

// Both differences +2 with unit errors in A fully shared but for the rest in B: V = [[1.5, 1], [1, 1.5]] (u 1 and
// sqrt(0.5)); chi2 = 2*4/(2.5) by the eigenvalue of (1, 1).
TEST_F(Tables, SharedErrorsOfATableWeighInChi2) {
  const std::string path = write("a.csv", kHeader + power("x", 20, 1, 0.5) + power("y", 30, 1, 1));
  write("a.covariance.csv", kCovarianceHeader + "x,power,y,power,1\n");
  const std::string b = write("b.csv", kHeader + "p,fit,mixer,power,22,0.7071067811865476,W,0.5,0.15,,,,,,millet\n" +
                                           "q,fit,mixer,power,32,0.7071067811865476,W,1,0.15,,,,,,millet\n");
  const Comparison c = compare(read_reduced_table(path), read_reduced_table(b), {});
  EXPECT_NEAR(c.chi2.value(), 8 / 2.5, 1e-9);
}

// Replicates under the same conditions: their mean 21 with u = 2/sqrt(2) against one row of 24 with u 1.
TEST_F(Tables, ReplicatesAreComparedByTheirMean) {
  const ReducedTable a = read_reduced_table(write("a.csv", kHeader + power("x1", 20, 2, 1) + power("x2", 22, 2, 1)));
  const ReducedTable b = read_reduced_table(write("b.csv", kHeader + power("p", 24, 1, 1)));
  const Comparison c = compare(a, b, {});
  ASSERT_EQ(c.pairs.size(), 1u);
  EXPECT_EQ(c.pairs[0].rows_a, 2);
  EXPECT_NEAR(c.pairs[0].z, 3 / std::sqrt(3), 1e-12);
}

TEST_F(Tables, ConditionsThatDifferKeepRowsApartUnlessIgnored) {
  const ReducedTable a = read_reduced_table(write("a.csv", kHeader + power("x", 20, 2, 1)));
  const ReducedTable b =
      read_reduced_table(write("b.csv", kHeader + "p,fit,mixer,power,24,1,W,1,0.15,0.089,,,,steel,millet\n"));
  EXPECT_THROW(compare(a, b, {}), BadInput);
  EXPECT_EQ(compare(a, b, {"moisture", "wall"}).pairs.size(), 1u);
  EXPECT_THROW(compare(a, b, {"colour"}), BadInput);
}

}  // namespace

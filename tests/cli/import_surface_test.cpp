// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto import surface` through its command line: surfaces of known slope, a published one, bad input.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/observation_table.h"

namespace {

namespace fs = std::filesystem;
const double pi = std::acos(-1.0);

struct Outcome {
  int status;
  std::string text;
};

class ImportSurface : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "vielto-test-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& text) { std::ofstream(folder_ / "surface.csv") << text; }
  Outcome run(const std::string& options) const {
    const std::string command =
        "cd " + folder_.string() + " && " VIELTO_BIN_DIR "/vielto import surface " + options + " > out.txt 2>&1";
    const int status = std::system(command.c_str());
    std::ostringstream text;
    text << std::ifstream(folder_ / "out.txt").rdbuf();
    return {WEXITSTATUS(status), text.str()};
  }
  std::vector<vielto::Observation> rows() const {
    return vielto::read_observations((folder_ / "observations.csv").string());
  }

  fs::path folder_;
};

const std::string kWords =
    "--x-column x_mm --length-factor 0.001 --drum-diameter 0.084 --u 0.5 0.7 0.6 --out observations.csv ";
const std::string kOne = "surface.csv --y-column y_mm --test one " + kWords;

// A plane that falls at 35 degrees to x = 0 and at 20 beyond.
std::string bent(double sense, int from = -34, int to = 34) {
  std::ostringstream text;
  text.precision(12);
  text << "x_mm,y_mm\n";
  for (int x = from; x <= to; ++x)
    text << x << "," << -sense * x * std::tan((sense * x < 0 ? 35 : 20) * pi / 180) << "\n";
  return text.str();
}

}  // namespace

TEST_F(ImportSurface, WritesThreeRowsUnderTheirConditions) {
  write(bent(1));
  const Outcome done = run(kOne + "--speed 0.5 --fill 0.505 --wall glass --material beads --role check");
  ASSERT_EQ(done.status, 0) << done.text;
  const auto table = rows();
  ASSERT_EQ(table.size(), 3u);
  const char* const names[] = {"angle_mid", "angle_upper", "angle_lower"};
  const double u[] = {0.5, 0.7, 0.6};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(table[k].observable, names[k]);
    EXPECT_EQ(table[k].u, u[k]);
    EXPECT_EQ(table[k].apparatus, "drum");
    EXPECT_EQ(table[k].role, vielto::Role::check);
    EXPECT_EQ(table[k].speed, 0.5);
    EXPECT_EQ(table[k].fill, 0.505);
    EXPECT_EQ(table[k].tilt, 0.0);
    EXPECT_EQ(table[k].wall, "glass");
    EXPECT_EQ(table[k].material, "beads");
  }
  EXPECT_NEAR(table[1].value, 35, 1e-6);
  EXPECT_NEAR(table[2].value, 20, 1e-6);
}

TEST_F(ImportSurface, APictureTakenFromTheOtherSideIsTurnedRound) {
  write(bent(-1));
  const Outcome done = run(kOne + "--uphill-right");
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_NEAR(rows()[1].value, 35, 1e-6);
  EXPECT_NEAR(rows()[2].value, 20, 1e-6);
}

// One x, two surfaces, each given where it was seen.
TEST_F(ImportSurface, EmptyFieldsAreNoPoints) {
  std::ostringstream text;
  text << "x_mm,slow,fast\n";
  for (int x = -33; x <= 33; ++x) {
    text << x << ",";
    if (x < 31) text << -0.5 * x;
    text << ",";
    if (x > -30 && x < 30) text << -0.9 * x;
    text << "\n";
  }
  write(text.str());
  ASSERT_EQ(run("surface.csv --y-column slow --test slow " + kWords).status, 0);
  const Outcome second = run("surface.csv --y-column fast --test fast --append " + kWords);
  ASSERT_EQ(second.status, 0) << second.text;
  const auto table = rows();
  ASSERT_EQ(table.size(), 6u);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(table[k].value, std::atan(k < 3 ? 0.5 : 0.9) * 180 / pi, 1e-9) << k;
}

// The contours that were read off the published pictures, and the slopes stated beside them (two decimals).
TEST_F(ImportSurface, PublishedSurfacesHaveTheirPublishedSlopes) {
  const double stated[2][3] = {{37.4, 38.09, 31.65}, {46.14, 43.8, 26.93}};
  for (int k = 0; k < 2; ++k) {
    const Outcome done = run(VIELTO_SOURCE_DIR "/findings/granudrum/surfaces.csv --test A --y-column " +
                             std::string(k == 0 ? "y_10rpm_mm " : "y_30rpm_mm ") + kWords);
    ASSERT_EQ(done.status, 0) << done.text;
    const auto table = rows();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(table[i].value, stated[k][i], 0.005) << table[i].observable;
  }
}

TEST_F(ImportSurface, BadInputIsOneLine) {
  const auto refused = [&](const std::string& text, const std::string& options, std::vector<std::string> words) {
    write(text);
    const Outcome done = run(options);
    EXPECT_EQ(done.status, 2) << done.text;
    EXPECT_EQ(std::count(done.text.begin(), done.text.end(), '\n'), 1) << done.text;
    for (const std::string& word : words)
      EXPECT_NE(done.text.find(word), std::string::npos) << word << ": " << done.text;
    EXPECT_FALSE(fs::exists(folder_ / "observations.csv"));
  };
  refused("x_mm\n1\n2\n", kOne, {"surface.csv", "no column 'y_mm'", "x_mm"});
  refused("x_mm,y_mm\n1,2\n3\n", kOne, {"surface.csv, line 3", "1 numbers for 2 columns"});
  refused("x_mm,y_mm\n-1,2\n0,0\n1,-2\n", kOne, {"surface.csv", "angle_mid", "3 points"});
  refused(bent(1, -34, 15), kOne, {"angle_lower", "5 points"});
  refused("x_mm,y_mm\n1,2\n1,3\n", kOne, {"line 3", "x_mm", "line 2 too"});
  refused("x_mm,y_mm\n,3\n", kOne, {"line 2", "x_mm", "not given"});
  refused("x_mm,y_mm\n1,2\n3,steep\n", kOne, {"line 3", "y_mm", "'steep'"});
  refused(
      bent(1),
      "surface.csv --x-column x_mm --y-column y_mm --test one --drum-diameter 0.084 --u 1 1 1 --out observations.csv",
      {"outside the drum", "--length-factor"});
  refused(bent(1),
          "surface.csv --x-column x_mm --y-column x_mm --test one --drum-diameter 84 --u 1 1 1 --out observations.csv",
          {"x_mm", "two columns"});
}

// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto import surface` through its command line: surfaces of known slope, a published one, bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "tests/cli/command_test.h"

namespace {

namespace fs = std::filesystem;
const double pi = std::acos(-1.0);

class ImportSurface : public vielto_test::CommandTest {
 protected:
  void write_surface(const std::string& text) { write("surface.csv", text); }
  int import(const std::string& options) { return vielto("import surface " + options); }
  std::vector<vielto::Observation> rows() const {
    return vielto::read_observations((folder_ / "observations.csv").string());
  }
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
  write_surface(bent(1));
  ASSERT_EQ(import(kOne + "--speed 0.5 --fill 0.505 --wall glass --material beads --role check"), 0) << err_;
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
  write_surface(bent(-1));
  ASSERT_EQ(import(kOne + "--uphill-right"), 0) << err_;
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
  write_surface(text.str());
  ASSERT_EQ(import("surface.csv --y-column slow --test slow " + kWords), 0);
  ASSERT_EQ(import("surface.csv --y-column fast --test fast --append " + kWords), 0) << err_;
  const auto table = rows();
  ASSERT_EQ(table.size(), 6u);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(table[k].value, std::atan(k < 3 ? 0.5 : 0.9) * 180 / pi, 1e-9) << k;
}

// The contours that were read off the published pictures, and the slopes stated beside them (two decimals).
TEST_F(ImportSurface, PublishedSurfacesHaveTheirPublishedSlopes) {
  const double stated[2][3] = {{37.4, 38.09, 31.65}, {46.14, 43.8, 26.93}};
  for (int k = 0; k < 2; ++k) {
    ASSERT_EQ(import(VIELTO_SOURCE_DIR "/findings/granudrum/surfaces.csv --test A --y-column " +
                     std::string(k == 0 ? "y_10rpm_mm " : "y_30rpm_mm ") + kWords),
              0)
        << err_;
    const auto table = rows();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(table[i].value, stated[k][i], 0.005) << table[i].observable;
  }
}

TEST_F(ImportSurface, BadInputIsOneLine) {
  const auto refused = [&](const std::string& text, const std::string& options, std::vector<std::string> words) {
    write_surface(text);
    EXPECT_EQ(import(options), 2) << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
    for (const std::string& word : words) EXPECT_NE(err_.find(word), std::string::npos) << word << ": " << err_;
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

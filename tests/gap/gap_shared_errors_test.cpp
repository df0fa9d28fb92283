// SPDX-License-Identifier: GPL-2.0-or-later
// Rows that share their errors wholly or nearly, and other tables whose covariance has no inverse or whose u is tiny:
// `vielto gap` through its command line, on the wheat library and the published angles of wall B.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/observation_table.h"
#include "core/seal.h"
#include "gap_folder.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vielto::Observation;
using vielto::Role;
using vielto_test::content;
using vielto_test::GapFolder;

class GapSharedErrors : public GapFolder {
 protected:
  void SetUp() override {
    GapFolder::SetUp();
    fs::remove_all(folder_ / "library");
    fs::copy(VIELTO_SOURCE_DIR "/libraries/wheat", folder_ / "library");
    fs::remove(folder_ / "library/inputs.csv");  // whether it is stale is not the question here
    measured_ = vielto::read_observations(VIELTO_SOURCE_DIR "/findings/wheat_walls/observations.csv");
  }

  // Rows of wall B by name.
  std::vector<Observation> rows(const std::vector<std::string>& names) const {
    std::vector<Observation> found;
    for (const std::string& name : names)
      for (const Observation& row : measured_)
        if (row.test == name) found.push_back(row);
    EXPECT_EQ(found.size(), names.size());
    return found;
  }
  // `count` rows like `row` but for their names.
  static void add_copies(std::vector<Observation>& rows, const Observation row, int count) {
    for (int i = 1; i <= count; ++i) {
      rows.push_back(row);
      rows.back().test += fmt::format("-copy{}", i);
    }
  }
  void write(const std::vector<Observation>& rows, const std::vector<std::size_t>& share, double correlation = 1) {
    vielto::write_observations((folder_ / "t.csv").string(), rows);
    std::string text = "test_a,observable_a,test_b,observable_b,covariance\n";
    for (const std::size_t a : share)
      for (const std::size_t b : share)
        if (a < b)
          text += fmt::format("{},angle,{},angle,{:.17g}\n", rows[a].test, rows[b].test,
                              correlation * rows[a].u * rows[b].u);
    if (share.empty())
      fs::remove(folder_ / "t.covariance.csv");
    else
      std::ofstream(folder_ / "t.covariance.csv") << text;
  }
  std::string how(const std::string& options = "") const {
    return " t.csv --library library --ignore wall --runs-per-observation 0 --draws 100 " + options;
  }
  json diagnosed(const std::string& options = "") {
    EXPECT_EQ(gap("diagnose" + how("--out answer ") + options), 0) << err_;
    const json d = json::parse(content(folder_ / "answer/diagnosis.json"), nullptr, false);
    EXPECT_TRUE(d.is_object());
    double sum = 0;
    for (const auto& [name, p] : d["probabilities"].items()) {
      EXPECT_TRUE(p.is_number()) << name;
      if (p.is_number()) sum += p.get<double>();
    }
    EXPECT_NEAR(sum, 1, 1e-9);
    EXPECT_TRUE(d["log_odds"]["threshold"].is_number());
    fs::remove_all(folder_ / "answer");
    return d;
  }

  std::vector<Observation> measured_;
};

// Two readings of one quantity with one common error cannot be 5 deg apart: no model explains it, and that is said.
TEST_F(GapSharedErrors, RowsThatShareAllAndDifferAreAGap) {
  const std::vector<Observation> two = rows({"B00", "B45-1", "B45-2"});
  for (const double correlation : {0.997, 0.999999, 1 - 1e-12, 1.0}) {
    write(two, {1, 2}, correlation);
    const json d = diagnosed();
    EXPECT_EQ(d["verdict"], "unknown") << correlation;
    EXPECT_GT(d["probabilities"]["unknown"].get<double>() + 0.0, d["probabilities"]["no_gap"].get<double>());
    EXPECT_NE(out_.find("note: B45-1 and B45-2 share their conditions and their error, but differ by 4.99 deg"),
              std::string::npos)
        << out_;
  }
  ASSERT_EQ(gap("next" + how()), 0) << err_;
  EXPECT_NE(out_.find("There is a gap"), std::string::npos) << out_;
}

// Of many rows with one error the pair farthest apart is named, 56.75 and 65.96 deg, not each of the ten.
TEST_F(GapSharedErrors, ManyContradictionsAreOneLine) {
  std::vector<Observation> all = rows({"B00", "B45-1", "B45-2", "B45-3", "B45-4", "B45-5"});
  for (Observation& row : all) row.role = vielto::Role::fit;
  write(all, {1, 2, 3, 4, 5}, 1);
  diagnosed();
  const std::string words = "note: B45-1 and B45-5 share their conditions and their error, but differ by 9.21 deg";
  EXPECT_NE(out_.find(words), std::string::npos) << out_;
  EXPECT_NE(out_.find("(10 such pairs there)"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("share their conditions"), out_.rfind("share their conditions")) << out_;
}

// One mean stated three times is one mean. What is left to a row of its own, 1e-3 u, changes the variance of their mean
// by less than 1e-6, and probabilities by chi2 times that.
TEST_F(GapSharedErrors, OneMeanStatedTwiceCountsOnce) {
  std::vector<Observation> one = rows({"B00", "B45-1"});
  write(one, {});
  const json alone = diagnosed();
  add_copies(one, one[1], 2);
  write(one, {1, 2, 3});
  const json thrice = diagnosed();
  EXPECT_NEAR(thrice["log_odds"]["best_rival"].get<double>(), alone["log_odds"]["best_rival"].get<double>(), 1e-3);
  for (const auto& [name, p] : alone["probabilities"].items())
    EXPECT_NEAR(thrice["probabilities"][name].get<double>(), p.get<double>(), 1e-3) << name;
  EXPECT_EQ(out_.find("but differ"), std::string::npos) << out_;
}

// Replicates of which every one repeats the other, without any shared error stated.
TEST_F(GapSharedErrors, EqualValuesAreNoFault) {
  std::vector<Observation> equal = rows({"B00", "B45-1"});
  add_copies(equal, equal[1], 4);
  write(equal, {});
  EXPECT_NE(diagnosed()["verdict"], "no_gap");
}

// The whole published table: level, both walls are one pooled mean, stated twice.
TEST_F(GapSharedErrors, TheWholeTableOfBothWallsHasAFiniteThreshold) {
  fs::copy(VIELTO_SOURCE_DIR "/findings/wheat_walls/observations.csv", folder_ / "t.csv");
  fs::copy(VIELTO_SOURCE_DIR "/findings/wheat_walls/observations.covariance.csv", folder_ / "t.covariance.csv");
  ASSERT_EQ(gap("isolability" + how("--out sealed")), 0) << err_;
  const json i = json::parse(content(folder_ / "sealed/isolability.json"));
  for (const char* key : {"log_odds", "low95", "high95"}) EXPECT_TRUE(i["threshold"][key].is_number()) << key;
  EXPECT_EQ(content(folder_ / "sealed/isolability.json").find("null"), std::string::npos);
  const json d = diagnosed("--sealed sealed/isolability.json");
  EXPECT_EQ(d["log_odds"]["threshold"], i["threshold"]["log_odds"]);
}

// Rows of different u may share all of the smaller's error.
TEST_F(GapSharedErrors, SharedErrorsOfDifferentSize) {
  std::vector<Observation> two = rows({"B00", "B45-1"});
  add_copies(two, two[1], 1);
  two[2].u *= 3;
  write(two, {1, 2});
  diagnosed();
}

// A mean of two rows stated beside them: no pair is fully correlated, all three together are.
TEST_F(GapSharedErrors, ARowThatIsTheMeanOfTwoOthers) {
  std::vector<Observation> three = rows({"B45-1", "B45-2"});
  add_copies(three, three[0], 1);
  three[2].value = (three[0].value + three[1].value) / 2;
  three[2].u = three[0].u / std::sqrt(2.0);
  vielto::write_observations((folder_ / "t.csv").string(), three);
  const double half = three[0].u * three[0].u / 2;
  std::ofstream(folder_ / "t.covariance.csv")
      << "test_a,observable_a,test_b,observable_b,covariance\n"
      << fmt::format("B45-1,angle,B45-1-copy1,angle,{0:.17g}\nB45-2,angle,B45-1-copy1,angle,{0:.17g}\n", half);
  const json with_mean = diagnosed();
  three.pop_back();
  write(three, {});
  const json without = diagnosed();
  for (const auto& [name, p] : without["probabilities"].items())
    EXPECT_NEAR(with_mean["probabilities"][name].get<double>(), p.get<double>(), 1e-3) << name;
}

// Nothing is measured to a ten-millionth: probabilities add up all the same, and the reader is told.
TEST_F(GapSharedErrors, AnUncertaintyBelowTheArithmeticIsRaisedAndTold) {
  for (const double u : {1e-5, 1e-7, 1e-9, 1e-12, 1e-100}) {
    std::vector<Observation> exact = rows({"B00", "B45-1", "B45-2"});
    for (Observation& row : exact) row.u = u;
    write(exact, {});
    const json d = diagnosed();
    EXPECT_NE(d["verdict"], "no_gap") << u;
    EXPECT_NE(out_.find("note: u of B45-1 angle is raised"), std::string::npos) << out_;
    write(exact, {1, 2});
    diagnosed();
  }
}

// Whether correlations contradict each other does not depend on the units: here beside a row of a u a million times as
// large.
TEST_F(GapSharedErrors, ContradictionsAreSeenInSmallUnits) {
  std::vector<Observation> four = rows({"B00", "B45-1", "B45-2"});
  add_copies(four, four[1], 1);
  four[0].u = 1e6;
  write(four, {1, 2, 3}, -0.9);
  EXPECT_EQ(gap("diagnose" + how("--out answer")), 2) << out_;
  expect_one_line("t.covariance.csv: is no covariance");
  EXPECT_FALSE(fs::exists(folder_ / "answer"));
}

// A drift of 1e200 W has a square that is not finite: one line, and no verdict is printed.
TEST_F(GapSharedErrors, WhatIsNotFiniteStops) {
  fs::copy(VIELTO_SOURCE_DIR "/libraries/millet", folder_ / "millet");
  fs::remove(folder_ / "millet/inputs.csv");
  Observation drift;
  drift.test = "idle", drift.role = Role::fit, drift.apparatus = "bench", drift.observable = "zero_drift";
  drift.value = 1e200, drift.u = 1, drift.unit = "W", drift.speed = 0.48;
  vielto::write_observations((folder_ / "t.csv").string(), {drift});
  const std::string options = " t.csv --library millet --draws 100";
  EXPECT_EQ(gap("diagnose --out answer" + options), 2) << out_;
  expect_one_line("t.csv: the evidence of no_gap is not finite");
  EXPECT_EQ(out_, "");
  EXPECT_FALSE(fs::exists(folder_ / "answer"));
  EXPECT_EQ(gap("next" + options), 2) << out_;
  expect_one_line("is not finite");
}

// A seal of an earlier version may hold a threshold that is no number.
TEST_F(GapSharedErrors, ASealWithoutAThresholdIsNamed) {
  write(rows({"B00", "B45-1"}), {});
  ASSERT_EQ(gap("isolability" + how("--out sealed")), 0) << err_;
  const std::string path = (folder_ / "sealed/isolability.json").string();
  const json whole = json::parse(content(path));
  const auto expect = [&](const json& j, const char* part) {
    std::ofstream(path, std::ios::trunc) << j.dump(2) << "\n";
    vielto::seal(path);
    EXPECT_EQ(gap("diagnose" + how("--out answer --sealed sealed/isolability.json")), 2) << out_;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "answer"));
  };
  json j = whole;
  j["threshold"]["log_odds"] = nullptr;
  expect(j, "isolability.json: holds a threshold whose log_odds is no number");
  j["threshold"] = 3;
  expect(j, "is no isolability.json");
  j = whole;
  j["threshold"].erase("draws");
  expect(j, "holds a threshold whose draws is no number");
  expect(json::array(), "is no isolability.json");
}

}  // namespace

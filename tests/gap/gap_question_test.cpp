// SPDX-License-Identifier: GPL-2.0-or-later
// What a seal depends on, and what it does not; known effects as text; a sealed threshold read back.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/seal.h"
#include "core/sha256.h"
#include "gap/question/sealed.h"
#include "gap_folder.h"
#include "gap_toy.h"

namespace {

namespace fs = std::filesystem;
using namespace vielto;
using namespace vielto::gap;

class GapQuestion : public vielto_test::GapFolder {
 protected:
  void SetUp() override {
    GapFolder::SetUp();
    toy::write_library(folder_ / "library", toy::effects_with_runs(), 0, 7);
    toy::write_discrepancy(folder_ / "library");
    std::mt19937_64 random(5);
    rows_ = toy::measured({}, random);
    options_.files.library = (folder_ / "library").string();
    options_.table = (folder_ / "t.csv").string();
    options_.draws = 20;
    write_observations(options_.table, rows_);
  }
  std::string fingerprint_with(const std::function<void(QuestionOptions&)>& change) const {
    QuestionOptions options = options_;
    change(options);
    return Question(options).fingerprint();
  }

  QuestionOptions options_;
  std::vector<Observation> rows_;
};

TEST_F(GapQuestion, TheFingerprintKnowsAllThatAThresholdDependsOn) {
  const std::string own = Question(options_).fingerprint();
  EXPECT_EQ(fingerprint_with([](auto& o) { o.draws = 30; }), own);
  EXPECT_EQ(fingerprint_with([](auto& o) { o.seed = 2; }), own);
  EXPECT_NE(fingerprint_with([](auto& o) { o.without = {"shape"}; }), own);
  EXPECT_NE(fingerprint_with([](auto& o) { o.only = {"apparatus=mixer"}; }), own);
  EXPECT_NE(fingerprint_with([](auto& o) { o.emulator.runs_per_observation = 3; }), own);
  EXPECT_NE(fingerprint_with([](auto& o) { o.emulator.use_discrepancy = false; }), own);
  EXPECT_NE(fingerprint_with([](auto& o) { o.emulator.known = {{"cohesion", 10}}; }), own);
  EXPECT_NE(fingerprint_with([](auto& o) { o.emulator.ignored = {"wall"}; }), own);
  for (Observation& row : rows_) row.value *= 1.2;
  write_observations(options_.table, rows_);
  EXPECT_EQ(Question(options_).fingerprint(), own) << "values must not count";
  rows_[0].u *= 1.01;
  write_observations(options_.table, rows_);
  EXPECT_NE(Question(options_).fingerprint(), own);
}

TEST_F(GapQuestion, ASealedThresholdIsReadBackForItsOwnQuestionOnly) {
  const Question q(options_);
  const Threshold t = q.threshold();
  const std::string path = (folder_ / "isolability.json").string();
  std::ofstream(path) << isolability_json(q, isolability(q.before_data(), q.inputs.settings), t).dump(2);
  seal(path);
  const Threshold read = sealed_threshold(path, q);
  EXPECT_EQ(read.log_odds, t.log_odds);
  EXPECT_EQ(read.draws, 20);
  QuestionOptions other = options_;
  other.without = {"shape"};
  EXPECT_THROW(sealed_threshold(path, Question(other)), BadInput);
  std::ofstream(path, std::ios::app) << " ";
  EXPECT_THROW(sealed_threshold(path, q), BadInput);
}

TEST_F(GapQuestion, ProvenanceStatesTheFilesAndTheOptions) {
  options_.emulator.ignored = {"wall", "moisture"};
  const auto p = Question(options_).provenance();
  EXPECT_EQ(p["hashes"]["t.csv"], sha256_of_file(options_.table));
  EXPECT_TRUE(p["hashes"].contains("design.csv"));
  EXPECT_EQ(p["options"]["ignore"].dump(), R"(["moisture","wall"])");
  EXPECT_EQ(p["fingerprint"].get<std::string>().size(), 64u);
}

// Three rows at speeds 1, 2, 1 of walls A, A, B; each pair of rows shares an error of its own.
ReducedTable three_rows() {
  ReducedTable table{"t.csv", "", {}, {2, 3, 4}, {}};
  for (int i = 0; i < 3; ++i) {
    Observation row;
    row.apparatus = "mixer", row.observable = "power", row.value = i, row.u = 1;
    row.speed = i == 1 ? 2 : 1, row.wall = i == 2 ? "B" : "A";
    table.rows.push_back(row);
  }
  Eigen::MatrixXd u(3, 3);
  u << 1, 0.1, 0.2, 0.1, 1, 0.3, 0.2, 0.3, 1;
  table.covariance = u.sparseView();
  return table;
}

TEST(GapRows, OnlyThoseAskedForWithTheirCovariance) {
  const ReducedTable slow = only_rows(three_rows(), {"speed=1"});
  EXPECT_EQ(slow.lines, (std::vector<int>{2, 4}));
  EXPECT_EQ(slow.rows[1].value, 2);
  Eigen::Matrix2d u;
  u << 1, 0.2, 0.2, 1;
  EXPECT_EQ(Eigen::MatrixXd(slow.covariance), u);
  EXPECT_EQ(only_rows(three_rows(), {"speed=1", "wall=B"}).lines, std::vector<int>{4});
  EXPECT_EQ(only_rows(three_rows(), {"apparatus=mixer", "observable=power"}).lines.size(), 3u);
  EXPECT_EQ(only_rows(three_rows(), {"speed=2.0000018"}).lines, std::vector<int>{3});  // within 1e-6
  for (const char* none : {"speed=2.0000024", "speed=1.9999976", "fill=0.1", "wall=C"})
    EXPECT_THROW(only_rows(three_rows(), {none}), BadInput) << none;
  for (const char* bad : {"speed", "colour=red", "speed=fast"})
    EXPECT_THROW(only_rows(three_rows(), {bad}), BadInput) << bad;
}

TEST(GapRows, JoinedTablesShareNoErrors) {
  const ReducedTable both = joined(three_rows(), only_rows(three_rows(), {"wall=A"}));
  EXPECT_EQ(both.lines, (std::vector<int>{2, 3, 4, 2, 3}));
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(5, 5);
  u.topLeftCorner(3, 3) << 1, 0.1, 0.2, 0.1, 1, 0.3, 0.2, 0.3, 1;
  u.bottomRightCorner(2, 2) << 1, 0.1, 0.1, 1;
  EXPECT_EQ(Eigen::MatrixXd(both.covariance), u);
}

TEST(GapRows, TheFingerprintIsOfUsAndSharedErrors) {
  const ReducedTable table = three_rows();
  const Eigen::MatrixXd u(table.covariance);
  const std::string own = rows_fingerprint(table.rows, u);
  EXPECT_EQ(own.size(), 64u);
  for (const auto& [i, j] : {std::pair(1, 0), {2, 0}, {2, 1}}) {
    Eigen::MatrixXd other = u;
    other(i, j) += 0.01;
    EXPECT_NE(rows_fingerprint(table.rows, other), own) << i << " " << j;
    other = u;
    other(j, i) += 0.01;  // the lower half says it all
    EXPECT_EQ(rows_fingerprint(table.rows, other), own) << i << " " << j;
  }
  // nothing shared is nothing said: a table without a covariance has the same
  EXPECT_EQ(rows_fingerprint(table.rows, Eigen::MatrixXd::Identity(3, 3)), sha256_of_text([&] {
              std::string text;
              for (const Observation& row : table.rows)
                text += fmt::format("{} {} {} {:.6g}|", row.apparatus, row.observable, conditions_text(row), row.u);
              return text;
            }()));
}

TEST(GapKnown, TextsBecomeStrengths) {
  EXPECT_EQ(known_effects({"a=1", "b=-0.5"}, {}), (std::map<std::string, double>{{"a", 1}, {"b", -0.5}}));
  EXPECT_THROW(known_effects({"a"}, {}), BadInput);
  EXPECT_THROW(known_effects({"a=nan"}, {}), BadInput);
  EXPECT_THROW(known_effects({"a=1", "a=2"}, {}), BadInput);
  EXPECT_THROW(known_effects({"a=1"}, {"a"}), BadInput);
}

}  // namespace

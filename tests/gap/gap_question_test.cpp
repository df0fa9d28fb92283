// SPDX-License-Identifier: GPL-2.0-or-later
// What a seal depends on, and what it does not; known effects as text; a sealed threshold read back.
#include <gtest/gtest.h>

#include <functional>

#include "core/bad_input.h"
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

TEST(GapKnown, TextsBecomeStrengths) {
  EXPECT_EQ(known_effects({"a=1", "b=-0.5"}, {}), (std::map<std::string, double>{{"a", 1}, {"b", -0.5}}));
  EXPECT_THROW(known_effects({"a"}, {}), BadInput);
  EXPECT_THROW(known_effects({"a=nan"}, {}), BadInput);
  EXPECT_THROW(known_effects({"a=1", "a=2"}, {}), BadInput);
  EXPECT_THROW(known_effects({"a=1"}, {"a"}), BadInput);
}

}  // namespace

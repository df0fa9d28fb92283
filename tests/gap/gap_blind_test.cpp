// SPDX-License-Identifier: GPL-2.0-or-later
// The blind check end to end on toy laws: seals, answers that cannot have seen a truth, marks, and what chance scores.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "gap/blind/power_signal.h"
#include "gap/blind/score.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

// Wilson's score interval by hand: p = 8/10, z = 1.96: centre (0.8 + 0.19207)/(1.38415) = 0.71673,
// half 1.96/1.38415 sqrt(0.016 + 0.0096036) = 0.22659 (z^2 = 3.8415).
TEST(GapScore, WilsonByHand) {
  const auto w = vielto::gap::wilson(8, 10);
  EXPECT_DOUBLE_EQ(w.value, 0.8);
  EXPECT_NEAR(w.low95, 0.4901, 2e-4);
  EXPECT_NEAR(w.high95, 0.9433, 2e-4);
  EXPECT_EQ(vielto::gap::wilson(0, 0).high95, 1);
}

// Of n samples of an AR(1): 1/n without correlation, (1 + rho)/2 for two, 1 for a constant.
TEST(PowerSignal, VarianceOfTheMeanOfCorrelatedSamples) {
  using vielto::gap::variance_of_mean;
  EXPECT_NEAR(variance_of_mean(50, 0), 0.02, 1e-15);
  EXPECT_NEAR(variance_of_mean(2, 0.3), 0.65, 1e-15);
  EXPECT_NEAR(variance_of_mean(20, 1), 1, 1e-12);
}

// 3000 draws know a standard deviation to 1.3 % and a mean to u/55.
TEST(PowerSignal, ErrorOfTheMeanHasTheStatedUncertaintyWhateverItIsMadeOf) {
  for (const double drift : {0.0, 0.5, 1.0}) {
    std::mt19937_64 random(3);
    const vielto::gap::PowerSignal signal{10, 60, 2, drift, 0.2, 0.1};
    double sum = 0, square = 0;
    for (int i = 0; i < 3000; ++i) {
      const double e = vielto::gap::mean_error(signal, 38, 1.5, 1.1, random);  // 90 whole turns: no ripple is left
      sum += e;
      square += e * e;
    }
    EXPECT_NEAR(sum / 3000, 0, 4 * 1.1 / 55) << drift;
    EXPECT_NEAR(std::sqrt(square / 3000), 1.1, 4 * 0.013 * 1.1) << drift;
  }
}

TEST(PowerSignal, ADisplayWithCoarseStepsIsOffByTheSameInEverySample) {
  std::mt19937_64 random(1);
  EXPECT_NEAR(vielto::gap::mean_error({10, 60, 2, 0.5, 0, 1}, 10.3, 1, 1e-6, random), -0.3, 1e-12);
}

class GapBlind : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("gap_blind_{}", getpid());
    std::ofstream(folder_.string() + ".toml") << "no_effect_draws = 3\nweak = 2.0\nmiddle = 4.0\nstrong = "
                                                 "8.0\ntruths_per_effect = 1\ndraws = 1\nremoved = 5\n"
                                                 "sham = 2\npairs = 2\nfrom_prior = 6\nreachable = 0.7\n"
                                                 "[power_signal]\nrate = 10\nduration = 60\ncorrelation = 2\n"
                                                 "drift = 0.5\nripple = 0.2\nstep = 0.1\n";
    // paths as a person gives them, from where they stand
    const std::string name = folder_.filename().string();
    status_ = run(fmt::format("cd '{}' && '{}/tests/gap/gap_toy_blind.sh' {} 4 {}.toml 200",
                              folder_.parent_path().string(), VIELTO_SOURCE_DIR, name, name));
  }
  static void TearDownTestSuite() {
    fs::remove_all(folder_);
    fs::remove(folder_.string() + ".toml");
  }
  static int run(const std::string& command) {
    const int status = std::system(("export PATH=" VIELTO_BIN_DIR ":" VIELTO_BIN_DIR "/../tests:$PATH; (" + command +
                                    ") > " + folder_.string() + ".out 2>&1")
                                       .c_str());
    output_ = content(folder_.string() + ".out");
    fs::remove(folder_.string() + ".out");
    return WEXITSTATUS(status);
  }
  static json score(const char* name = "score.json") { return json::parse(content(folder_ / name)); }

  static fs::path folder_;
  static int status_;
  static std::string output_;
};
fs::path GapBlind::folder_;
int GapBlind::status_ = -1;
std::string GapBlind::output_;

// The script moves every truth out of reach while the diagnosis runs.
TEST_F(GapBlind, RunsFromSealToScoreWithTheTruthsOutOfReach) {
  ASSERT_EQ(status_, 0) << output_;
  const json s = score();
  for (const char* key : {"right", "in_group", "wrong_name", "false_alarm", "unknown_found", "removed_named",
                          "coverage90", "closure", "placebo", "brier", "where_f1"}) {
    EXPECT_TRUE(s.contains(key)) << key;
    EXPECT_TRUE(s.contains(std::string(key) + "_low95")) << key;
    EXPECT_TRUE(s.contains(std::string(key) + "_high95")) << key;
  }
  EXPECT_GT(s["right"], 0.6);
  EXPECT_LT(s["wrong_name"], 0.2);
  EXPECT_LT(s["false_alarm"], 0.4);
  EXPECT_LT(s["brier"], 0.8);
}

TEST_F(GapBlind, TheAnswerIsTheSameWithAndWithoutTruthsInReach) {
  ASSERT_EQ(status_, 0) << output_;
  ASSERT_TRUE(fs::exists(folder_ / "blind/truth/0001.json"));  // back in place
  fs::copy(folder_ / "answers/0001", folder_ / "apart", fs::copy_options::recursive);
  fs::remove_all(folder_ / "answers/0001");
  ASSERT_EQ(run(fmt::format("cd '{}' && '{}/scripts/blind' diagnose blind/cases answers sealed/isolability.json "
                            "libraries/millet --draws 200",
                            folder_.string(), VIELTO_SOURCE_DIR)),
            0)
      << output_;
  EXPECT_EQ(content(folder_ / "answers/0001/diagnosis.json"), content(folder_ / "apart/diagnosis.json"));
}

TEST_F(GapBlind, RefusesAPlanOfAnImpossibleTransmitterWithOneClearLine) {
  ASSERT_EQ(status_, 0) << output_;
  const std::string plan = content(folder_.string() + ".toml");
  const auto refused = [&](const std::string& line, const std::string& other, const std::string& column) {
    std::string bad = plan;
    bad.replace(bad.find(line), line.size(), other);
    std::ofstream(folder_ / "bad.toml") << bad;
    EXPECT_EQ(
        run(fmt::format("cd '{}' && gap-withhold --library libraries/millet --truth libraries/millet --tests tests.csv "
                        "--sealed sealed/isolability.json --plan bad.toml --out never",
                        folder_.string())),
        2);
    EXPECT_NE(output_.find(", column " + column + ": "), std::string::npos) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "never"));
  };
  refused("correlation = 2", "correlation = -2", "correlation");
  refused("rate = 10", "rate = 0.02", "duration");  // one sample
}

// A right answer at random: one of about a dozen verdicts. With the truths permuted, names fit by chance only; a truth
// handed to any case meets a gap as often as all answers together see one, within three binomial deviations. Means of
// eight permutations: a single one has few cases without an effect.
TEST_F(GapBlind, ShuffledTruthScoresAsChance) {
  ASSERT_EQ(status_, 0) << output_;
  const int permutations = 8;
  double right = 0, false_alarm = 0, brier = 0, cases = 0;
  for (int k = 1; k <= permutations; ++k) {
    const json s = score(fmt::format("shuffled{}.json", k).c_str());
    right += s["right"].get<double>() / permutations;
    false_alarm += s["false_alarm"].get<double>() / permutations;
    brier += s["brier"].get<double>() / permutations;
    cases += s["false_alarm_n"].get<double>();
  }
  EXPECT_LT(right, 0.35);
  EXPECT_GT(false_alarm, 0.3);
  EXPECT_GT(brier, score()["brier"].get<double>() + 0.3);
  double seen = 0, answers = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "answers")) {
    seen += json::parse(content(entry.path() / "diagnosis.json"))["verdict"] != "no_gap";
    ++answers;
  }
  const double chance = seen / answers;
  EXPECT_NEAR(false_alarm, chance, 3 * std::sqrt(chance * (1 - chance) / cases));
}

// The closure rests on re-simulation where every strong case that has something to simulate was simulated; a case said
// to have no gap has nothing. It follows the measured values, not the prediction: here they close nothing.
TEST_F(GapBlind, ClosuresAreMeasuredWhereCasesWereSimulatedAgain) {
  ASSERT_EQ(status_, 0) << output_;
  EXPECT_EQ(score()["closure_basis"], "predicted by the emulator where no re-simulation was made");
  fs::copy(folder_ / "answers", folder_ / "simulated", fs::copy_options::recursive);
  bool no_gap_among_strong = false;
  for (const auto& entry : fs::directory_iterator(folder_ / "simulated")) {
    const json truth = json::parse(content(folder_ / "blind/truth" / (entry.path().filename().string() + ".json")));
    json answer = json::parse(content(entry.path() / "diagnosis.json"));
    const bool strong = truth["kind"] == "known" && truth["level"] == "strong";
    // one strong case is made one without a gap
    if (strong && !no_gap_among_strong) answer["verdict"] = "no_gap", no_gap_among_strong = true;
    if (strong && answer["verdict"] != "no_gap")
      answer["shrink"] = {{"before", 0.3}, {"recalibrated", 0.2}, {"after", 0.2}, {"placebo", 0.2}};
    else
      answer["shrink_predicted"] = json();
    std::ofstream(entry.path() / "diagnosis.json") << answer;
  }
  ASSERT_TRUE(no_gap_among_strong);
  ASSERT_EQ(run(fmt::format(
                "cd '{}' && gap-score blind --answers simulated --sealed sealed/isolability.json --out simulated.json",
                folder_.string())),
            0)
      << output_;
  const json s = score("simulated.json");
  EXPECT_EQ(s["closure_basis"], "re-simulated");
  EXPECT_NEAR(s["closure"], 0, 1e-12);
  EXPECT_FALSE(s.contains("closure_resimulated"));
  // one of them predicted only: the others' closure is stated by itself
  for (const auto& entry : fs::directory_iterator(folder_ / "simulated")) {
    json answer = json::parse(content(entry.path() / "diagnosis.json"));
    if (answer["shrink"].is_null() || answer["verdict"] == "no_gap") continue;
    answer["shrink_predicted"] = answer["shrink"];
    answer["shrink"] = json();
    std::ofstream(entry.path() / "diagnosis.json") << answer;
    break;
  }
  ASSERT_EQ(run(fmt::format(
                "cd '{}' && gap-score blind --answers simulated --sealed sealed/isolability.json --out simulated.json",
                folder_.string())),
            0)
      << output_;
  const json part = score("simulated.json");
  EXPECT_EQ(part["closure_resimulated_n"], int(part["closure_n"]) - 2);  // nor the one without a gap
  EXPECT_NEAR(part["closure_resimulated"], 0, 1e-12);
  EXPECT_NEAR(part["placebo_resimulated"], 0, 1e-12);
  EXPECT_GT(part["closure_true_effect"], 0);
  // recalibration leaves less than the true effect at its true strength: there is nothing to be a share of
  for (const auto& entry : fs::directory_iterator(folder_ / "simulated")) {
    json answer = json::parse(content(entry.path() / "diagnosis.json"));
    answer["shrink"] = {{"before", 0.3}, {"recalibrated", 1e-6}, {"after", 0.2}, {"placebo", 0.2}};
    answer["shrink_predicted"] = answer["shrink"];
    std::ofstream(entry.path() / "diagnosis.json") << answer;
  }
  ASSERT_EQ(run(fmt::format(
                "cd '{}' && gap-score blind --answers simulated --sealed sealed/isolability.json --out simulated.json",
                folder_.string())),
            0)
      << output_;
  EXPECT_TRUE(score("simulated.json")["closure"].is_null());
  EXPECT_LT(score("simulated.json")["closure_true_effect"], 0);
  fs::remove_all(folder_ / "simulated");
}

// Against its own reference state a truth whose law shifts every power has not changed, and what has changed is found;
// two references make two seals, and both sets of cases are scored together.
TEST_F(GapBlind, ChangesAreMarkedAgainstEachReferenceOfATruth) {
  ASSERT_EQ(status_, 0) << output_;
  std::istringstream in(content(folder_ / "tests.csv"));
  std::ofstream repeated(folder_ / "repeated.csv");
  std::string line;
  for (std::getline(in, line), repeated << line << '\n'; std::getline(in, line);) {
    const bool bench = line.find(",bench,") != std::string::npos;
    for (int k = 1; k <= (bench ? 1 : 4); ++k)
      repeated << fmt::format("{}_{}", line.substr(0, line.find(',')), k) << line.substr(line.find(',')) << '\n';
  }
  repeated.close();
  const std::string here = fmt::format("cd '{}' && ", folder_.string());
  std::ofstream(folder_ / "few.toml")
      << "no_effect_draws = 2\nweak = 2\nmiddle = 4\nstrong = 8\ntruths_per_effect = 1\n"
         "draws = 0\nremoved = 0\nsham = 0\npairs = 0\nfrom_prior = 4\nreachable = 0.7\n";
  const std::string made =
      "gap-withhold --library libraries/millet --truth truth/1 --plan few.toml --tests repeated.csv ";
  std::string sets, answers, seals;
  int cases = 0, found = 0;
  for (const int k : {1, 2}) {
    const std::string name = fmt::format("r{}", k), seal = name + "/sealed/isolability.json";
    const std::string reference = fmt::format("--reference {}/reference.csv ", name);
    ASSERT_EQ(run(here + "mkdir " + name + " && " + made +
                  fmt::format("--draw-reference --seed {} --out {}/reference.csv && ", k, name) +
                  "vielto gap isolability repeated.csv " + reference + "--library libraries/millet --draws 200 --out " +
                  name + "/sealed && " + made + reference + "--sealed " + seal +
                  fmt::format(" --seed {} --out {}/blind", k, name) + " && '" + VIELTO_SOURCE_DIR +
                  "/scripts/blind' diagnose " + name + "/blind/cases " + name + "/answers " + seal +
                  " libraries/millet " + reference + "--draws 200"),
              0)
        << output_;
    for (const auto& entry : fs::directory_iterator(folder_ / name / "answers")) {
      const json truth =
          json::parse(content(folder_ / name / "blind/truth" / (entry.path().filename().string() + ".json")));
      EXPECT_EQ(truth["base_truth"], "1");
      found += truth["kind"] == "prior" && json::parse(content(entry.path() / "diagnosis.json"))["verdict"] != "no_gap";
      ++cases;
    }
    sets += " " + name + "/blind", answers += " " + name + "/answers", seals += " " + seal;
  }
  ASSERT_EQ(run(here + "gap-score" + sets + " --answers" + answers + " --sealed" + seals + " --out changes.json"), 0)
      << output_;
  const json s = score("changes.json");
  EXPECT_EQ(s["cases"], cases);
  EXPECT_EQ(s["false_alarm_n"], 4);
  EXPECT_EQ(s["false_alarm"], 0);
  EXPECT_EQ(s["wrong_name_n"], 8);
  EXPECT_EQ(s["wrong_name"], 0);
  EXPECT_GE(found, 4);

  // an answer against one reference is not marked by the seal of the other
  EXPECT_EQ(run(here + "gap-score r1/blind --answers r1/answers --sealed r2/sealed/isolability.json --out never.json"),
            2);
  EXPECT_NE(output_.find("was made for other rows or another library than were sealed"), std::string::npos) << output_;
  EXPECT_EQ(
      run(here +
          "gap-score r1/blind r2/blind --answers r1/answers --sealed r1/sealed/isolability.json --out never.json"),
      2);
  EXPECT_NE(output_.find("are not one of each FOLDER"), std::string::npos) << output_;
  EXPECT_EQ(run(here + made + "--draw-reference --out r1/reference.csv"), 2);
  EXPECT_NE(output_.find("is there already"), std::string::npos) << output_;
  EXPECT_EQ(run(here + made + "--out never"), 2);
  EXPECT_NE(output_.find("--sealed: is missing"), std::string::npos) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "never.json"));
  EXPECT_FALSE(fs::exists(folder_ / "never"));
}

TEST_F(GapBlind, ATamperedTruthIsRefused) {
  ASSERT_EQ(status_, 0) << output_;
  const std::string truth = content(folder_ / "blind/truth/0002.json");
  std::ofstream(folder_ / "blind/truth/0002.json") << truth << " ";
  EXPECT_EQ(
      run(fmt::format("cd '{}' && gap-score blind --answers answers --sealed sealed/isolability.json --out again.json",
                      folder_.string())),
      2);
  EXPECT_NE(output_.find("truth/0002.json is not what its seal says"), std::string::npos) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "again.json"));
  std::ofstream(folder_ / "blind/truth/0002.json") << truth;
}

// A seal is for its own rows, and an answer for its own seal.
TEST_F(GapBlind, RefusesTheSealOfOtherRows) {
  ASSERT_EQ(status_, 0) << output_;
  std::string tests = content(folder_ / "tests.csv");
  const auto at = tests.find("W,", tests.find('\n'));  // the first u
  tests.insert(tests.rfind(',', at - 2) + 1, "1");
  std::ofstream(folder_ / "other.csv") << tests;
  EXPECT_EQ(
      run(fmt::format("cd '{}' && gap-withhold --library libraries/millet --truth truth/0 --tests other.csv --sealed "
                      "sealed/isolability.json --plan '{}/tests/data/toy_plan.toml' --out other",
                      folder_.string(), VIELTO_SOURCE_DIR)),
      2);
  EXPECT_NE(output_.find("was sealed for other rows than those of other.csv"), std::string::npos) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "other"));
  const fs::path path = folder_ / "answers/0001/diagnosis.json";
  const std::string answer = content(path);
  json other = json::parse(answer);
  other["provenance"]["without"] = json::array();
  other["provenance"]["fingerprint"] = "0";
  std::ofstream(path) << other;
  EXPECT_EQ(
      run(fmt::format("cd '{}' && gap-score blind --answers answers --sealed sealed/isolability.json --out again.json",
                      folder_.string())),
      2);
  EXPECT_NE(output_.find("0001/diagnosis.json: was made for other rows"), std::string::npos) << output_;
  std::ofstream(path) << answer;
}

TEST_F(GapBlind, CasesSayNothingOfTheTruth) {
  ASSERT_EQ(status_, 0) << output_;
  for (const auto& entry : fs::directory_iterator(folder_ / "blind/cases")) {
    int files = 0;
    for (const auto& file : fs::directory_iterator(entry.path())) {
      ++files;
      EXPECT_TRUE(file.path().filename() == "observations.csv" || file.path().filename() == "case.json") << file.path();
    }
    EXPECT_EQ(files, 2);
    const json c = json::parse(content(entry.path() / "case.json"));
    EXPECT_EQ(c.size(), 2u);
  }
}

TEST_F(GapBlind, TheProgramVieltoHoldsNoneOfIt) {
  ASSERT_EQ(run("strings " VIELTO_BIN_DIR "/vielto | grep -c -e seals.sha256 -e unreachable.csv"), 1) << output_;
  ASSERT_EQ(run("strings " VIELTO_BIN_DIR "/gap-withhold | grep -q seals.sha256"), 0);
}

}  // namespace

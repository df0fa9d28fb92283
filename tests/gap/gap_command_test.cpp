// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto gap` through its command line, on a toy library (gap_toy.h): answers, and one clear line for every bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "gap_folder.h"
#include "gap_toy.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vielto::Observation;
using vielto::Role;
using vielto_test::content;
using vielto_test::GapFolder;

void replace_in(const fs::path& path, const std::string& from, const std::string& to) {
  std::string text = content(path);
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << path << " has no " << from;
  std::ofstream(path, std::ios::binary) << text.replace(at, from.size(), to);
}

class GapCommand : public GapFolder {
 protected:
  void SetUp() override {
    GapFolder::SetUp();
    toy::write_library(folder_ / "library", toy::effects_with_runs(), 0, 7);
    toy::write_discrepancy(folder_ / "library");
    toy::State state;
    state.effects["cohesion"] = 200;
    std::mt19937_64 random(5);
    rows_ = toy::measured(state, random);
    write(rows_);
  }

  void write(const std::vector<Observation>& rows) { vielto::write_observations((folder_ / "t.csv").string(), rows); }
  // The toy has no rigs: those of the repository lend their scripts. Mixer tests only.
  void keep_mixer_checks() {
    rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                               [](const Observation& r) { return r.apparatus != "mixer" && r.role == Role::check; }),
                rows_.end());
    write(rows_);
  }
  int diagnose(const std::string& options = "") {
    return gap("diagnose t.csv --library library --draws 100 --out answer " + options);
  }
  // Exit 2, one line, nothing written.
  void expect_refusal(const std::string& part, const std::string& options = "") {
    EXPECT_EQ(diagnose(options), 2) << out_ << err_;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "answer")) << "a half-written answer";
  }
  void expect_refusal_of_rows(const std::function<void(std::vector<Observation>&)>& change, const std::string& part) {
    std::vector<Observation> rows = rows_;
    change(rows);
    write(rows);
    expect_refusal(part);
  }

  std::vector<Observation> rows_;
};

TEST_F(GapCommand, DiagnosesAKnownEffectAndWritesTheProtocolsKeys) {
  ASSERT_EQ(diagnose(), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  EXPECT_EQ(d["schema"], 1);
  EXPECT_EQ(d["verdict"], "named");
  EXPECT_EQ(d["named"], json({"cohesion"}));
  EXPECT_EQ(d["group"], json::array());
  double sum = 0;
  for (const auto& p : d["probabilities"]) sum += p.get<double>();
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_TRUE(d["probabilities"].contains("no_gap"));
  EXPECT_TRUE(d["probabilities"].contains("unknown"));
  EXPECT_TRUE(d["probabilities"].contains("cohesion+shape"));
  const json& s = d["strength"]["cohesion"];
  EXPECT_EQ(s["unit"], "Pa");
  EXPECT_LT(s["low90"], s["value"]);
  EXPECT_LT(s["value"], s["high90"]);
  EXPECT_EQ(d["effects"][0]["name"], "cohesion");
  EXPECT_TRUE(d["absorbable_by_recalibration"] >= 0 && d["absorbable_by_recalibration"] <= 1);
  for (const char* key : {"apparatus", "observable", "region", "z", "relative_gap", "q_value"})
    EXPECT_TRUE(d["where"][0].contains(key)) << key;
  EXPECT_TRUE(d["shrink"].is_null());  // nothing has been simulated again
  EXPECT_LT(d["shrink_predicted"]["after"], d["shrink_predicted"]["before"]);
  for (const char* key : {"versions", "hashes", "seeds", "commands"}) EXPECT_TRUE(d["provenance"].contains(key)) << key;
  // numbers hold together there by blanks that do not break
  const std::string page = std::regex_replace(content(folder_ / "answer/diagnosis.html"), std::regex("\u00a0"), " ");
  EXPECT_NE(page.find(d["sentence"].get<std::string>()), std::string::npos);
  for (const char* outside : {"src=\"http", "<link rel=\"stylesheet", "Beside this page"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;  // self-contained
  ASSERT_EQ(d["points"].size(), rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    EXPECT_EQ(d["points"][i]["test"], rows_[i].test);
    EXPECT_EQ(d["points"][i]["measured"]["value"], rows_[i].value);
    EXPECT_TRUE(d["points"][i].contains("after"));
  }
  EXPECT_TRUE(d["effects"][0].contains("gap_left"));
}

TEST_F(GapCommand, TheSameTableGivesTheSameAnswer) {
  ASSERT_EQ(diagnose(), 0) << err_;
  const std::string first = content(folder_ / "answer/diagnosis.json");
  ASSERT_EQ(diagnose(), 0) << err_;
  EXPECT_EQ(content(folder_ / "answer/diagnosis.json"), first);
}

TEST_F(GapCommand, NamesOfTestsDoNotMatter) {
  ASSERT_EQ(diagnose(), 0) << err_;
  const json first = json::parse(content(folder_ / "answer/diagnosis.json"));
  for (Observation& row : rows_) row.test = "x" + row.test;
  write(rows_);
  ASSERT_EQ(diagnose(), 0) << err_;
  EXPECT_EQ(json::parse(content(folder_ / "answer/diagnosis.json"))["probabilities"], first["probabilities"]);
}

TEST_F(GapCommand, WithoutCheckRowsItDiagnosesAndSaysThatTheShrinkCannotBeProved) {
  for (Observation& row : rows_) row.role = Role::fit;
  write(rows_);
  ASSERT_EQ(diagnose(), 0) << err_;
  EXPECT_NE(out_.find("cannot be proved"), std::string::npos) << out_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  EXPECT_TRUE(d["shrink"].is_null());
  EXPECT_TRUE(d["shrink_predicted"].is_null());
  EXPECT_EQ(d["named"], json({"cohesion"}));
}

TEST_F(GapCommand, RefusesTablesWithOneClearLine) {
  expect_refusal_of_rows(
      [](auto& r) {
        for (auto& row : r) row.role = Role::check;
      },
      "t.csv: holds no row of role fit");
  expect_refusal_of_rows(
      [](auto& r) {
        for (auto& row : r) row.material = "gravel";
      },
      "t.csv, line 2, column material: the library has no runs for 'gravel'");
  expect_refusal_of_rows(
      [](auto& r) {
        Observation d = r.back();
        d.test = "drum", d.apparatus = "drum";
        r.push_back(d);
      },
      "column observable: the library library lacks drum angle");
  expect_refusal_of_rows(
      [](auto& r) {
        Observation d = r.back();
        d.observable = "bulk_density", d.unit = "kg/m3";
        r.push_back(d);
      },
      "lacks repose bulk_density");
  expect_refusal_of_rows([](auto& r) { r[0].speed = r[1].speed = 3; },
                         "t.csv, line 2, column speed: 3 is outside the library's 0.45 to 1.7");
  expect_refusal_of_rows(
      [](auto& r) {
        r[0].fill.reset();
        r[1].fill.reset();
      },
      "column fill: is empty, but the library depends on it");
  expect_refusal_of_rows(
      [](auto& r) {
        for (auto& row : r)
          if (row.apparatus == "shearbox") row.normal_stress = 5000;
      },
      "column normal_stress: 5000 is outside the library, which has 19610 only");
  write(rows_);
  replace_in(folder_ / "t.csv", ",fit,mixer,power,", ",fit,mixer,power,nan");
  expect_refusal("column value: 'nan");
  write(rows_);
  replace_in(folder_ / "t.csv", ",W,", ",kW,");
  expect_refusal("column unit: 'kW' is not the unit of power");
  // u = 0 in the first row
  write(rows_);
  replace_in(folder_ / "t.csv", fmt::format("{},W", rows_[0].u), "0,W");
  expect_refusal("t.csv, line 2, column u: 0 is no standard uncertainty");
  write(rows_);
  // Three rows whose pairwise correlations are all -0.9 cannot be.
  std::string covariance = "test_a,observable_a,test_b,observable_b,covariance\n";
  for (const auto& [a, b] : {std::pair(0, 2), std::pair(0, 4), std::pair(2, 4)})
    covariance += fmt::format("{},power,{},power,{}\n", rows_[a].test, rows_[b].test, -0.9 * rows_[a].u * rows_[b].u);
  std::ofstream(folder_ / "covariance.csv") << covariance;
  expect_refusal("covariance.csv: is no covariance");
}

TEST_F(GapCommand, ExtrapolationIsFlaggedWhenItIsAllowed) {
  rows_[0].speed = rows_[1].speed = 1.8;
  write(rows_);
  ASSERT_EQ(diagnose("--extrapolate"), 0) << err_;
  EXPECT_NE(out_.find("extrapolated: line 2: speed 1.8 is outside the library's 0.45 to 1.7"), std::string::npos)
      << out_;
}

// The table with another value in its first row.
std::string impossible(std::string table, const std::string& value) {
  std::size_t from = table.find('\n');
  for (int comma = 0; comma < 4; ++comma) from = table.find(',', from + 1);
  return table.replace(from + 1, table.find(',', from + 1) - from - 1, value);
}

TEST_F(GapCommand, RefusesLibrariesWithOneClearLine) {
  const std::string design = content(folder_ / "library/design.csv");
  const auto with_design = [&](const std::string& from, const std::string& to, const std::string& part) {
    std::ofstream(folder_ / "library/design.csv") << design;
    replace_in(folder_ / "library/design.csv", from, to);
    expect_refusal(part);
  };
  with_design("none,0,1,", "none,1,1,", "column strength: is not 0 for the effect 'none'");
  with_design("cohesion,100,", "glue,20000,", "column effect: 'glue' has no file");
  with_design("cohesion,100,", "cohesion,2e9,", "column strength: 2000000000 is outside the prior range of cohesion");
  with_design("none,0,1,", "none,0,1.5,", "column seed: '1.5' is no seed");
  with_design("none,0,1,0", "none,0,1,x", "column run_hash: ");
  with_design("test,effect", "run,effect", "design.csv, line 1: has another header");
  // The second run's hash is the first's.
  const auto hash = [&](int line) {
    std::istringstream in(design);
    std::string text;
    for (int i = 0; i <= line; ++i) std::getline(in, text);
    return text.substr(text.find("none,0,1,") + 9, 64);
  };
  with_design(hash(2), hash(1), "column run_hash: is the run of line 2 again");
  std::ofstream(folder_ / "library/design.csv") << design;
  const std::string first = content(folder_ / "library/observations.csv");
  std::ofstream(folder_ / "library/observations.csv") << impossible(first, "-24");
  expect_refusal("observations.csv, line 2, column value: ");
  std::ofstream(folder_ / "library/observations.csv") << impossible(first, "0");
  expect_refusal("is 0; state a value above 0, or remove the run");
  std::ofstream(folder_ / "library/observations.csv") << first;
  replace_in(folder_ / "library/posterior.csv", "rollingResistance", "rollingFriction");
  expect_refusal("posterior.csv, line 1: names the parameters frictionAngle, rollingFriction");
  fs::remove(folder_ / "library/posterior.csv");
  std::ofstream(folder_ / "library/discrepancy.csv")
      << "apparatus,observable,sd,common,length,laws\nmixer,power,0.03,0.8,1,3\n";
  expect_refusal("discrepancy.csv: lacks");
  fs::remove_all(folder_ / "library");
  toy::write_library(folder_ / "library", toy::effects_with_runs(), 0, 7, true, 5);
  expect_refusal("has 5 seeds; run at least 6");
  fs::remove_all(folder_ / "library");
  expect_refusal("library: is no response library");
}

TEST_F(GapCommand, RefusesAStaleLibrary) {
  std::ofstream(folder_ / "in.rig") << "run 1\n";
  std::ofstream(folder_ / "library/inputs.csv") << "file,sha256\n../in.rig,"
                                                   "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855\n";
  expect_refusal("inputs.csv, line 2, column sha256: the library is stale: '../in.rig' has changed");
}

// Runs that were made when the effect changed something else do not stand for it.
TEST_F(GapCommand, RefusesALibraryOfAnotherEffect) {
  const auto with_changes = [&](const char* changes) {
    std::ofstream(folder_ / "library/effects.csv") << "effect,rig,changes\nwall_friction,mixer," << changes << "\n";
  };
  with_changes("wall_frictionAngle offset 2");
  EXPECT_EQ(diagnose(), 0) << err_;
  fs::remove_all(folder_ / "answer");
  with_changes("wall_frictionAngle offset 1");
  expect_refusal("effects.csv, line 2, column changes: the library is stale:");
}

TEST_F(GapCommand, RefusesEffectsAndSettingsWithOneClearLine) {
  const fs::path effect = folder_ / "effects/cohesion.toml";
  const std::string good = content(effect);
  const auto with_effect = [&](const std::string& from, const std::string& to, const std::string& part) {
    std::ofstream(effect) << good;
    replace_in(effect, from, to);
    expect_refusal(part);
  };
  with_effect("name = \"cohesion\"", "name = \"glue\"", "column name: 'glue' is not the file's name");
  with_effect("kind = \"dem\"", "kind = \"magic\"", "column kind: 'magic' is no kind");
  with_effect("prior_high = 300.0", "prior_high = \"many\"", "column prior_high: is not a finite number");
  with_effect("prior_low = 0.0", "prior_low = 1.0", "column prior_low: 1 is out of range");
  with_effect("unit = ", "units = ", "column units: is no key here");
  with_effect("rule = \"value\"", "rule = \"times\"", "column rule: 'times' is none of its values");
  with_effect("unit = \"Pa\"", "unit = ", "cohesion.toml, line 4");
  std::ofstream(effect) << good;
  replace_in(folder_ / "diagnosis.toml", "no_gap = 0.5", "no_gap = 0.6");
  expect_refusal("column prior: does not sum to 1");
}

TEST_F(GapCommand, RefusesUnknownNamesOnTheCommandLine) {
  expect_refusal("--without glue: is no effect", "--without glue");
  expect_refusal("--only colour=red: is no condition", "--only colour=red");
  expect_refusal("has no row left under --only", "--only wall=B");
}

// An observable that is nothing in the baseline has no size that effects could multiply by: the zero of an idle run.
TEST_F(GapCommand, ARowWhoseBaselineIsZeroTakesPartInThePairs) {
  std::ofstream(folder_ / "library/design.csv", std::ios::app)
      << fmt::format("bench_zero,none,0,1,{:064x},25,0.1\nbench_speed,none,0,1,{:064x},25,0.1\n", 999991, 999992);
  Observation zero;
  zero.test = "bench_zero";
  zero.role = Role::fit;
  zero.apparatus = "bench";
  zero.observable = "zero_drift";
  zero.unit = "W";
  zero.u = 1e-6;
  zero.speed = 1;
  Observation turns = zero;
  turns.test = "bench_speed";
  turns.observable = "shaft_speed";
  turns.unit = "1/s";
  turns.value = 1;
  vielto::write_observations((folder_ / "library/bench.csv").string(), {zero, turns});
  zero.value = -0.1;
  zero.u = 0.2;
  turns.u = 0.002;
  rows_.push_back(zero);
  rows_.push_back(turns);
  write(rows_);
  ASSERT_EQ(diagnose(), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  double sum = 0;
  for (const auto& [name, p] : d["probabilities"].items()) {
    ASSERT_TRUE(p.is_number()) << name;  // NaN would be null
    sum += p.get<double>();
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_TRUE(d["probabilities"].contains("cohesion+idle_drift")) << d["probabilities"];
  EXPECT_EQ(d["named"], json({"cohesion"}));
}

// At conditions no run was made for. The toy's power is 30 n^1.1 l/0.15 sqrt(friction/25) (rolling/0.1)^0.1.
TEST_F(GapCommand, PredictsWhatTheCalibratedSimulationSaysAndHowSureItIs) {
  ASSERT_EQ(gap("predict --library library --speed 1.0,0.6 --fill 0.2 --out p.csv"), 0) << err_;
  std::vector<double> logs;
  std::istringstream posterior(content(folder_ / "library/posterior.csv"));
  std::string line;
  std::getline(posterior, line);
  while (std::getline(posterior, line)) {
    double weight, friction, rolling;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &weight, &friction, &rolling), 3);
    logs.push_back(0.5 * std::log(friction / 25) + 0.1 * std::log(rolling / 0.1));
  }
  double mean = 0, variance = 0;
  for (const double x : logs) mean += x / static_cast<double>(logs.size());
  for (const double x : logs) variance += (x - mean) * (x - mean) / static_cast<double>(logs.size());

  std::istringstream table(content(folder_ / "p.csv"));
  std::getline(table, line);
  EXPECT_EQ(line,
            "apparatus,observable,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,card,value,u,low95,high95,"
            "u_emulator,u_calibration,u_contact_law");
  for (const double speed : {1.0, 0.6}) {
    ASSERT_TRUE(std::getline(table, line));
    double n, l, card, value, u, low, high, emulator, calibration, law;
    ASSERT_EQ(std::sscanf(line.c_str(), "mixer,power,W,%lf,%lf,,,,,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &n, &l, &card,
                          &value, &u, &low, &high, &emulator, &calibration, &law),
              10)
        << line;
    EXPECT_EQ(n, speed);
    const double truth = 30 * std::pow(speed, 1.1) * 0.2 / 0.15;
    EXPECT_LT(emulator / truth, 0.02);  // 72 runs of 2 % stand behind the baseline
    EXPECT_NEAR(card, truth, 3 * emulator);
    EXPECT_NEAR(std::log(value / card), mean, 3 * calibration / value);
    // the family's scatter, and the emulator's error of it: six members at 2 % noise are known to about 1 %
    EXPECT_GT(calibration / value, 0.7 * std::sqrt(variance));
    EXPECT_LT(calibration / value, std::hypot(1.3 * std::sqrt(variance), 0.01));
    EXPECT_NEAR(law / value, 0.03, 1e-4);  // write_discrepancy
    EXPECT_NEAR(u, std::sqrt(emulator * emulator + calibration * calibration + law * law), 1e-3 * u);
    EXPECT_NEAR(std::log(high / value), 1.96 * u / value, 1e-3);
    EXPECT_NEAR(std::log(value / low), 1.96 * u / value, 1e-3);
  }
  EXPECT_FALSE(std::getline(table, line));
  EXPECT_NE(out_.find("speed 1, fill 0.2: "), std::string::npos) << out_;

  ASSERT_EQ(gap("predict --library library --speed 3 --fill 0.2 --extrapolate"), 0) << err_;
  EXPECT_NE(out_.find("OUTSIDE"), std::string::npos) << out_;
  const std::vector<std::pair<std::string, std::string>> refused = {
      {"--speed 3 --fill 0.2 --out q.csv", "speed: 3 is outside the library's"},
      {"--fill 0.2 --out q.csv", "speed: is empty, but the library depends on it"},
      {"--observable angle --speed 1 --fill 0.2 --out q.csv", "is none of apparatus 'mixer'"},
      {"--apparatus drum --observable angle --tilt 0 --out q.csv", "drum"},
      {"--speed 1 --fill 0.2 --known nonsense=1 --out q.csv", "nonsense"}};
  for (const auto& [options, part] : refused) {
    EXPECT_EQ(gap("predict --library library " + options), 2) << options << out_;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "q.csv"));
  }
}

TEST_F(GapCommand, IsolabilityIsSealedAndItsThresholdIsTaken) {
  ASSERT_EQ(gap("isolability t.csv --library library --draws 100 --out sealed"), 0) << err_;
  const json i = json::parse(content(folder_ / "sealed/isolability.json"));
  EXPECT_GT(i["summary"]["cohesion"]["from_nothing"], 4);
  EXPECT_EQ(i["summary"]["cohesion"]["group"], json({"cohesion"}));
  EXPECT_LT(i["summary"]["cohesion"]["detectable_from"], 300);
  // every effect, from nothing and from every rival at the same strengths, 0 at 0
  for (const auto& [a, table] : i["at_strength"].items()) {
    const json& s = table["strengths"];
    ASSERT_TRUE(std::is_sorted(s.begin(), s.end())) << a;
    EXPECT_EQ(table["from_nothing"].size(), s.size());
    EXPECT_EQ(table["from_rival"].size(), i["effects"].size() - 1);
    for (std::size_t k = 0; k < s.size(); ++k)
      for (const auto& [b, distances] : table["from_rival"].items()) {
        ASSERT_EQ(distances.size(), s.size()) << a << " " << b;
        // from the nearest strength of a rival is at most from nothing, which counts the shape error in
        EXPECT_LE(distances[k].get<double>(), table["from_nothing"][k].get<double>() + 1e-9) << a << " " << b;
        if (s[k] == 0.0) {
          EXPECT_EQ(distances[k], 0.0);
        }
      }
  }
  EXPECT_EQ(content(folder_ / "sealed/isolability.svg").rfind("<svg", 0), 0u);
  // Values do not matter, conditions and u do.
  for (Observation& row : rows_) row.value *= 1.3;
  write(rows_);
  ASSERT_EQ(diagnose("--sealed sealed/isolability.json"), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  EXPECT_EQ(d["log_odds"]["threshold"], i["threshold"]["log_odds"]);
  fs::remove_all(folder_ / "answer");
  // nor do correlations stay unseen, nor a threshold of few draws
  std::ofstream(folder_ / "covariance.csv")
      << "test_a,observable_a,test_b,observable_b,covariance\n"
      << fmt::format("{},power,{},power,{}\n", rows_[0].test, rows_[2].test, 0.5 * rows_[0].u * rows_[2].u);
  expect_refusal("was sealed for other rows, u, correlations", "--sealed sealed/isolability.json");
  fs::remove(folder_ / "covariance.csv");
  ASSERT_EQ(gap("diagnose t.csv --library library --out answer --sealed sealed/isolability.json"), 0) << err_;
  EXPECT_NE(out_.find("note: the threshold rests on 100 draws, not on the settings' 1000"), std::string::npos) << out_;
  fs::remove_all(folder_ / "answer");
  rows_[0].u *= 2;
  write(rows_);
  expect_refusal("was sealed for other rows", "--sealed sealed/isolability.json");
  replace_in(folder_ / "sealed/isolability.json", "\"schema\": 2", "\"schema\": 3");
  expect_refusal("is not what its seal says", "--sealed sealed/isolability.json");
}

TEST_F(GapCommand, DiscrepancyFromDevelopmentLaws) {
  std::string tables;
  for (const double law : {-1.0, 0.5, 1.5}) {
    toy::State state;
    state.law = law;
    std::mt19937_64 random(static_cast<unsigned>(law * 10 + 50));
    const std::string name = fmt::format("law{}.csv", law);
    vielto::write_observations((folder_ / name).string(), toy::measured(state, random));
    tables += name + " ";
  }
  ASSERT_EQ(gap("discrepancy " + tables + "--library library --out found.csv"), 0) << err_;
  const std::string found = content(folder_ / "found.csv");
  EXPECT_EQ(found.rfind("apparatus,observable,sd,common,length,laws\n", 0), 0u);
  // The toy's laws differ in power by 3 % times n^0.4 times (-1, 0.5, 1.5): root mean square 3.3 %. Three laws give the
  // sd to a factor of about two, and upwards.
  const auto at = found.find("mixer,power,");
  ASSERT_NE(at, std::string::npos) << found;
  const double sd = std::stod(found.substr(at + 12));
  EXPECT_GT(sd, 0.02);
  EXPECT_LT(sd, 0.10);
}

// What isolability.csv says is told apart at the best strength of each effect: from nothing beyond 4, from a rival
// beyond 3.
int told_apart_in(const fs::path& table) {
  std::istringstream lines(content(table));
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = cells_of(line);
  std::map<std::pair<std::string, std::string>, double> farthest;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    for (std::size_t k = 2; k < cells.size(); ++k) {
      if (k == 3 || cells[k].empty()) continue;  // the group; the effect itself
      double& most = farthest[{cells[0], header[k]}];
      most = std::max(most, std::stod(cells[k]));
    }
  }
  int told = 0;
  for (const auto& [pair, distance] : farthest) told += distance > (pair.second == "from_nothing" ? 4 : 3);
  return told;
}

struct Step {
  std::string test;
  double hours, all_hours;
  int told;
};

std::vector<Step> steps_of(const fs::path& table) {
  std::vector<Step> steps;
  std::istringstream lines(content(table));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    steps.push_back({cells[1], std::stod(cells[2]), std::stod(cells[3]), std::stoi(cells[4])});
  }
  return steps;
}

// The same counts by way of `isolability`, of tables to which the tests' rows are added by hand.
TEST_F(GapCommand, ProgrammeGrowsByWhatTellsMostApartAnHour) {
  const auto all = rows_;
  const auto only = [&](const auto& wanted) {
    std::vector<Observation> rows;
    std::copy_if(all.begin(), all.end(), std::back_inserter(rows), wanted);
    return rows;
  };
  rows_ = only([](const Observation& r) { return r.test == "mixer_l0.1_n0.5" && r.observable == "power"; });
  std::vector<Observation> heap = only([](const Observation& r) { return r.apparatus == "repose"; });
  std::vector<Observation> shear = only([](const Observation& r) { return r.test == "shear_v0.02"; });
  ASSERT_EQ(rows_.size() * heap.size() * shear.size(), 1u);
  heap[0].u = 0.4;
  shear[0].u = 200;
  std::ofstream(folder_ / "tests.toml")
      << "[[test]]\nname = \"heap\"\napparatus = \"repose\"\nhow = \"slowly, with care\"\nhours = 1\n"
         "row = [{observable = \"angle\", u = 0.4}]\n"
         "[[test]]\nname = \"heap_of_many\"\napparatus = \"repose\"\nhow = \"often\"\nhours = 900\n"
         "row = [{observable = \"angle\", u = 0.3}]\n"
         "[[test]]\nname = \"shear\"\napparatus = \"shearbox\"\nhow = \"once\"\nhours = 0.25\n"
         "row = [{observable = \"shear_stress_steady\", normal_stress = 19610, shear_velocity = 0.02, u = 200}]\n"
         "[[test]]\nname = \"no_drum\"\napparatus = \"drum\"\nhow = \"look\"\nhours = 1\nspeed = 1\nfill = 0.5\ntilt = "
         "0\n"
         "row = [{observable = \"angle\", u = 1}]\n";
  const auto told_with = [&](const std::vector<Observation>& one, const std::vector<Observation>& two) {
    std::vector<Observation> rows = rows_;
    rows.insert(rows.end(), one.begin(), one.end());
    rows.insert(rows.end(), two.begin(), two.end());
    write(rows);
    EXPECT_EQ(gap("isolability t.csv --library library --draws 20 --out i"), 0) << err_;
    return told_apart_in(folder_ / "i/isolability.csv");
  };
  const int none = told_with({}, {}), with_shear = told_with(shear, {}), with_heap = told_with(heap, {});
  const int both = told_with(shear, heap);
  ASSERT_GT(with_shear - none, 0);
  ASSERT_GT(both, with_shear);
  ASSERT_GT((with_shear - none) / 0.25, with_heap - none) << "the shear test is the better for an hour";

  write(rows_);
  ASSERT_EQ(gap("programme t.csv --library library --draws 20 --candidates tests.toml --out p.csv"), 0) << err_;
  const std::vector<Step> steps = steps_of(folder_ / "p.csv");
  ASSERT_GE(steps.size(), 3u);
  EXPECT_EQ(steps[0].told, none);
  EXPECT_EQ(steps[1].test, "shear");
  EXPECT_EQ(steps[1].told, with_shear);
  EXPECT_EQ(steps[2].test, "heap");
  EXPECT_EQ(steps[2].told, both);
  EXPECT_DOUBLE_EQ(steps[2].all_hours, 1.25);
  EXPECT_NE(out_.find("left out: no_drum"), std::string::npos) << out_;
  EXPECT_NE(content(folder_ / "p.csv").find("slowly; with care"), std::string::npos);
}

TEST_F(GapCommand, ProgrammeRefusesTestsThatItCannotRead) {
  std::ofstream(folder_ / "tests.toml")
      << "[[test]]\nname = \"a\"\napparatus = \"bench\"\nhow = \"with care\"\nhours = 1\n"
         "row = [{observable = \"wall_angle\", u = 0.7, fil = 0.1}]\n";
  EXPECT_EQ(gap("programme t.csv --library library --draws 20 --candidates tests.toml --out p.csv"), 2);
  expect_one_line("fil");
  EXPECT_FALSE(fs::exists(folder_ / "p.csv"));
}

TEST_F(GapCommand, NextTestRanksByGainPerHour) {
  ASSERT_EQ(gap("next t.csv --library library --draws 100"), 0) << err_;
  EXPECT_NE(out_.find("sd an hour"), std::string::npos);
  EXPECT_NE(out_.find("mixer_slow_low"), std::string::npos) << out_;
}

// A power that goes with another exponent of the speed than anything in the library explains: without the losses of the
// drive, which bend the trend that way.
TEST_F(GapCommand, NextTestOfAnUnknownGapMakesItStandOut) {
  for (const char* drive : {"motor_copper", "worm_gear"})
    ASSERT_TRUE(fs::remove(folder_ / "effects" / (std::string(drive) + ".toml")));
  for (Observation& row : rows_)
    if (row.observable == "power") row.value *= 2.5 * std::pow(*row.speed, -1.5);
  write(rows_);
  ASSERT_EQ(gap("next t.csv --library library --draws 100"), 0) << err_;
  EXPECT_NE(out_.find("none of the effects in the library"), std::string::npos) << out_;
  EXPECT_NE(out_.find("the gap from none"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("from cohesion"), std::string::npos) << out_;
}

TEST_F(GapCommand, ConfirmPrintsTheCommandsOfEveryCheckTest) {
  keep_mixer_checks();
  ASSERT_EQ(gap("confirm t.csv --library library --draws 100 --out answer --root " VIELTO_SOURCE_DIR), 0) << err_;
  EXPECT_FALSE(fs::exists(folder_ / "answer"));
  // Three check tests, four variants.
  EXPECT_EQ(std::count(out_.begin(), out_.end(), '\n'), 12) << out_;
  std::istringstream lines(out_);
  int with_effect = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_NE(line.find("liggghts -in in.mixer -var speed "), std::string::npos) << line;
    EXPECT_NE(line.find("vielto post"), std::string::npos) << line;
    const bool after = line.find("-after-s1") != std::string::npos;
    EXPECT_EQ(line.find("-var cohesion adhesion") != std::string::npos, after) << line;
    EXPECT_EQ(line.find("-var frictionAngle") != std::string::npos, line.find("-before-") == std::string::npos) << line;
    with_effect += after;
  }
  EXPECT_EQ(with_effect, 3);
}

// The names of a test go into a run folder's name, and no further.
TEST_F(GapCommand, ConfirmHandsNoTestsNameToAShell) {
  keep_mixer_checks();
  for (Observation& row : rows_)
    if (row.role == Role::check) row.test += fmt::format(";touch {};b it's 7", (folder_ / "touched").string());
  write(rows_);
  fs::create_directory(folder_ / "bin");
  std::ofstream(folder_ / "bin/liggghts")
      << "#!/bin/sh\nprintf '%s|' \"$@\" >>" << (folder_ / "seen.txt").string() << "\nexit 1\n";
  fs::permissions(folder_ / "bin/liggghts", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", ((folder_ / "bin").string() + ":" + path).c_str(), 1);
  const std::string confirm = "confirm t.csv --library library --draws 100 --out answer --root " VIELTO_SOURCE_DIR;
  EXPECT_EQ(gap(confirm + " --run"), 1) << out_;
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(err_.find("a run failed, see "), std::string::npos) << err_;
  EXPECT_FALSE(fs::exists(folder_ / "touched"));
  const std::string seen = content(folder_ / "seen.txt");
  EXPECT_EQ(seen.rfind("-in|in.mixer|-var|speed|", 0), 0u) << seen;
  EXPECT_NE(seen.find("|-var|run|" + (folder_ / "answer/runs").string() + "/"), std::string::npos) << seen;
  EXPECT_EQ(seen.find("touch "), std::string::npos) << seen;
  fs::remove_all(folder_ / "answer");
  // LIGGGHTS itself would split a path at its blanks
  EXPECT_EQ(gap(confirm + " --runs 'my runs'"), 2) << out_;
  expect_one_line("my runs: has a blank");
}

// Runs have the settings of the library's own; further ones must be known.
TEST_F(GapCommand, ConfirmRunsWhatTheLibraryIsMadeOf) {
  keep_mixer_checks();
  const std::string confirm = "confirm t.csv --library library --draws 100 --out answer --root " VIELTO_SOURCE_DIR;
  ASSERT_EQ(gap(confirm), 0) << err_;
  EXPECT_EQ(out_.find("-var grainDiameter"), std::string::npos) << out_;
  EXPECT_NE(err_.find("note: the library has no plan.toml"), std::string::npos) << err_;
  std::ofstream(folder_ / "library/plan.toml")
      << "seeds = 6\n[[rig]]\nname = \"mixer\"\nsettings = {grainDiameter = \"0.012\", turns = \"5\"}\n"
         "[[rig]]\nname = \"repose\"\nsettings = {base = \"rough\"}\n";
  for (const auto& [options, expected] :
       {std::pair("", "-var turns 5 "), std::pair(" --var turns=14", "-var turns 14 ")}) {
    ASSERT_EQ(gap(confirm + options), 0) << err_;
    EXPECT_EQ(err_.find("plan.toml"), std::string::npos) << err_;
    std::istringstream lines(out_);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_NE(line.find("-var grainDiameter 0.012 "), std::string::npos) << line;
      EXPECT_NE(line.find(expected), std::string::npos) << line;
      EXPECT_EQ(line.find("-var base "), std::string::npos) << line;
    }
  }
  for (const auto& [setting, part] : {std::pair("turn=3", "--var turn=3: is no parameter"),
                                      std::pair("grainDiameter=big", "--var grainDiameter=big: is no number")}) {
    EXPECT_EQ(gap(confirm + " --var " + setting), 2) << out_;
    expect_one_line(part);
  }
}

// A bench row is simulated by no rig: nothing would be measured.
TEST_F(GapCommand, ConfirmWantsACheckRowThatCanBeSimulated) {
  for (Observation& row : rows_) row.role = Role::fit;
  Observation bench = rows_[0];
  bench.test = "plate", bench.role = Role::check, bench.apparatus = "bench", bench.observable = "restitution",
  bench.unit = "1";
  bench.value = 0.6, bench.u = 0.03;
  bench.speed.reset(), bench.fill.reset();
  rows_.push_back(bench);
  write(rows_);
  EXPECT_EQ(gap("confirm t.csv --library library --draws 100 --out answer --run --root " VIELTO_SOURCE_DIR), 2) << out_;
  EXPECT_FALSE(fs::exists(folder_ / "answer"));
}

TEST_F(GapCommand, AConditionThatTheLibraryDoesNotKnowIsTold) {
  for (Observation& row : rows_) row.moisture = 0.3;
  rows_[0].tilt = rows_[1].tilt = 45;
  rows_[0].wall = rows_[1].wall = "rubber";
  write(rows_);
  ASSERT_EQ(diagnose(), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  const std::string notes = d["notes"].dump();
  for (const char* note :
       {"mixer power: moisture 0.3 is not accounted for", "mixer power: tilt 45 is not accounted for",
        "mixer power: wall 'rubber' is not accounted for", "repose angle: moisture 0.3 is not"})
    EXPECT_NE(notes.find(note), std::string::npos) << note << "\n" << notes;
  EXPECT_NE(content(folder_ / "answer/diagnosis.html").find("moisture 0.3 is not accounted for"), std::string::npos);
  ASSERT_EQ(diagnose("--ignore moisture,tilt,wall"), 0) << err_;
  EXPECT_EQ(out_.find("accounted for"), std::string::npos) << out_;
  ASSERT_EQ(gap("predict --library library --speed 1 --fill 0.2 --moisture 0.3"), 0) << err_;
  EXPECT_NE(out_.find("moisture 0.3 is not accounted for"), std::string::npos) << out_;
}

TEST_F(GapCommand, RefusesFilesThatAreNoTables) {
  const std::string table = content(folder_ / "t.csv");
  std::ofstream(folder_ / "t.csv", std::ios::binary) << "\xEF\xBB\xBF" << table;
  expect_refusal("t.csv, line 1: begins with a byte-order mark");
  std::ofstream(folder_ / "t.csv", std::ios::trunc) << "";
  expect_refusal("t.csv: is empty");
  fs::remove(folder_ / "t.csv");
  fs::create_directory(folder_ / "t.csv");
  expect_refusal("t.csv: is a folder");
  fs::remove(folder_ / "t.csv");
  write(rows_);
  replace_in(folder_ / "t.csv", fmt::format(",{},W", rows_[0].u), ",1e-320,W");
  expect_refusal("t.csv, line 2, column u: ");
  write(rows_);
  EXPECT_EQ(gap("diagnose t.csv --library nolib --out answer"), 2);
  expect_one_line("nolib: is no response library");
}

// Said before the work, and nothing is left behind.
TEST_F(GapCommand, RefusesAPlaceThatCannotBeWritten) {
  std::ofstream(folder_ / "file") << "a file";
  EXPECT_EQ(gap("diagnose t.csv --library library --draws 100 --out file/answer"), 2);
  expect_one_line("file: is no folder");
  fs::create_directories(folder_ / "answer/diagnosis.html");
  EXPECT_EQ(diagnose(), 2);
  expect_one_line("diagnosis.html: is a folder");
  EXPECT_FALSE(fs::exists(folder_ / "answer/diagnosis.json"));
}

TEST_F(GapCommand, RefusesOptionsThatMeanNothing) {
  for (const char* options : {"--ignore colour", "--ignore wall,foo", "--runs-per-observation nan", "--seed -1"})
    EXPECT_EQ(diagnose(options), 2) << options;
  expect_refusal("--only wall: states no value", "--only wall");
  EXPECT_EQ(gap("predict --library library --speed nan --fill 0.2"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "answer"));
}

// A new effect is one file in the folder of effects: nothing else has to know of it.
TEST_F(GapCommand, AnEffectIsOneFile) {
  std::ofstream(folder_ / "effects/worn_belt.toml") << R"(# A belt that slips more at speed: what is read is too small.
name = "worn_belt"
kind = "measurement"
unit = "1"
prior_low = -0.4
prior_high = 0.0
source = "made up for this test"
[[apply.transform]]
apparatus = "mixer"
observable = "power"
operation = "scale"
factor = 1.0
power_of = {speed = 1.0}
reference = {speed = 1.0}
)";
  toy::State state;
  std::mt19937_64 random(9);
  rows_ = toy::measured(state, random);
  for (Observation& row : rows_)
    if (row.observable == "power") row.value *= 1 - 0.25 * *row.speed;
  write(rows_);
  ASSERT_EQ(diagnose(), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  EXPECT_EQ(d["named"], json({"worn_belt"})) << out_;
  EXPECT_NEAR(d["strength"]["worn_belt"]["value"].get<double>(), -0.25, 0.05);
  EXPECT_NE(content(folder_ / "answer/diagnosis.html").find("worn_belt"), std::string::npos);
}

// What cannot be checked is said; a family that was cut short is refused.
TEST_F(GapCommand, ALibrarySaysWhetherItIsWhole) {
  ASSERT_EQ(diagnose(), 0) << err_;
  EXPECT_NE(out_.find("note: the library has no inputs.csv"), std::string::npos) << out_;
  fs::remove_all(folder_ / "answer");
  const std::string posterior = content(folder_ / "library/posterior.csv");
  const std::string list = fmt::format(
      "cd '{}/library' && printf 'file,sha256\\nposterior.csv,%s\\n' $(sha256sum posterior.csv | cut -d ' ' -f 1) > "
      "inputs.csv",
      folder_.string());
  ASSERT_EQ(std::system(list.c_str()), 0);
  ASSERT_EQ(diagnose(), 0) << err_;
  EXPECT_EQ(out_.find("inputs.csv"), std::string::npos) << out_;
  fs::remove_all(folder_ / "answer");
  std::ofstream(folder_ / "library/posterior.csv")
      << posterior.substr(0, posterior.find('\n', posterior.size() / 2) + 1);
  expect_refusal("inputs.csv, line 2, column sha256: the library is stale: 'posterior.csv'");
  std::ofstream(folder_ / "library/posterior.csv") << posterior;
  std::ofstream(folder_ / "library/discrepancy.csv", std::ios::app) << "mixer,power,0.5,0.8,1,3\n";
  expect_refusal("discrepancy.csv, line 6, column observable: mixer power is stated twice");
}

// A known effect is in every run, and no candidate; bad statements of it are refused.
TEST_F(GapCommand, AKnownEffectIsInEveryRun) {
  keep_mixer_checks();
  ASSERT_EQ(gap("confirm t.csv --library library --draws 100 --known shape=0.2 --out answer --root " VIELTO_SOURCE_DIR),
            0)
      << err_;
  std::istringstream lines(out_);
  int runs = 0;
  for (std::string line; std::getline(lines, line); ++runs)
    EXPECT_NE(line.find("-var twistingResistance "), std::string::npos) << line;
  EXPECT_GE(runs, 6) << out_;
  ASSERT_EQ(diagnose("--known cohesion=200"), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  EXPECT_FALSE(d["probabilities"].contains("cohesion"));
  EXPECT_EQ(d["provenance"]["known"], json({{"cohesion", 200.0}}));
  EXPECT_NE(out_.find("note: cohesion at strength 200 is part of the baseline"), std::string::npos) << out_;
  fs::remove_all(folder_ / "answer");
  expect_refusal("--known glue: is no effect", "--known glue=1");
  expect_refusal("--known cohesion: states no strength", "--known cohesion");
  expect_refusal("--known cohesion=much: states no strength", "--known cohesion=much");
  expect_refusal("--known cohesion: 900 is outside its range of 0 to 300", "--known cohesion=900");
  expect_refusal("--known cohesion=20: is stated twice", "--known cohesion=10 --known cohesion=20");
  expect_refusal("--known cohesion=20: is named by --without too", "--known cohesion=20 --without cohesion");
  expect_refusal("--known soft_grain: the library has no runs with it", "--known soft_grain=0.5");
  // a switch is there wholly or not
  replace_in(folder_ / "effects/shape.toml", "rule = \"offset\"\nfactor = 1.0", "rule = \"switch\"\nword = \"0.5\"");
  EXPECT_EQ(gap("confirm t.csv --library library --draws 100 --known shape=0.2 --out answer --root " VIELTO_SOURCE_DIR),
            2);
  expect_one_line("--known shape: is a switch");
}

// Replicates are one run: a fourth check test under the conditions of another needs none of its own.
TEST_F(GapCommand, ConfirmRunsEqualConditionsOnce) {
  keep_mixer_checks();
  const auto check =
      std::find_if(rows_.begin(), rows_.end(), [](const Observation& r) { return r.role == Role::check; });
  ASSERT_NE(check, rows_.end());
  Observation replicate = *check;
  replicate.test = "replicate";
  rows_.push_back(replicate);
  write(rows_);
  ASSERT_EQ(gap("confirm t.csv --library library --draws 100 --out answer --root " VIELTO_SOURCE_DIR), 0) << err_;
  EXPECT_EQ(std::count(out_.begin(), out_.end(), '\n'), 12) << out_;
  EXPECT_EQ(out_.find("replicate"), std::string::npos) << out_;
}

// A run folder that is there counts only if it was made by the planned command and from the files that are there now.
TEST_F(GapCommand, ConfirmRefusesARunOfAnotherStrengthOrOfOtherFiles) {
  keep_mixer_checks();
  const std::string confirm =
      "confirm t.csv --library library --draws 100 --out answer --runs runs --root " VIELTO_SOURCE_DIR;
  ASSERT_EQ(gap(confirm), 0) << err_;
  // The first run as planned, and the same of another strength or fill: the command as the rig records it.
  const auto begin = out_.find("liggghts"), end = out_.find(" && vielto post");
  ASSERT_NE(end, std::string::npos) << out_;
  const std::string planned = out_.substr(begin, end - begin);
  const auto run_at = planned.find("-var run ") + 9;
  const std::string name = fs::path(planned.substr(run_at, planned.find(' ', run_at) - run_at)).filename();
  const auto record = [&](const std::string& state, const std::string& command, const json& hashes) {
    fs::remove_all(folder_ / "runs");
    fs::create_directories(folder_ / "runs" / (name + state));
    std::ofstream(folder_ / "runs" / (name + state) / "run.json") << json({{"command", command}, {"hashes", hashes}});
  };
  std::string other = planned;
  other.replace(other.find("-var speed ") + 11, 4, "0.11");
  for (const char* state : {"", ".partial"}) {
    record(state, other, json::object());
    EXPECT_EQ(gap(confirm + " --run"), 2) << out_ << err_;
    expect_one_line("made by another command");
    record(state, planned + (*state ? " -var resume yes" : ""), {{"in.mixer", std::string(64, '0')}});
    EXPECT_EQ(gap(confirm + " --run"), 2) << out_ << err_;
    expect_one_line("made from another in.mixer");
    EXPECT_FALSE(fs::exists(folder_ / "answer")) << "a half-written answer";
    EXPECT_TRUE(fs::exists(folder_ / "runs" / (name + state) / "run.json")) << "nothing is lost";
    std::ofstream(folder_ / "runs" / (name + state) / "run.json") << "[]";
    EXPECT_EQ(gap(confirm + " --run"), 2) << out_ << err_;
    expect_one_line("is no JSON object");
  }
}

// An effect that starts from a baseline value starts from the one that --var states, and every -var is stated once:
// LIGGGHTS takes the first of two.
TEST_F(GapCommand, ConfirmTakesAnEffectFromTheStatedSetting) {
  toy::State state;
  state.effects["wall_friction"] = 10;
  std::mt19937_64 random(6);
  rows_ = toy::measured(state, random);
  keep_mixer_checks();
  ASSERT_EQ(gap("confirm t.csv --library library --draws 100 --out answer --var wall_frictionAngle=40 "
                "--root " VIELTO_SOURCE_DIR),
            0)
      << err_;
  std::istringstream lines(out_);
  int with_effect = 0;
  const std::string var = "-var wall_frictionAngle ";
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(var);
    ASSERT_NE(at, std::string::npos) << line;
    EXPECT_EQ(line.find(var, at + 1), std::string::npos) << line;
    const double angle = std::stod(line.substr(at + var.size()));
    if (line.find("-before-s1") != std::string::npos) {
      EXPECT_EQ(angle, 40) << line;
    }
    if (line.find("-after-s1") == std::string::npos) continue;
    EXPECT_NEAR(angle, 60, 6) << line;  // 40 + 2 x 10, the strength to its estimate
    ++with_effect;
  }
  EXPECT_EQ(with_effect, 3) << out_;
}

}  // namespace

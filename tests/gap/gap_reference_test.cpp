// SPDX-License-Identifier: GPL-2.0-or-later
// A reference state: the conditional normal distribution against its closed form, and `vielto gap
// diagnose --reference` on toy laws (gap_toy.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/bad_input.h"
#include "gap/emulator/reference.h"
#include "gap/question/question.h"
#include "gap/verdict/diagnosis.h"
#include "gap_folder.h"
#include "gap_toy.h"

namespace {

namespace fs = std::filesystem;
using namespace vielto::gap;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using nlohmann::json;
using vielto::Observation;
using vielto::Role;
using vielto_test::content;

Settings settings() { return Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml"); }

MatrixXd random_covariance(Eigen::Index n, std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal;
  MatrixXd a(n, n);
  for (double& x : a.reshaped()) x = normal(random);
  return size * a * a.transpose();
}

// n rows around 10, multiplying where `relative`.
TableModel random_model(Eigen::Index n, bool relative, bool shared_noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  TableModel m;
  m.rows.resize(static_cast<std::size_t>(n));
  for (Observation& row : m.rows) row.apparatus = "mixer", row.observable = "power";
  m.baseline = VectorXd::Constant(n, 10) + VectorXd::LinSpaced(n, 0, 3);
  m.observed = m.baseline;
  m.scale = m.baseline;
  m.relative = VectorXd::Constant(n, relative);
  m.logarithmic = VectorXd::Zero(n);
  m.noise =
      shared_noise ? random_covariance(n, random, 0.02) : MatrixXd(VectorXd::LinSpaced(n, 0.02, 0.05).asDiagonal());
  m.seed = 0.04 * MatrixXd::Identity(n, n);
  m.emulator = random_covariance(n, random, 0.01);
  m.discrepancy = random_covariance(n, random, 0.05);
  m.reference = MatrixXd::Zero(n, n);
  m.shape_correlation = MatrixXd::Identity(n, n);
  m.family_weights = VectorXd::Constant(7, 1.0 / 7);
  m.family_members.resize(n, 7);
  for (double& x : m.family_members.reshaped()) x = 0.5 * normal(random);
  m.family_shift = m.family_members * m.family_weights;
  const MatrixXd centred = m.family_members.colwise() - m.family_shift;
  m.family = centred * m.family_weights.asDiagonal() * centred.transpose() + random_covariance(n, random, 0.01);
  return m;
}

// Whatever the covariances are: mean and covariance of y1 given y0 of the joint normal distribution.
TEST(GapReference, IsTheConditionalDistribution) {
  std::mt19937_64 random(4);
  for (const bool relative : {false, true})
    for (const bool shared_noise : {false, true}) {
      const TableModel joint = random_model(5, relative, shared_noise, random);
      const TableModel logs = joint.in_logarithms(TableModel::Values::placeholders);
      VectorXd y0(2);
      y0 << 11.5, 9;
      const VectorXd x0 = relative ? VectorXd(y0.array().log()) : y0;
      const MatrixXd c = logs.null_covariance();
      const MatrixXd w = c.bottomLeftCorner(3, 2) * c.topLeftCorner(2, 2).inverse();
      const VectorXd mean = logs.baseline + logs.family_shift;
      const VectorXd expected = mean.tail(3) + w * (x0 - mean.head(2));
      const MatrixXd covariance = c.bottomRightCorner(3, 3) - w * c.topRightCorner(2, 3);
      const TableModel given =
          given_reference(joint, y0, 0, settings()).in_logarithms(TableModel::Values::placeholders);
      EXPECT_LT((given.baseline + given.family_shift - expected).norm(), 1e-12) << relative << shared_noise;
      MatrixXd noise = covariance;  // u stays what it is in watts: over the new f
      if (relative && !shared_noise)
        for (int i = 0; i < 3; ++i)
          noise(i, i) +=
              joint.noise(i + 2, i + 2) * (std::exp(-2 * given.baseline[i]) - std::exp(-2 * logs.baseline[i + 2]));
      EXPECT_LT((given.null_covariance() - noise).norm(), 1e-11) << relative << shared_noise;
      for (const UncertaintySource& source : kUncertaintySources)
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(given.*source.part).eigenvalues()[0], -1e-12) << source.name;
    }
}

// K = [[a, a], [a, a]], a reference known without error: nothing of K is left; transfer t leaves t a.
TEST(GapReference, ExactReferenceCancelsWhatBothShare) {
  std::mt19937_64 random(1);
  TableModel joint = random_model(2, false, false, random);
  joint.family.setZero();
  joint.family_members.setZero();
  joint.family_shift.setZero();
  joint.emulator.setZero();
  joint.discrepancy.setConstant(0.25);
  joint.noise = MatrixXd(VectorXd(VectorXd::Constant(2, 1e-12)).asDiagonal());
  joint.seed.setZero();
  const VectorXd y0 = VectorXd::Constant(1, 10.7);
  const TableModel given = given_reference(joint, y0, 0, settings());
  EXPECT_NEAR(given.baseline[0], 13 + 0.7, 1e-9);
  EXPECT_NEAR(given.null_covariance()(0, 0), 0, 1e-9);
  EXPECT_NEAR(given_reference(joint, y0, 0.3, settings()).null_covariance()(0, 0), 0.3 * 0.25, 1e-9);
}

// Two groups of three and two values about 10 and 20 by hand, with and without shared errors.
// A gauge that reads 0.09 where the card says 0.05, u = 0.01, and an effect that moves it by up to A = 0.2: of two
// states y1 given y0 is f + A^2/(A^2 + u^2) (y0 - f), its variance A^2 u^2/(A^2 + u^2) + u^2. Of one state alone the
// card stands.
TEST(GapReference, ABenchRowOfBothStatesShowsTheChangeOfTheReading) {
  const double u = 0.01, A = 0.2;
  TableModel joint;
  joint.rows.resize(2);
  for (Observation& row : joint.rows) row.apparatus = "bench", row.observable = "grain_spread";
  joint.baseline = joint.observed = VectorXd::Constant(2, 0.05);
  joint.family_shift = joint.relative = joint.logarithmic = VectorXd::Zero(2);
  joint.scale = VectorXd::Constant(2, 0.05);
  joint.noise = u * u * MatrixXd::Identity(2, 2);
  joint.seed = joint.emulator = joint.discrepancy = joint.reference = joint.family = MatrixXd::Zero(2, 2);
  joint.shape_correlation = MatrixXd::Identity(2, 2);
  joint.family_members.resize(2, 0);
  EffectResponse effect;
  effect.name = "size_spread", effect.kind = EffectKind::dem, effect.high = 0.2;
  effect.strengths = VectorXd::LinSpaced(2, 0, 0.2);
  effect.mean = MatrixXd::Zero(2, 2);
  effect.mean.col(1).setConstant(A);
  effect.covariance.assign(2, MatrixXd::Zero(2, 2));
  joint.effects = {effect};
  const VectorXd reading = VectorXd::Constant(1, 0.09);
  const TableModel changed = given_reference(joint, reading, 0, settings());
  const double w = A * A / (A * A + u * u);
  EXPECT_NEAR(changed.baseline[0], 0.05 + w * 0.04, 1e-12);
  EXPECT_NEAR(changed.null_covariance()(0, 0), w * u * u + u * u, 1e-12);
  EXPECT_GT(reference_probability(joint, reading), 0.5);  // 4 u from the card, but within what a machine may be off by

  joint.rows[1].speed = 1;  // another place: nothing is shared
  EXPECT_NEAR(given_reference(joint, reading, 0, settings()).baseline[0], 0.05, 1e-12);
  EXPECT_LT(reference_probability(joint, reading), 1e-4);
}

class GapReferenceState : public vielto_test::GapFolder {
 protected:
  void SetUp() override {
    GapFolder::SetUp();
    toy::write_library(folder_ / "library", toy::effects_with_runs(), 0, 7);
    toy::write_discrepancy(folder_ / "library", 3);
    state_.law = 3;  // a law far from the library's
  }

  // Every test `times` times, runs scatter by `scatter` times the library's seeds.
  void write(const char* name, const toy::State& state, int times, double scatter, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Observation> rows;
    for (int k = 0; k < times; ++k)
      for (Observation row : toy::rows({0.5, 1.0, 1.5}, {0.1, 0.25}, {0.001, 0.02})) {
        const double truth = toy::value(row, state);
        row.u = 0.005 * truth;
        row.value = truth * std::exp(scatter * toy::seed_noise(row) * normal(random)) + row.u * normal(random);
        row.test += fmt::format("_r{}", k);
        rows.push_back(row);
      }
    vielto::write_observations((folder_ / name).string(), rows);
  }
  int diagnose(const std::string& options) {
    fs::remove_all(folder_ / "answer");
    return gap("diagnose changed.csv --library library --draws 100 --out answer " + options);
  }
  json answer() const { return json::parse(content(folder_ / "answer/diagnosis.json")); }

  toy::State state_;
};

// Half the effect that the absolute question needs is named, by its strength, and both answers are given.
TEST_F(GapReferenceState, NamesWhatHasChanged) {
  write("dry.csv", state_, 3, 1, 1);
  state_.effects["cohesion"] = 60;
  write("changed.csv", state_, 3, 1, 2);
  ASSERT_EQ(diagnose("--reference dry.csv"), 0) << err_;
  const json d = answer();
  EXPECT_EQ(d["named"], json({"cohesion"})) << out_;
  EXPECT_EQ(out_.rfind("Something has changed, explained by cohesion", 0), 0u) << out_;
  EXPECT_NE(out_.find("\nWithout the reference: "), std::string::npos) << out_;
  EXPECT_TRUE(d["why_it_is_off"]["probabilities"].contains("soft_grain") ||
              d["why_it_is_off"]["probabilities"].contains("sensor_gain"));
  EXPECT_FALSE(d["probabilities"].contains("coarse_grain"));
  EXPECT_EQ(d["reference"]["table"], "dry.csv");
  EXPECT_EQ(d["reference"]["scatter"].size(), 4u);
  for (const json& x : d["reference"]["scatter"])
    if (x["apparatus"] == "mixer") {
      EXPECT_FALSE(x["assumed"]) << x;
    }
  const std::string page = content(folder_ / "answer/diagnosis.html");
  EXPECT_NE(page.find("Something has changed"), std::string::npos);
  EXPECT_NE(page.find("Without the reference"), std::string::npos);

  // the same answer alone
  ASSERT_EQ(diagnose("--reference dry.csv --change-only"), 0) << err_;
  const json alone = answer();
  EXPECT_FALSE(alone.contains("why_it_is_off"));
  EXPECT_EQ(out_.find("Without the reference"), std::string::npos) << out_;
  EXPECT_EQ(alone["probabilities"], d["probabilities"]);
  EXPECT_NE(diagnose("--change-only"), 0);
}

// The 90 % interval of the strength holds the truth in 90 % of fresh tables: 5 of 8 or fewer would be one in two
// hundred.
TEST_F(GapReferenceState, StrengthIsAsSureAsItSays) {
  int covered = 0;
  std::string intervals;
  for (unsigned k = 0; k < 8; ++k) {
    toy::State state;
    state.law = 3;
    write("dry.csv", state, 3, 1, 100 + 2 * k);
    state.effects["cohesion"] = 60;
    write("changed.csv", state, 3, 1, 101 + 2 * k);
    ASSERT_EQ(diagnose("--reference dry.csv"), 0) << err_;
    const json s = answer()["strength"]["cohesion"];
    if (s.is_null()) continue;
    covered += s["low90"] <= 60.0 && s["high90"] >= 60.0;
    intervals += fmt::format("{:.0f} ({:.0f} to {:.0f}), ", s["value"].get<double>(), s["low90"].get<double>(),
                             s["high90"].get<double>());
  }
  EXPECT_GE(covered, 6) << intervals;
}

// The law is off and nothing has changed; runs scatter three times as much as the library's. From repeats that is
// known. Taken from the library (one run for each value, --runs-per-observation 1 without repeats would assume it) it
// alarms.
TEST_F(GapReferenceState, NothingHasChangedThoughRunsScatterMore) {
  int alarms = 0, tables = 0;
  for (unsigned seed = 10; seed < 20; seed += 2, ++tables) {
    write("dry.csv", state_, 3, 3, seed);
    write("changed.csv", state_, 3, 3, seed + 1);
    ASSERT_EQ(diagnose("--reference dry.csv"), 0) << err_;
    alarms += answer()["verdict"] != "no_gap";
    if (seed == 10) {
      const json scatter = answer()["reference"]["scatter"];
      for (const json& x : scatter)
        if (x["observable"] == "power") {
          // 3 x 2 % with 24 degrees of freedom: known to 1/sqrt(48) = 14 %, and 8 % wider for that
          EXPECT_EQ(x["degrees_of_freedom"], 24);
          EXPECT_NEAR(x["sd"].get<double>(), 0.06 * 1.08, 3 * 0.14 * 0.06);
        }
    }
  }
  // 1 % each: two of five have a probability of 0.1 %
  EXPECT_LE(alarms, 1) << "of " << tables;
}

// Repeats that scatter five times as much as the library's runs are no gap, also without a reference.
TEST_F(GapReferenceState, RepeatsThatScatterMoreAreNoGapByThemselves) {
  write("changed.csv", toy::State(), 3, 5, 4);
  ASSERT_EQ(diagnose(""), 0) << err_;
  EXPECT_EQ(answer()["verdict"], "no_gap") << out_;
  EXPECT_NE(out_.find("note: mixer power: one run scatters by"), std::string::npos) << out_;
}

TEST_F(GapReferenceState, WithoutRepeatsItSaysWhatIsAssumedAndWhatItCosts) {
  write("dry.csv", state_, 1, 1, 1);
  write("changed.csv", state_, 1, 1, 2);
  ASSERT_EQ(diagnose("--reference dry.csv"), 0) << err_;
  EXPECT_EQ(answer()["verdict"], "no_gap");
  EXPECT_NE(out_.find("note: mixer power: no test is repeated, so that the scatter of a run is not known"),
            std::string::npos)
      << out_;
  EXPECT_NE(out_.find("hides changes below"), std::string::npos) << out_;
}

TEST_F(GapReferenceState, TheSealIsForThePair) {
  write("dry.csv", state_, 3, 1, 1);
  write("changed.csv", state_, 3, 1, 2);
  ASSERT_EQ(gap("isolability changed.csv --library library --draws 100 --reference dry.csv --out sealed"), 0) << err_;
  const json pair = json::parse(content(folder_ / "sealed/isolability.json"));
  ASSERT_EQ(gap("isolability changed.csv --library library --draws 100 --out alone"), 0) << err_;
  const json alone = json::parse(content(folder_ / "alone/isolability.json"));
  EXPECT_GT(pair["summary"]["sensor_gain"]["from_nothing"].get<double>(),
            1.5 * alone["summary"]["sensor_gain"]["from_nothing"].get<double>());
  EXPECT_FALSE(pair["summary"].contains("coarse_grain"));
  EXPECT_EQ(diagnose("--reference dry.csv --sealed sealed/isolability.json"), 0) << err_;
  EXPECT_EQ(diagnose("--sealed sealed/isolability.json"), 2) << out_;
  expect_one_line("was sealed for other rows");
  EXPECT_EQ(diagnose("--reference dry.csv --transfer 0.5 --sealed sealed/isolability.json"), 2) << out_;
  expect_one_line("was sealed for other rows");
  write("dry.csv", state_, 3, 1, 3);
  EXPECT_EQ(diagnose("--reference dry.csv --sealed sealed/isolability.json"), 2) << out_;
  expect_one_line("was sealed for other rows");
}

// One table may hold both states: rows are told apart by --only and --reference-only.
TEST_F(GapReferenceState, OneTableWithBothStates) {
  write("dry.csv", state_, 3, 1, 1);
  state_.effects["cohesion"] = 100;
  write("changed.csv", state_, 3, 1, 2);
  std::vector<Observation> both = vielto::read_observations((folder_ / "dry.csv").string());
  for (Observation& row : both) row.test += "_dry", row.moisture = 0.1;
  for (Observation row : vielto::read_observations((folder_ / "changed.csv").string())) {
    row.moisture = 0.2;
    both.push_back(row);
  }
  vielto::write_observations((folder_ / "changed.csv").string(), both);
  ASSERT_EQ(diagnose("--only moisture=0.2 --reference changed.csv --reference-only moisture=0.1 --ignore moisture"), 0)
      << err_;
  EXPECT_EQ(answer()["named"], json({"cohesion"})) << out_;
  EXPECT_EQ(diagnose("--only moisture=0.2 --reference changed.csv --ignore moisture"), 2) << out_;
  expect_one_line("belongs to the reference and to what has changed");
  // a mean that was taken of both states and is stated for each
  Observation& first = both.front();
  Observation& last = both[both.size() / 2];
  ASSERT_NE(first.moisture, last.moisture);
  last.value = first.value, last.u = first.u;
  vielto::write_observations((folder_ / "changed.csv").string(), both);
  std::ofstream(folder_ / "changed.covariance.csv")
      << "test_a,observable_a,test_b,observable_b,covariance\n"
      << fmt::format("{},{},{},{},{:.17g}\n", first.test, first.observable, last.test, last.observable,
                     std::pow(vielto::read_observations((folder_ / "changed.csv").string()).front().u, 2));
  EXPECT_EQ(diagnose("--only moisture=0.2 --reference changed.csv --reference-only moisture=0.1 --ignore moisture"), 2)
      << out_;
  expect_one_line("one measurement stated for both states shows no change");
}

TEST_F(GapReferenceState, RefusesWhatIsNoReference) {
  write("dry.csv", state_, 2, 1, 1);
  write("changed.csv", state_, 2, 1, 2);
  std::vector<Observation> rows = vielto::read_observations((folder_ / "dry.csv").string());
  const auto refused = [&](const std::function<void(std::vector<Observation>&)>& change, const std::string& part,
                           const std::string& options = "") {
    std::vector<Observation> other = rows;
    change(other);
    vielto::write_observations((folder_ / "other.csv").string(), other);
    EXPECT_EQ(diagnose("--reference other.csv " + options), 2) << out_;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "answer"));
  };
  refused(
      [](auto& r) {
        for (auto& row : r) row.value *= row.observable == "power" ? 5 : 1;
      },
      "other.csv: is not of the machine that the model is validated for");
  refused(
      [](auto& r) {
        for (auto& row : r)
          if (row.fill) row.fill = 0.9;
      },
      "other.csv, line 2, column fill: 0.9");
  refused(
      [](auto& r) {
        for (auto& row : r) row.material = "sand";
      },
      "other.csv, line 2, column material");
  std::vector<Observation> mixer = vielto::read_observations((folder_ / "changed.csv").string());
  mixer.erase(std::remove_if(mixer.begin(), mixer.end(), [](const auto& r) { return r.apparatus != "mixer"; }),
              mixer.end());
  vielto::write_observations((folder_ / "changed.csv").string(), mixer);
  refused(
      [](auto& r) {
        r.erase(std::remove_if(r.begin(), r.end(), [](const auto& row) { return row.apparatus == "mixer"; }), r.end());
      },
      "other.csv: measures nothing that changed.csv measures");
  EXPECT_EQ(diagnose("--transfer 0.5"), 2);
  EXPECT_EQ(diagnose("--reference nowhere.csv"), 2);
  expect_one_line("nowhere.csv");
}

}  // namespace

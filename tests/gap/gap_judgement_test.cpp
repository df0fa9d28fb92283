// SPDX-License-Identifier: GPL-2.0-or-later
// From probabilities to a verdict, and what stands beside it: shrink, sensitivity, sentence. Each against numbers
// worked out by hand for tables of a few rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.h"
#include "gap/verdict/diagnosis.h"
#include "gap_table.h"

namespace {

using namespace vielto::gap;

using Names = std::vector<std::string>;

// Name ("no_gap", "unknown", "a", "a+b") and probability, least probable first.
std::vector<ModelEvidence> models_of(const std::vector<std::pair<std::string, double>>& probabilities) {
  std::vector<ModelEvidence> models;
  for (const auto& [name, probability] : probabilities) {
    ModelEvidence m;
    m.probability = probability;
    m.unknown = name == "unknown";
    if (name.size() < 4) m.effects = {name.substr(0, 1)};
    if (name.size() == 3) m.effects.push_back(name.substr(2));
    m.posterior = {{std::vector<double>(m.effects.size(), 0.5), 1}};
    models.push_back(m);
  }
  std::sort(models.begin(), models.end(), [](const auto& a, const auto& b) { return a.probability < b.probability; });
  return models;
}

// Four effects that show nowhere; rows that no gap explains well or not.
TableModel of_nothing(const VectorXd& y) {
  std::vector<EffectResponse> effects;
  for (const char* name : {"a", "b", "c", "d"}) effects.push_back(effect(name, VectorXd::Zero(y.size()), 0, 1));
  return table(y, 1, effects);
}

TEST(GapJudgement, NamesWhatMostOfTheRivalsProbabilityIsOf) {
  const TableModel m = of_nothing(vector({10, 10, 10}));
  const Settings settings = round_settings();
  const auto judge = [&](const std::vector<std::pair<std::string, double>>& probabilities, bool gap = true) {
    std::vector<ModelEvidence> models = models_of(probabilities);
    return judged(m, models, gap, settings);
  };
  // of rivals of 0.7, 0.57 are more than 0.8 and 0.55 are less
  const Judgement named = judge({{"no_gap", 0.3}, {"a", 0.57}, {"b", 0.06}, {"unknown", 0.07}});
  EXPECT_EQ(named.verdict, Verdict::named);
  EXPECT_EQ(named.named, Names{"a"});
  EXPECT_EQ(named.fit.all, 1);
  EXPECT_EQ(judge({{"no_gap", 0.3}, {"a", 0.55}, {"b", 0.08}, {"unknown", 0.07}}).verdict, Verdict::ambiguous);
  EXPECT_EQ(judge({{"no_gap", 0.3}, {"a+b", 0.57}, {"b", 0.06}, {"unknown", 0.07}}).named, (Names{"a", "b"}));
  // half of 0.7 is 0.35
  EXPECT_EQ(judge({{"no_gap", 0.3}, {"a", 0.3}, {"unknown", 0.4}}).verdict, Verdict::unknown);
  EXPECT_EQ(judge({{"no_gap", 0.3}, {"a", 0.4}, {"unknown", 0.3}}).verdict, Verdict::ambiguous);
  EXPECT_EQ(judge({{"no_gap", 0.3}, {"unknown", 0.7}}).verdict, Verdict::unknown);
  EXPECT_EQ(judge({{"no_gap", 0.3}, {"a", 0.7}}, false).verdict, Verdict::no_gap);
  // most probable first
  std::vector<ModelEvidence> models = models_of({{"no_gap", 0.3}, {"a", 0.1}, {"b", 0.6}});
  judged(m, models, false, settings);
  EXPECT_EQ(models[0].name() + models[1].name() + models[2].name(), "bno_gapa");
}

// With its pairs an effect has 0.62 of the rivals' 0.72; more probable than any pair itself, it is named.
TEST(GapJudgement, NamesAnEffectThatIsInAllProbablePairs) {
  const TableModel m = of_nothing(vector({10, 10, 10}));
  const auto judge = [&](double alone, double with_b) {
    auto models = models_of({{"no_gap", 0.28},
                             {"a", alone},
                             {"a+b", with_b},
                             {"a+c", 0.12},
                             {"b", 0.05},
                             {"unknown", 0.55 - alone - with_b}});
    return judged(m, models, true, round_settings());
  };
  EXPECT_EQ(judge(0.3, 0.2).named, Names{"a"});
  EXPECT_EQ(judge(0.2, 0.3).verdict, Verdict::ambiguous);
  EXPECT_EQ(judge(0.26, 0.18).verdict, Verdict::ambiguous);  // 0.56 of 0.72
}

// Singles of 0.67 together: the likeliest that hold 0.9 of them, 0.603, are a, b and c.
TEST(GapJudgement, AGroupHoldsMostOfTheSinglesProbability) {
  const TableModel m = of_nothing(vector({10, 10, 10}));
  auto models = models_of({{"no_gap", 0.2},
                           {"a", 0.3},
                           {"b", 0.25},
                           {"c", 0.1},
                           {"d", 0.02},
                           {"a+b", 0.03},
                           {"c+d", 0.02},
                           {"unknown", 0.08}});
  const Judgement v = judged(m, models, true, round_settings());
  EXPECT_EQ(v.verdict, Verdict::ambiguous);
  EXPECT_EQ(v.group, (Names{"a", "b", "c"}));
}

TEST(GapJudgement, ANameMustExplainTheTable) {
  const Settings settings = round_settings();
  auto models = models_of({{"no_gap", 0.1}, {"a", 0.9}});
  // 4 off with a standard deviation of 1
  EXPECT_EQ(judged(of_nothing(vector({14, 10, 10})), models, true, settings).verdict, Verdict::unknown);
  TableModel m = of_nothing(vector({13.6, 10, 10, 10, 10, 10, 10, 10}));
  EXPECT_EQ(judged(m, models, true, settings).verdict, Verdict::named);  // eight rows of one observable
  m.rows[0].observable = "angle";                                        // a row of its own: 2 x 3.2e-4
  EXPECT_EQ(judged(m, models, true, settings).verdict, Verdict::unknown);
}

TEST(GapJudgement, AppliesWhatIsNamedOrTheBestOfAGroup) {
  Diagnosis d;
  d.models = models_of({{"a", 0.6}, {"a+b", 0.4}});
  d.named = {"a", "b"};
  d.group = {"c", "d"};
  d.verdict = Verdict::named;
  EXPECT_EQ(d.applied(), (Names{"a", "b"}));
  d.verdict = Verdict::ambiguous;
  EXPECT_EQ(d.applied(), Names{"c"});
  for (const Verdict nothing : {Verdict::no_gap, Verdict::unknown}) {
    d.verdict = nothing;
    EXPECT_TRUE(d.applied().empty());
  }
  EXPECT_EQ(d.model("a+b")->probability, 0.4);
  EXPECT_EQ(d.model("c"), nullptr);
}

// The family's variance of 3 beside one of 1: 3/4 of a gap are its shift, and of its square 1/16 is left.
TEST(GapJudgement, WhatTheFamilyCanDoIsAbsorbable) {
  TableModel m = table(vector({10}), 1);
  m.family(0, 0) = 3;
  EXPECT_NEAR(absorbable_part(m, vector({2})), 1 - 1.0 / 16, 1e-12);
  EXPECT_EQ(absorbable_part(m, vector({0})), 0);
}

// Members 1 below and 3 above f with weights of 1/4 and 3/4, parameters 1 and 5. With the effect's 2 the row is off by
// 0.5 from f: by 1.5 and by -2.5 from the members, whose own scatter (3) is not in the variance (1 and 0.5).
TEST(GapJudgement, TheFamilyIsCalibratedAnew) {
  TableModel m = table(vector({12.5}), 1, {effect("a", vector({2}), 0, 2)});
  m.family_members = MatrixXd(1, 2);
  m.family_members << -1, 3;
  m.family_weights = vector({0.25, 0.75});
  m.family_shift = m.family_members * m.family_weights;
  m.family(0, 0) = 3 + 0.5;
  m.family_parameters = vector({1, 5});
  const auto expected = [](double off) {
    const double log_ratio = std::log(3) - (off - 3) * (off - 3) / 3 + (off + 1) * (off + 1) / 3;
    const double second = 1 / (1 + std::exp(-log_ratio));
    return 1 + 4 * second;
  };
  EXPECT_NEAR(recalibrated_parameters(m, {"a"}, {1})[0], expected(0.5), 1e-12);
  m.observed[0] = 12 - 80;  // so far off that no double holds a likelihood
  EXPECT_NEAR(recalibrated_parameters(m, {"a"}, {1})[0], expected(-80), 1e-12);
}

// Every effect at this distance from nothing and from every other at this strength; a group ends at 3.
Isolability all_apart(const std::vector<std::string>& effects, double strength, double distance) {
  Isolability isolability;
  isolability.effects = effects;
  isolability.group_distance = 3;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    StrengthTable t;
    t.strengths = {0, strength};
    t.from_nothing = {0, distance};
    t.from_rival.assign(effects.size(), {0, distance});
    t.from_rival[e].clear();
    isolability.tables.push_back(t);
  }
  return isolability;
}

// b can stand in for a (distance 2), c cannot (9).
TEST(GapJudgement, APlaceboIsTheBestEffectFromOutside) {
  Isolability isolability = all_apart({"a", "b", "c", "d"}, 1, 9);
  isolability.tables[0].from_rival[1] = {0, 2};
  Diagnosis d;
  d.verdict = Verdict::named;
  d.named = {"a"};
  d.strengths = {{"a", "1", {1, 0.5, 1.5}}};
  d.models = models_of({{"a+b", 0.5}, {"unknown", 0.2}, {"a", 0.1}, {"b", 0.05}, {"c", 0.04}, {"d", 0.03}});
  std::reverse(d.models.begin(), d.models.end());
  EXPECT_EQ(placebo_of(d, isolability)->name(), "c");
  d.group = {"c"};
  EXPECT_EQ(placebo_of(d, isolability)->name(), "d");
  d.group = {"c", "d"};
  EXPECT_EQ(placebo_of(d, isolability), nullptr);
}

// Two tests measured to 2 %: gaps of 20, 15, 10 and 18 % and, of the last, of 1 %, which is less than the noise.
TEST(GapJudgement, AShrinkIsOfGapsWithoutTheNoise) {
  const CheckRows rows{vector({10, 20}), vector({0.04, 0.16}).asDiagonal(), {"s", "t"}};
  const auto simulated = [](double factor) {
    return SimulatedRows{vector({10 * factor, 20 * factor}), VectorXd::Zero(2)};
  };
  const Shrink s = shrink_of(rows, simulated(1.2), simulated(1.15), simulated(0.9), simulated(1.18));
  EXPECT_EQ(s.tests, 2);
  EXPECT_NEAR(s.before2, 0.04 - 0.0004, 1e-12);
  EXPECT_NEAR(s.before, std::sqrt(0.0396), 1e-12);
  EXPECT_NEAR(s.recalibrated, std::sqrt(0.0225 - 0.0004), 1e-12);
  EXPECT_NEAR(s.after, std::sqrt(0.01 - 0.0004), 1e-12);
  EXPECT_NEAR(s.placebo, std::sqrt(0.0324 - 0.0004), 1e-12);
  EXPECT_NEAR(s.closed.value, 1 - std::sqrt(0.0096 / 0.0396), 1e-12);
  const Shrink all = shrink_of(rows, simulated(1.2), simulated(1.2), simulated(1.01), simulated(1.2));
  EXPECT_NEAR(all.after2, 0.0001 - 0.0004, 1e-12);
  EXPECT_EQ(all.after, 0);
  EXPECT_EQ(all.closed.value, 1);
  EXPECT_EQ(shrink_of(rows, simulated(1.01), simulated(1), simulated(1.2), simulated(1)).closed.value, 0);
}

// The interval's ends are numbers 201 and 3800 of 4000 draws in order. Each draw adds to every row's gap the
// measurement's error, the same before and after, and the simulation's, takes out the variance of both, and from five
// tests on draws the tests too.
TEST(GapJudgement, AShrinksIntervalIsOfRedrawnErrorsAndTests) {
  const double u = 0.02, own = 0.01;
  for (const std::size_t n : {4, 12}) {
    CheckRows rows{VectorXd::Constant(static_cast<Eigen::Index>(n), 10), MatrixXd(), {}};
    rows.noise = u * u * 100 * MatrixXd::Identity(rows.observed.size(), rows.observed.size());
    SimulatedRows before{rows.observed, VectorXd::Constant(rows.observed.size(), 10 * own)}, after = before;
    std::vector<double> g[2];
    for (std::size_t i = 0; i < n; ++i) {
      rows.tests.push_back(std::string(1, static_cast<char>('a' + i)));
      g[0].push_back(0.2 + 0.01 * static_cast<double>(i * i % 7));
      g[1].push_back(0.1 - 0.007 * static_cast<double>(i * i % 5));
      before.value[static_cast<Eigen::Index>(i)] = 10 * (1 + g[0][i]);
      after.value[static_cast<Eigen::Index>(i)] = 10 * (1 + g[1][i]);
    }
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::uniform_int_distribution<std::size_t> pick(0, n - 1);
    std::vector<double> closed;
    for (int b = 0; b < 4000; ++b) {
      std::vector<double> error(n), square[2];
      for (double& e : error) e = u * normal(random);
      for (int k = 0; k < 2; ++k)
        for (std::size_t i = 0; i < n; ++i) {
          const double ratio = 1 + g[k][i], gap = g[k][i] - ratio * error[i] + own * normal(random);
          square[k].push_back(gap * gap - u * u - ratio * ratio * u * u - own * own);
        }
      double sum[2] = {};
      for (std::size_t t = 0; t < n; ++t) {
        const std::size_t i = n < 5 ? t : pick(random);
        for (int k = 0; k < 2; ++k) sum[k] += square[k][i];
      }
      closed.push_back(1 - std::sqrt(std::max(0.0, sum[1]) / sum[0]));
    }
    std::sort(closed.begin(), closed.end());
    const Shrink s = shrink_of(rows, before, before, after, before);
    EXPECT_NEAR(s.closed.low90, closed[200], 1e-12) << n;
    EXPECT_NEAR(s.closed.high90, closed[3799], 1e-12) << n;
    EXPECT_LT(s.closed.low90, s.closed.value);
    EXPECT_GT(s.closed.high90, s.closed.value);
  }
}

// A row to fit and one to check, family covariance [4 2; 2 3] about 0.5 and 0.25. What the fit row (noise 1) leaves of
// its gap moves the check row by 2/5 of it.
TEST(GapJudgement, AShrinkIsPredictedByTheFirstOrder) {
  TableModel m = table(
      vector({14.5, 13}), 1,
      {effect("a", vector({2, 1}), 0, 4), effect("b", vector({1, -1}), 0, 4), effect("c", vector({0, 0.5}), 0, 4)});
  m.rows[1].role = vielto::Role::check;
  m.rows[1].test = "check";
  m.family << 4, 2, 2, 3;
  m.family_shift << 0.5, 0.25;
  m.family_weights = vector({1});
  m.family_members = m.family_shift;
  m.emulator(1, 1) = 0.09;
  const Isolability isolability = all_apart({"a", "b", "c"}, 4, 90);
  Diagnosis d;
  d.verdict = Verdict::named;
  d.named = {"a"};
  d.strengths = {{"a", "1", {1.5, 1, 2}}};
  d.models = models_of({{"a", 0.6}, {"a+b", 0.2}, {"c", 0.1}, {"b", 0.05}});
  for (ModelEvidence& e : d.models) e.posterior = {{std::vector<double>(e.effects.size(), 1.5), 1}};
  std::reverse(d.models.begin(), d.models.end());
  const double noise = 1.0 / 169, rest = 14.5 - 10.5;
  const auto square = [&](double simulated) { return std::pow(simulated / 13 - 1, 2) - noise; };
  Shrink s = *predicted_shrink(m, d, isolability);
  EXPECT_EQ(s.tests, 1);
  EXPECT_NEAR(s.before2, square(10), 1e-12);
  EXPECT_NEAR(s.recalibrated2, square(10.25 + 0.4 * rest), 1e-12);
  EXPECT_NEAR(s.after2, square(10.25 + 1.5 + 0.4 * (rest - 3)), 1e-12);
  EXPECT_EQ(s.placebo_name, "c");
  EXPECT_NEAR(s.placebo2, square(10.25 + 0.75 + 0.4 * rest), 1e-12);
  // both, at 1.5: 3 + 1.5 in the row to fit, 1.5 - 1.5 in the other
  d.named = {"a", "b"};
  d.strengths.push_back({"b", "1", {1.5, 1, 2}});
  s = *predicted_shrink(m, d, isolability);
  EXPECT_NEAR(s.after2, square(10.25 + 0.4 * (rest - 4.5)), 1e-12);
  // without a family there is nothing to calibrate; without a row of check or a cause nothing to predict
  m.family_weights.resize(0);
  EXPECT_NEAR(predicted_shrink(m, d, isolability)->recalibrated2, square(10), 1e-12);
  m.observed[1] = 0;
  EXPECT_FALSE(predicted_shrink(m, d, isolability));
  m.observed[1] = 13;
  m.rows[1].role = vielto::Role::fit;
  EXPECT_FALSE(predicted_shrink(m, d, isolability));
  m.rows[1].role = vielto::Role::check;
  d.verdict = Verdict::unknown;
  EXPECT_FALSE(predicted_shrink(m, d, isolability));
}

// Three rows to fit and one to check. a raises the first two, b the third; the family and the contact law are
// uncertain.
TableModel of_two_effects(const VectorXd& off) {
  TableModel m = table(VectorXd::Constant(4, 10), 0.01,
                       {effect("a", vector({1, 1, 0, 1}), 0, 4), effect("b", vector({0, 0, 1, 0}), 0, 4),
                        effect("c", vector({-1, 1, 0, 0}), 0, 4)});
  m.observed.head(3) += off;
  m.rows[3].role = vielto::Role::check;
  m.rows[2].observable = "angle";
  for (EffectResponse& e : m.effects) e.unit = "1", e.shape_error = 0.05;
  m.discrepancy = 0.01 * MatrixXd::Identity(4, 4);
  m.family = MatrixXd::Constant(4, 4, 0.02);
  m.family_shift.setConstant(0.1);
  return m;
}

Diagnosis diagnosed(const TableModel& m, double threshold, const Settings& settings = round_settings()) {
  Threshold t;
  t.log_odds = threshold;
  return diagnose(m, t, settings);
}

TEST(GapJudgement, ADiagnosisIsOfItsFitRows) {
  const Diagnosis one = diagnosed(of_two_effects(vector({2, 2.1, 0.1})), 3);
  EXPECT_EQ(one.fit_rows, 3);
  EXPECT_EQ(one.check_rows, 1);
  ASSERT_EQ(one.verdict, Verdict::named);
  EXPECT_EQ(one.named, Names{"a"});
  ASSERT_EQ(one.strengths.size(), 1u);
  EXPECT_EQ(one.strengths[0].name, "a");
  EXPECT_NEAR(one.strengths[0].interval.value, 1.95, 0.2);
  // absorbable: of the effect's shift at its strength, by the family's formula
  const TableModel fit = of_two_effects(vector({2, 2.1, 0.1})).part({0, 1, 2});
  const double s = one.strengths[0].interval.value;
  EXPECT_NEAR(one.absorbable, absorbable_part(fit, vector({s, s, 0})), 1e-12);

  const Diagnosis two = diagnosed(of_two_effects(vector({2, 2.1, 3})), 3);
  ASSERT_EQ(two.verdict, Verdict::named);
  EXPECT_EQ(two.named, (Names{"a", "b"}));
  ASSERT_EQ(two.strengths.size(), 2u);
  EXPECT_EQ(two.strengths[1].name, "b");
  EXPECT_NEAR(two.strengths[1].interval.value, 2.9, 0.2);
  EXPECT_NEAR(two.absorbable,
              absorbable_part(fit, vector({two.strengths[0].interval.value, two.strengths[0].interval.value,
                                           two.strengths[1].interval.value})),
              1e-12);

  TableModel alike = of_two_effects(vector({2, 2, 0.1}));
  alike.effects[1].mean = alike.effects[0].mean;
  const Diagnosis group = diagnosed(alike, 3);
  ASSERT_EQ(group.verdict, Verdict::ambiguous);
  EXPECT_EQ(group.group.size(), 2u);
  EXPECT_EQ(group.strengths.size(), 2u);
  const auto json = diagnosis_json(one, {});
  EXPECT_EQ(json["effects"].size(), 3u);
  EXPECT_EQ(json["probabilities"].size(), 8u);
}

// By the odds, or because no gap leaves too much: in all rows together (four observables each 2.3 standard deviations
// off, one by itself no rarity) or in one observable.
TEST(GapJudgement, AGapIsShownByOddsOrByMisfit) {
  EXPECT_EQ(diagnosed(of_two_effects(vector({0.1, 0.1, 0.1})), 3).verdict, Verdict::no_gap);
  const TableModel clear = of_two_effects(vector({2, 2.1, 0.1}));
  EXPECT_EQ(diagnosed(clear, 1e6).verdict, Verdict::named);  // by its misfit
  Settings lenient = round_settings();
  lenient.misfit_probability = 0;
  EXPECT_EQ(diagnosed(clear, 1e6, lenient).verdict, Verdict::no_gap);
  EXPECT_EQ(diagnosed(clear, 3, lenient).verdict, Verdict::named);  // by its odds

  TableModel m = of_nothing(vector({12.3, 12.3, 12.3, 12.3}));
  const char* names[] = {"power", "torque_ripple", "angle", "restitution"};
  for (std::size_t i = 0; i < 4; ++i) m.rows[i].observable = names[i];
  const double z = 2.3, one = 2 * 0.5 * std::erfc(z / std::sqrt(2.0));
  const Fit none = fit_of(m, ModelEvidence());
  EXPECT_NEAR(none.worst, 4 * one, 1e-9);
  ASSERT_LT(none.all, 0.01);
  ASSERT_GT(none.worst, 0.01);
  EXPECT_NE(diagnosed(m, 1e6).verdict, Verdict::no_gap);
  m = of_nothing(vector({13.1, 10, 10, 10, 10, 10, 10, 10}));  // two observables, one 3.1 off
  m.rows[0].observable = "angle";
  ASSERT_GT(fit_of(m, ModelEvidence()).all, 0.01);
  ASSERT_LT(fit_of(m, ModelEvidence()).worst, 0.01);
  EXPECT_NE(diagnosed(m, 1e6).verdict, Verdict::no_gap);
}

// Each assumption changed by hand, and the evidence worked out anew.
TEST(GapJudgement, SensitivityIsTheVerdictUnderOtherAssumptions) {
  const TableModel m = of_two_effects(vector({0.8, 0.55, 0.45}));
  Settings settings = round_settings();
  const Diagnosis d = diagnosed(m, 1, settings);
  const TableModel fit = m.part({0, 1, 2});
  const auto check = [&](const std::string& change, const TableModel& changed, const Settings& other) {
    double rivals = 0;
    const auto models = all_evidence(changed, other);
    const ModelEvidence* top = nullptr;
    for (const ModelEvidence& e : models) {
      if (e.name() == "no_gap") continue;
      rivals += e.probability;
      if (!top || e.probability > top->probability) top = &e;
    }
    const auto found = std::find_if(d.sensitivity.begin(), d.sensitivity.end(),
                                    [&](const Sensitivity& s) { return s.change == change; });
    ASSERT_NE(found, d.sensitivity.end()) << change;
    EXPECT_EQ(found->top, top->name()) << change;
    EXPECT_NEAR(found->probability, top->probability / rivals, 1e-9) << change;
  };
  EXPECT_EQ(d.sensitivity.size(), 7u);
  Settings other = settings;
  other.prior_unknown = 0.3;
  check("unknown three times as probable", fit, other);
  other = settings;
  other.prior_pair = 0.3;
  check("pairs three times as probable", fit, other);
  TableModel changed = fit;
  for (EffectResponse& e : changed.effects) e.low = 0, e.high = 2;
  check("half the prior range of every strength", changed, settings);
  for (const auto& [change, error] : std::map<std::string, double>{{"0.8", 0.04}, {"1.2", 0.06}}) {
    changed = fit;
    for (EffectResponse& e : changed.effects) e.shape_error = error;
    check("shape error " + change + " times", changed, settings);
  }
  for (const auto& [change, variance] :
       std::map<std::string, double>{{"1.5 times", 0.0225}, {"divided by 1.5", 0.01 / 2.25}}) {
    changed = fit;
    changed.discrepancy = variance * MatrixXd::Identity(3, 3);
    check("law discrepancy " + change, changed, settings);
  }
  TableModel without = m;
  without.discrepancy.setZero();
  EXPECT_EQ(diagnosed(without, 1, settings).sensitivity.size(), 5u);
  // ranges to both sides are halved on both
  TableModel both = m;
  both.effects[2] = effect("c", vector({-1, 1, 0, 0}), -4, 4);
  const Diagnosis sided = diagnosed(both, 1, settings);
  changed = both.part({0, 1, 2});
  for (EffectResponse& e : changed.effects) e.low = e.name == "c" ? -2 : 0, e.high = 2;
  double rivals = 0, top = 0;
  for (const ModelEvidence& e : all_evidence(changed, settings))
    if (e.name() != "no_gap") rivals += e.probability, top = std::max(top, e.probability);
  EXPECT_NEAR(sided.sensitivity[2].probability, top / rivals, 1e-9);
}

TEST(GapJudgement, SentencesTellTheVerdict) {
  Diagnosis d;
  d.models = models_of({{"no_gap", 0.62}, {"unknown", 0.05}, {"a", 0.2}, {"a+b", 0.07}, {"b", 0.06}});
  std::reverse(d.models.begin(), d.models.end());
  EXPECT_EQ(verdict_sentence(d),
            "No gap: the measurement agrees with the calibrated simulation within everything that is uncertain "
            "(probability of no gap 62 %).");
  d.models[0].probability = 0.41;
  EXPECT_NE(verdict_sentence(d).find("more than chance lets one do in a hundred tables without any (probability of no "
                                     "gap 41 %)."),
            std::string::npos);

  d.verdict = Verdict::unknown;
  const std::string unexplained =
      "There is a gap, and none of the effects in the library nor any two of them explain it (unknown 5 %, no gap 41 "
      "%).";
  d.fit.apparatus = "mixer", d.fit.observable = "power";
  d.fit.worst = 0.2;
  EXPECT_EQ(verdict_sentence(d), unexplained);
  const std::string nearest = " Nearest is a, which leaves the rows of mixer power off as one table in ";
  d.fit.worst = 0.02;
  EXPECT_EQ(verdict_sentence(d), unexplained + nearest + "50 would.");
  d.fit.worst = 1e-12;
  EXPECT_EQ(verdict_sentence(d), unexplained + nearest + "1000000000 would.");

  d.verdict = Verdict::ambiguous;
  d.group = {"a", "b"};
  EXPECT_EQ(
      verdict_sentence(d),
      "There is a gap, and these data do not settle its cause: a 20 % (27 % with its pairs), b 6 % (13 % with its "
      "pairs); unknown 5 %, no gap 41 %.");
  d.models[1].probability = 0.8;  // of a
  EXPECT_NE(verdict_sentence(d).find("a 80 % (87 % with its pairs)"), std::string::npos);
  d.models[1].probability = 0.2;
  d.group = {"a", "b", "x", "y", "z"};
  EXPECT_NE(verdict_sentence(d).find("x 0 % (0 % with its pairs), 2 others; unknown"), std::string::npos);

  d.verdict = Verdict::named;
  d.named = {"a"};
  d.strengths = {{"a", "1", {1.25, 0.5, 2}}, {"b", "deg", {3, 2, 4}}};
  EXPECT_EQ(verdict_sentence(d),
            "There is a gap, explained by a at strength 1.25 (90 %: 0.5 to 2) (probability 20 %).");
  d.named = {"a", "b"};
  EXPECT_EQ(
      verdict_sentence(d),
      "There is a gap, explained by two effects together: a at strength 1.25 (90 %: 0.5 to 2), and b at strength 3 "
      "deg (90 %: 2 to 4) (probability 7 %).");
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// The likelihood term by term, each against the formula of evidence.h worked out by hand or with scalar normal
// densities. gap_evidence_test holds it as a whole against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/bad_input.h"
#include "gap/verdict/evidence.h"
#include "gap_table.h"

namespace {

using namespace vielto::gap;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double log_normal(double d, double variance) { return -d * d / (2 * variance) - 0.5 * std::log(2 * M_PI * variance); }

ModelEvidence of_nodes(const std::vector<StrengthNode>& nodes) {
  ModelEvidence m;
  m.effects = {"a"};
  m.posterior = nodes;
  return m;
}

TEST(GapLikelihood, IsTheNormalDensity) {
  EXPECT_NEAR(log_normal_density(vector({0.7}), MatrixXd::Constant(1, 1, 0.25)), log_normal(0.7, 0.25), 1e-12);
  // y1 and y2 - rho y1 are independent
  MatrixXd c(2, 2);
  c << 1, 0.6, 0.6, 4;
  const double rest = 4 - 0.36, joint = log_normal(1.5, 1) + log_normal(-2 - 0.6 * 1.5, rest);
  EXPECT_NEAR(log_normal_density(vector({1.5, -2}), c), joint, 1e-12);
  const TableModel m = table(vector({10, 10}), 1);
  EXPECT_NEAR(chi_squared(vector({1.5, -2}), c, m), 1.5 * 1.5 + 2.9 * 2.9 / rest, 1e-12);
  c(0, 1) = c(1, 0) = 3;  // no covariance: larger than both variances allow
  EXPECT_EQ(log_normal_density(vector({1.5, -2}), c), -kInfinity);
  EXPECT_THROW(chi_squared(vector({1.5, -2}), c, m), vielto::BadInput);
}

TEST(GapLikelihood, NamesAModelAfterItsEffects) {
  ModelEvidence m;
  EXPECT_EQ(m.name(), "no_gap");
  m.effects = {"a"};
  EXPECT_EQ(m.name(), "a");
  m.effects = {"a", "b"};
  EXPECT_EQ(m.name(), "a+b");
  m.unknown = true;
  EXPECT_EQ(m.name(), "unknown");
}

// Strengths 1, 2, 4 of weights 0.2, 0.5, 0.3, each the middle of a cell as wide as the way from the one below (of the
// first: to the one above): quantile 0.5 is 0.3/0.5 of the way through the second cell, and so on.
TEST(GapLikelihood, QuantilesOfAStrengthLieWithinItsCell) {
  const Interval i = of_nodes({{{4}, 0.3}, {{2}, 0.3}, {{1}, 0.2}, {{2}, 0.2}}).strength(0);
  EXPECT_NEAR(i.value, 2 + (0.3 / 0.5 - 0.5) * 1, 1e-12);
  EXPECT_NEAR(i.low90, 1 + (0.05 / 0.2 - 0.5) * 1, 1e-12);
  EXPECT_NEAR(i.high90, 4 + (0.25 / 0.3 - 0.5) * 2, 1e-12);
  // equal but for rounding errors: one cell
  const Interval large = of_nodes({{{900}, 0.5}, {{1000}, 0.25}, {{1000 * (1 + 3e-13)}, 0.25}}).strength(0);
  EXPECT_NEAR(large.high90, 1000 + (0.45 / 0.5 - 0.5) * 100, 1e-9);
  // the second effect's own
  ModelEvidence pair = of_nodes({{{7, 1}, 0.5}, {{7, 2}, 0.5}});
  EXPECT_EQ(pair.strength(0).low90, 7);
  EXPECT_NEAR(pair.strength(1).low90, 1 + (0.1 - 0.5) * 1, 1e-12);
  // small weights are left out of a posterior: what is beyond them is the last cell's end
  EXPECT_NEAR(of_nodes({{{1}, 0.4}, {{2}, 0.4}}).strength(0).high90, 2.5, 1e-12);
  EXPECT_EQ(of_nodes({{{1}, 1.0}, {{2}, 0.0}}).strength(0).value, 1);
}

// f = 10 in both rows, b = 1: 10 + 1 + 2 + 3 and, where values multiply, 2 x 3/10 more.
TEST(GapLikelihood, TwoEffectsMultiplyWhereValuesDo) {
  TableModel m = table(vector({10, 10}), 1, {effect("a", vector({2, 2}), 0, 2), effect("b", vector({1, 1}), 0, 4)});
  m.family_shift.setOnes();
  m.relative << 1, 0;
  EXPECT_EQ(mean_at(m, {}, {}), vector({11, 11}));
  EXPECT_EQ(mean_at(m, {&m.effects[0]}, {1}), vector({13, 13}));
  const VectorXd both = mean_at(m, {&m.effects[0], &m.effects[1]}, {1, 3});
  EXPECT_NEAR(both[0], 16.6, 1e-12);
  EXPECT_NEAR(both[1], 16, 1e-12);
}

// Noise of 1, an emulator's error of 0.25 for b, shape errors of 0.1 of responses of 2 and 3 (and 0.2 x 3), tied by a
// correlation of 0.5 between the rows; together 20 x 0.1 x 0.2 x 2 x 3/10 more.
TEST(GapLikelihood, EffectsBringTheirUncertainty) {
  TableModel m = table(vector({10, 10}), 1, {effect("a", vector({2, -2}), 0, 2), effect("b", vector({1, 1}), 0, 4)});
  m.shape_correlation << 1, 0.5, 0.5, 1;
  m.effects[0].shape_error = 0.1;
  m.effects[1].shape_error = 0.2;
  m.effects[1].covariance.assign(3, 0.25 * MatrixXd::Identity(2, 2));
  m.interaction = 20;
  const MatrixXd one = covariance_at(m, {&m.effects[0]}, {1});
  EXPECT_NEAR(one(0, 0), 1 + 0.04, 1e-12);
  EXPECT_NEAR(one(0, 1), -0.5 * 0.04, 1e-12);
  const MatrixXd both = covariance_at(m, {&m.effects[0], &m.effects[1]}, {1, 3});
  const double together = 20 * 0.1 * 0.2 * 2 * 3 / 10;
  EXPECT_NEAR(both(0, 0), 1 + 0.04 + 0.25 + 0.36 + together * together, 1e-12);
  EXPECT_NEAR(both(0, 1), 0.5 * (-0.04 + 0.36 - together * together), 1e-12);
}

// Amplitudes of 0.5 to 8 in eight equal steps of the logarithm, each with a ninth of its shape's weight.
TEST(GapLikelihood, AnUnknownGapHasEveryShapeAndAmplitude) {
  TableModel m = table(vector({13}), 0.25);
  m.unknown = {{0.75, MatrixXd::Identity(1, 1), VectorXd::Constant(1, 2)},
               {0, MatrixXd::Identity(1, 1), VectorXd::Ones(1)},
               {0.25, MatrixXd::Identity(1, 1), VectorXd::Ones(1)}};
  Settings settings;
  settings.unknown_low = 0.5;
  settings.unknown_high = 8;
  const auto nodes = unknown_nodes(m, settings);
  ASSERT_EQ(nodes.size(), 18u);
  double density = 0;
  for (std::size_t k = 0; k < 18; ++k) {
    const double amplitude = std::pow(2, static_cast<double>(k % 9) / 2 - 1), size = k < 9 ? 2 : 1;
    const double variance = 0.25 + std::pow(amplitude * size, 2), weight = (k < 9 ? 0.75 : 0.25) / 9;
    EXPECT_NEAR(nodes[k].covariance(0, 0), variance, 1e-12) << k;
    EXPECT_NEAR(nodes[k].log_weight, std::log(weight), 1e-12) << k;
    density += weight * std::exp(log_normal(3, variance));
  }
  EXPECT_NEAR(unknown_evidence(m, settings).log_evidence, std::log(density), 1e-12);
  EXPECT_NEAR(no_gap_evidence(m).log_evidence, log_normal(3, 0.25), 1e-12);
}

// An effect that shows nowhere explains a table as no gap does, and no strength of it is likelier than another: nodes
// in the middles of 64 equal cells, of 16 x 16 for two.
TEST(GapLikelihood, AnEffectThatShowsNowhereLeavesItsRange) {
  TableModel m = table(vector({10.7}), 0.25, {effect("a", vector({0}), 3, 5), effect("b", vector({0}), -1, 3)});
  const ModelEvidence one = effect_evidence(m, {&m.effects[0]});
  EXPECT_NEAR(one.log_evidence, log_normal(0.7, 0.25), 1e-12);
  ASSERT_EQ(one.posterior.size(), 64u);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(one.posterior[i].strengths[0], 3 + 2 * (static_cast<double>(i) + 0.5) / 64, 1e-12);
    EXPECT_NEAR(one.posterior[i].weight, 1.0 / 64, 1e-12);
  }
  const ModelEvidence two = effect_evidence(m, {&m.effects[0], &m.effects[1]});
  EXPECT_NEAR(two.log_evidence, log_normal(0.7, 0.25), 1e-12);
  ASSERT_EQ(two.posterior.size(), 256u);
  EXPECT_NEAR(two.posterior[17].strengths[0], 3 + 2 * 1.5 / 16, 1e-12);
  EXPECT_NEAR(two.posterior[17].strengths[1], -1 + 4 * 1.5 / 16, 1e-12);
}

// A bell of width 1 at 120.5 in a range from 100 to 164, whose cells are 1 wide: within a drop of 15 lie the nodes up
// to sqrt(30) = 5.48 away, and with a cell and a half on either side the range closes in to 114 .. 127, which leaves no
// node that would close it in much further. Kept are nodes of more than e^-15 of the sum: up to sqrt(2 (15 - ln(64
// sqrt(2 pi)/13))) = 4.998 away.
TEST(GapLikelihood, TheGridClosesInOnABell) {
  TableModel m = table(vector({130.5}), 1, {effect("a", vector({1}), 100, 164)});
  const ModelEvidence e = effect_evidence(m, {&m.effects[0]});
  const double step = 13.0 / 64;
  EXPECT_NEAR(e.posterior.front().strengths[0], 114 + 7.5 * step, 1e-9);
  EXPECT_NEAR(e.posterior.back().strengths[0], 127 - 7.5 * step, 1e-9);
  ASSERT_EQ(e.posterior.size(), 50u);
  EXPECT_NEAR(e.posterior[1].strengths[0], 114 + 8.5 * step, 1e-9);
  EXPECT_NEAR(e.log_evidence, -std::log(64.0), 1e-9);  // the bell's integral over the range's width
  // a wider one (3.7: nodes up to 20.3 away) would leave 43 of 64 parts: too little is gained
  m.noise(0, 0) = 3.7 * 3.7;
  m.observed[0] = 142.5;
  const ModelEvidence wide = effect_evidence(m, {&m.effects[0]});
  EXPECT_NEAR(wide.posterior[1].strengths[0] - wide.posterior[0].strengths[0], 1, 1e-12);
  EXPECT_NEAR(wide.log_evidence, -std::log(64.0), 1e-9);
}

// Bells of a millionth of the range's width, anywhere in it, have the same integral.
TEST(GapLikelihood, TheGridFindsANarrowBell) {
  for (const double place : {0.001, 0.3, 0.999}) {
    const TableModel m = table(vector({10 + 100 + 64 * place}), 1e-12, {effect("a", vector({1}), 100, 164)});
    EXPECT_NEAR(effect_evidence(m, {&m.effects[0]}).log_evidence, -std::log(64.0), 1e-5) << place;
  }
  // two effects, each of which one row shows
  const TableModel m =
      table(vector({10 + 3, 10 - 2}), 1e-8, {effect("a", vector({1, 0}), 0, 4), effect("b", vector({0, 1}), -5, 5)});
  const ModelEvidence pair = effect_evidence(m, {&m.effects[0], &m.effects[1]});
  EXPECT_NEAR(pair.log_evidence, -std::log(4.0 * 10), 1e-4);
  EXPECT_NEAR(pair.strength(0).value, 3, 1e-4);
  EXPECT_NEAR(pair.strength(1).value, -2, 1e-4);
}

// Bayes' rule: three effects share the prior of single ones, their three pairs that of pairs.
TEST(GapLikelihood, ProbabilitiesArePriorTimesEvidence) {
  const VectorXd none = vector({0});
  TableModel m = table(vector({10}), 1, {effect("a", none, 0, 1), effect("b", none, 0, 1), effect("c", none, 0, 1)});
  Settings settings;
  const auto check = [&](double no_gap, double unknown, double single, double pair) {
    settings.prior_no_gap = no_gap, settings.prior_unknown = unknown;
    settings.prior_single = single, settings.prior_pair = pair;
    std::vector<ModelEvidence> models(8);
    models[1].unknown = true;
    for (const auto& names : {"a", "b", "c"}) models[static_cast<std::size_t>(*names - 'a') + 2].effects = {names};
    models[5].effects = {"a", "b"}, models[6].effects = {"a", "c"}, models[7].effects = {"b", "c"};
    const double ratios[] = {1, 2, 3, 5, 7, 11, 13, 17};
    const double priors[] = {no_gap, unknown, single / 3, single / 3, single / 3, pair / 3, pair / 3, pair / 3};
    double sum = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      models[k].log_evidence = std::log(ratios[k]) - 700;  // a likelihood no double holds
      sum += ratios[k] * priors[k];
    }
    set_probabilities(models, m, settings);
    for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(models[k].probability, ratios[k] * priors[k] / sum, 1e-12) << k;
  };
  check(0.5, 0.1, 0.3, 0.1);
  check(0.1, 0.7, 0.1, 0.1);
  check(0.1, 0.1, 0.7, 0.1);
  check(0.1, 0.1, 0.1, 0.7);
  // without effects two models are left
  m.effects.clear();
  std::vector<ModelEvidence> models(2);
  models[1].unknown = true;
  settings.prior_no_gap = 0.4, settings.prior_unknown = 0.1;
  set_probabilities(models, m, settings);
  EXPECT_NEAR(models[0].probability, 0.8, 1e-12);
  models[1].log_evidence = kInfinity;
  EXPECT_THROW(set_probabilities(models, m, settings), vielto::BadInput);
}

// Rows off by 3, 0 and 2, of which a, b and c explain one each; pairs among the best two are that of a and c.
TEST(GapLikelihood, PairsAreAmongTheBestSingles) {
  const TableModel m = table(vector({13, 10, 12}), 0.25,
                             {effect("a", vector({1, 0, 0}), 0, 4), effect("b", vector({0, 1, 0}), 0, 4),
                              effect("c", vector({0, 0, 1}), 0, 4)});
  Settings settings;
  settings.prior_no_gap = settings.prior_unknown = settings.prior_single = settings.prior_pair = 0.25;
  settings.unknown_low = 0.3, settings.unknown_high = 6;
  const auto names = [&](int best) {
    std::string all;
    for (const ModelEvidence& e : all_evidence(m, settings, best)) all += e.name() + " ";
    return all;
  };
  EXPECT_EQ(names(0), "no_gap unknown a b c a+b a+c b+c ");
  EXPECT_EQ(names(2), "no_gap unknown a b c a+c ");
  EXPECT_EQ(names(3), names(0));
}

// The statistic of the verdict with scalar densities: nodes in the middles of 16 cells of a strength (5 for a pair) to
// either side of 0, whose ends lie at the squares of i/16; weight: the cell's part of the range.
struct Node {
  double strength, weight;
};

std::vector<Node> nodes_of(double low, double high, int steps) {
  std::vector<Node> nodes;
  for (const double end : {low, high})
    for (int i = 0; i < steps; ++i) {
      const double n = steps * steps, from = end * (i * i / n), to = end * ((i + 1) * (i + 1) / n);
      if (end != 0) nodes.push_back({0.5 * from + 0.5 * to, std::fabs(to - from) / (high - low)});
    }
  return nodes;
}

TEST(GapLikelihood, TheLargestOddsAreThoseOfTheBestRival) {
  // a shows in the first row, b in the second; b may go either way; the family is off by 0.5
  TableModel m = table(vector({10, 10}), 0.25, {effect("a", vector({1, 0}), 0, 4), effect("b", vector({0, 1}), -2, 6)});
  m.family_shift.setConstant(0.5);
  // the unknown gap shows in a third way: in both rows alike, and less
  m.unknown = {{1, MatrixXd::Identity(2, 2), VectorXd::Constant(2, 0.2)}};
  Settings settings;
  settings.unknown_low = 0.5;
  settings.unknown_high = 8;
  const double variance = 0.25;
  const std::vector<std::vector<double>> gaps = {{0, 0},  {2, 0},     {0.1, 5}, {0, -1.5}, {3, 4},
                                                 {2, -1}, {-1, -2.5}, {-1, 0},  {3.9, 0.2}};
  MatrixXd tables(2, static_cast<Eigen::Index>(gaps.size()));
  for (std::size_t k = 0; k < gaps.size(); ++k)
    tables.col(static_cast<Eigen::Index>(k)) << 10.5 + gaps[k][0], 10.5 + gaps[k][1];
  const VectorXd odds = largest_log_odds(m, settings, tables);
  int best_of[4] = {};
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const auto density = [&](double s, double t) {
      return std::exp(log_normal(gaps[k][0] - s, variance) + log_normal(gaps[k][1] - t, variance));
    };
    double rivals[4] = {};  // unknown, a, b, both
    for (int i = 0; i < 9; ++i) {
      const double more = variance + std::pow(0.2 * std::pow(2, i / 2.0 - 1), 2);
      rivals[0] += std::exp(log_normal(gaps[k][0], more) + log_normal(gaps[k][1], more)) / 9;
    }
    for (const Node& s : nodes_of(0, 4, 16)) rivals[1] += s.weight * density(s.strength, 0);
    for (const Node& t : nodes_of(-2, 6, 16)) rivals[2] += t.weight * density(0, t.strength);
    for (const Node& s : nodes_of(0, 4, 5))
      for (const Node& t : nodes_of(-2, 6, 5)) rivals[3] += s.weight * t.weight * density(s.strength, t.strength);
    const double* best = std::max_element(rivals, rivals + 4);
    ++best_of[best - rivals];
    EXPECT_NEAR(odds[static_cast<Eigen::Index>(k)], std::log(*best / density(0, 0)), 1e-9) << k;
  }
  for (const int count : best_of) EXPECT_GT(count, 0);  // each is the best rival of a table
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// The likelihood against closed forms: marginal likelihood of the linear Gaussian case, probabilities, regions,
// smoothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "core/statistics.h"
#include "gap/emulator/discrepancy.h"
#include "gap/emulator/gaussian_process.h"
#include "gap/emulator/unknown_gap.h"
#include "gap/verdict/evidence.h"
#include "gap/verdict/fit.h"
#include "gap/verdict/regions.h"
#include "gap/verdict/test_design.h"
#include "gap/verdict/threshold.h"
#include "gap/verdict/trends.h"

namespace {

using namespace vielto::gap;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using vielto::Observation;

double standard_normal(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// n rows, effects linear in the strength without shape or emulator error, so that everything is Gaussian.
TableModel linear_model(const VectorXd& y, const std::vector<VectorXd>& slopes, double low, double high) {
  const Eigen::Index n = y.size();
  TableModel m;
  m.rows.resize(static_cast<std::size_t>(n));
  m.observed = y;
  m.baseline = VectorXd::Constant(n, 10);
  m.scale = m.baseline;
  m.family_shift = m.relative = m.logarithmic = VectorXd::Zero(n);
  m.family_members = MatrixXd::Zero(n, 0);
  m.noise = MatrixXd::Identity(n, n) * 0.25;
  m.noise(0, 1) = m.noise(1, 0) = 0.1;
  for (auto member : {&TableModel::seed, &TableModel::emulator, &TableModel::family, &TableModel::discrepancy,
                      &TableModel::reference})
    m.*member = MatrixXd::Zero(n, n);
  m.shape_correlation = MatrixXd::Identity(n, n);
  m.unknown = {{1, m.shape_correlation, VectorXd::Ones(n)}};
  int number = 0;
  for (const VectorXd& slope : slopes) {
    EffectResponse e;
    e.name = std::string(1, static_cast<char>('a' + number++));
    e.low = low;
    e.high = high;
    e.strengths.resize(3);
    e.strengths << std::min(low, -1e-9), 0, high;
    e.mean = slope * e.strengths.transpose();
    e.covariance.assign(3, MatrixXd::Zero(n, n));
    m.effects.push_back(e);
  }
  return m;
}

// One effect, y = f + s a + e: with V = a' C^-1 a and s^ = a' C^-1 d / V,
//   p(y) = N(y; f + s^ a, C) sqrt(2 pi / V) [Phi((h - s^) sqrt V) - Phi((l - s^) sqrt V)] / (h - l).
TEST(GapEvidence, OneEffectAgainstTheClosedForm) {
  VectorXd a(4), y(4);
  a << 1, 2, 0.5, -1;
  for (const double s : {0.0, 0.02, 1.0, 2.9}) {
    y << 10.3 + s, 9.8 + 2 * s, 10.1 + 0.5 * s, 10.2 - s;
    const TableModel m = linear_model(y, {a}, 0, 3);
    const MatrixXd c = m.null_covariance();
    const VectorXd d = y - m.baseline;
    const double v = a.dot(c.inverse() * a), best = a.dot(c.inverse() * d) / v;
    const VectorXd rest = d - best * a;
    const double exact =
        -0.5 * rest.dot(c.inverse() * rest) - 0.5 * std::log((2 * M_PI * c).determinant()) +
        0.5 * std::log(2 * M_PI / v) +
        std::log((standard_normal((3 - best) * std::sqrt(v)) - standard_normal(-best * std::sqrt(v))) / 3);
    // The midpoint rule with 64 cells over a bell cut off at 0: its error is below a thousandth.
    EXPECT_NEAR(effect_evidence(m, {&m.effects[0]}).log_evidence, exact, 1e-3) << s;
  }
}

// Draws of a table without a gap have the mean and the covariance of what they are made of; a member of the family adds
// its mean and p (1 - p) d d' for two of the weights p and 1 - p that differ by d. Each entry of the covariance of N
// draws is known to sqrt((S_ii S_jj + S_ij^2)/N), of members less.
TEST(GapThreshold, DrawsScatterAsTheirParts) {
  TableModel truth = linear_model(VectorXd::Constant(3, 10), {}, 0, 1);
  truth.baseline << 10, 20, 30;
  truth.seed = VectorXd::Constant(3, 0.5).asDiagonal();
  truth.discrepancy = MatrixXd::Constant(3, 3, 0.09);
  truth.reference = 0.04 * truth.baseline / 10 * truth.baseline.transpose() / 10;
  for (const bool family : {false, true}) {
    VectorXd mean = truth.baseline;
    MatrixXd covariance = truth.noise + truth.seed + truth.discrepancy + truth.reference;
    if (family) {
      truth.family_members.resize(3, 2);
      truth.family_members << 4, -1, 0, 2, 0, 0;
      truth.family_weights.resize(2);
      truth.family_weights << 0.25, 0.75;
      const VectorXd apart = truth.family_members.col(0) - truth.family_members.col(1);
      mean += truth.family_members * truth.family_weights;
      covariance += 0.25 * 0.75 * apart * apart.transpose();
    }
    const int count = 20000;
    std::mt19937_64 random(1);
    MatrixXd draws(3, count);
    for (int b = 0; b < count; ++b) draws.col(b) = draw_without_gap(truth, random);
    const VectorXd found = draws.rowwise().mean();
    const MatrixXd rest = draws.colwise() - found, scatter = rest * rest.transpose() / count;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(found[i], mean[i], 5 * std::sqrt(covariance(i, i) / count)) << i;
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(scatter(i, j), covariance(i, j),
                    5 * std::sqrt((covariance(i, i) * covariance(j, j) + std::pow(covariance(i, j), 2)) / count))
            << i << " " << j;
    }
  }
}

// One row is its baseline plus its standard deviation times the generator's normal number. Rows that are known to vary
// as one still do: what makes their covariance regular is 1e-14 of it, 1e-7 of a standard deviation.
TEST(GapThreshold, DrawsAreTheGeneratorsNumbers) {
  TableModel truth = linear_model(VectorXd::Constant(2, 10), {}, 0, 1);
  truth.noise = MatrixXd::Constant(2, 2, 1e-4);
  std::mt19937_64 random(7), same(7);
  const VectorXd draw = draw_without_gap(truth, random);
  const double z = std::normal_distribution<double>()(same);
  EXPECT_NEAR(draw[0], 10 + 0.01 * z, 1e-12);
  EXPECT_NEAR(draw[1], draw[0], 6 * 0.01 * 2e-7);
}

// 100 draws asked for of 3 libraries are 34 each. Of 102 odds in order the quantile p is number ceil(102 p), and its 95
// % interval is 1.96 sqrt(102 p (1 - p)) numbers wide to either side (binomial); the threshold is never below 0.
TEST(GapThreshold, IsAQuantileOfTheOddsByTheirOrder) {
  const Emulator emulator(Library{}, {}, {});
  VectorXd slope(3);
  slope << 1, 2, 0.5;
  const TableModel truth = linear_model(VectorXd::Constant(3, 10), {slope}, 0, 3);
  Settings settings = Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml");
  settings.draws = 100;
  settings.libraries = 3;
  std::mt19937_64 random(5);
  std::vector<double> odds;
  for (int l = 0; l < 3; ++l) {
    emulator.redrawn(random);
    MatrixXd tables(3, 34);
    for (int b = 0; b < 34; ++b) tables.col(b) = draw_without_gap(truth, random);
    const VectorXd found = largest_log_odds(truth, settings, tables);
    odds.insert(odds.end(), found.begin(), found.end());
  }
  std::sort(odds.begin(), odds.end());
  const auto judge = [&](const Emulator&) { return truth; };
  settings.false_alarm = 0.02;  // number 100; 100 -+ 2.77, and there are no more than 102
  Threshold t = bootstrap_threshold(emulator, truth, settings, 5, judge);
  ASSERT_GT(odds[99], 0);
  EXPECT_EQ(t.log_odds, odds[99]);
  EXPECT_EQ(t.low95, odds[97]);
  EXPECT_EQ(t.high95, odds[101]);
  EXPECT_EQ(t.draws, 102);
  EXPECT_EQ(t.libraries, 3);
  EXPECT_EQ(t.seed, 5u);
  settings.false_alarm = 0.9;  // number 11; 10.2 -+ 5.94
  t = bootstrap_threshold(emulator, truth, settings, 5, judge);
  ASSERT_LT(odds[10], 0);
  EXPECT_EQ(t.log_odds, 0);
  EXPECT_EQ(t.low95, odds[4]);
  EXPECT_EQ(t.high95, odds[16]);
  settings.draws = 102;  // 34 each again
  EXPECT_EQ(bootstrap_threshold(emulator, truth, settings, 5, judge).draws, 102);
  settings.false_alarm = 0.999;  // number 1, from -0.52
  t = bootstrap_threshold(emulator, truth, settings, 5, judge);
  EXPECT_EQ(t.low95, odds[0]);
}

// Two rows, one present and one to come. With the same factor of the family in both (variance A), noise u^2 and v^2 and
// a gap g of the first alone, the second leaves A v^2/(A + v^2) of the family: from g/sqrt(A + u^2) to g/sqrt(A v^2/(A
// + v^2) + u^2).
TEST(NextTest, ThatNarrowsTheFamilyMakesAnUnknownGapStandOut) {
  const double A = 0.04, u = 0.1, v = 0.01, g = 0.3;
  VectorXd y(2);
  y << 10 + g, 10;
  TableModel m = linear_model(y, {}, 0, 1);
  m.noise << u * u, 0, 0, v * v;
  m.family.setConstant(A);
  m.unknown[0].correlation = MatrixXd::Identity(2, 2);
  vielto::gap::CandidateTest test;
  test.name = "heap";
  test.hours = 2;
  const auto next = judge_for_unknown(m, 1, test);
  EXPECT_NEAR(next.separation_now, g / std::sqrt(A + u * u), 1e-12);
  EXPECT_NEAR(next.separation, g / std::sqrt(A * v * v / (A + v * v) + u * u), 1e-9);
  EXPECT_NEAR(next.gain_per_hour, (next.separation - next.separation_now) / 2, 1e-12);

  // the same quantity measured again, an unknown gap common to both (z): G = [g, z/(A + u^2 + z) g], C = A + noise
  const double z = 0.09;
  m.noise << u * u, 0, 0, u * u;
  m.unknown[0].correlation = MatrixXd::Constant(2, 2, z);
  const double second = z / (A + u * u + z) * g, det = (A + u * u) * (A + u * u) - A * A;
  const double squared = ((A + u * u) * (g * g + second * second) - 2 * A * g * second) / det;
  EXPECT_NEAR(judge_for_unknown(m, 1, test).separation, std::sqrt(squared), 1e-9);
  // one that the family and the gap leave alone tells nothing
  m.family << A, 0, 0, 0;
  m.unknown[0].correlation = MatrixXd::Identity(2, 2);
  EXPECT_NEAR(judge_for_unknown(m, 1, test).gain_per_hour, 0, 1e-12);
}

// Two effects with a Gaussian well inside the prior: p(y) = N(y; f + A s^, C) 2 pi / sqrt(det A' C^-1 A) / 36.
TEST(GapEvidence, TwoEffectsAgainstTheClosedForm) {
  MatrixXd a(5, 2);
  a << 1, 0.5, 2, -1, 0.5, 1, -1, 2, 1.5, 0.3;
  VectorXd y(5);
  y << 11.2, 10.4, 10.9, 10.6, 11.8;
  const TableModel m = linear_model(y, {a.col(0), a.col(1)}, -3, 3);
  const MatrixXd c = m.null_covariance(), information = a.transpose() * c.inverse() * a;
  const VectorXd d = y - m.baseline, best = information.inverse() * a.transpose() * c.inverse() * d,
                 rest = d - a * best;
  const double exact = -0.5 * rest.dot(c.inverse() * rest) - 0.5 * std::log((2 * M_PI * c).determinant()) +
                       std::log(2 * M_PI / std::sqrt(information.determinant())) - std::log(36.0);
  const ModelEvidence pair = effect_evidence(m, {&m.effects[0], &m.effects[1]});
  EXPECT_NEAR(pair.log_evidence, exact, 1e-3);
  // Its marginal intervals are those of the normal distribution: 1.645 standard deviations; cells are a fifth of one.
  for (int e = 0; e < 2; ++e) {
    const double sd = std::sqrt(information.inverse()(e, e));
    const Interval i = pair.strength(static_cast<std::size_t>(e));
    EXPECT_NEAR(i.value, best[e], 0.1 * sd);
    EXPECT_NEAR(i.low90, best[e] - 1.645 * sd, 0.15 * sd);
    EXPECT_NEAR(i.high90, best[e] + 1.645 * sd, 0.15 * sd);
  }
}

// What two effects do together is uncertain by a part of the product of their responses; one alone knows nothing of it.
TEST(GapEvidence, AnInteractionWidensAPairOnly) {
  VectorXd y(2), a(2), b(2);
  y << 10, 10;
  a << 2, 1;
  b << 3, -1;
  TableModel m = linear_model(y, {a, b}, 0, 1);
  m.shape_correlation << 1, 0.5, 0.5, 1;
  m.scale << 10, 5;
  m.effects[0].shape_error = m.effects[1].shape_error = 0.1;
  const std::vector<const EffectResponse*> pair = {&m.effects[0], &m.effects[1]};
  const MatrixXd without = covariance_at(m, pair, {1, 0.5}), alone = covariance_at(m, {pair[0]}, {1});
  m.interaction = 20;
  EXPECT_EQ(covariance_at(m, {pair[0]}, {1}), alone);
  const MatrixXd more = covariance_at(m, pair, {1, 0.5}) - without;
  const double first = 20 * 0.01 * 2 * 1.5 / 10, second = 20 * 0.01 * 1 * -0.5 / 5;
  EXPECT_NEAR(more(0, 0), first * first, 1e-12);
  EXPECT_NEAR(more(1, 1), second * second, 1e-12);
  EXPECT_NEAR(more(0, 1), 0.5 * first * second, 1e-12);
}

TEST(GapEvidence, ProbabilitiesSumToOneAndFollowTheData) {
  Settings settings;
  settings.prior_no_gap = 0.5, settings.prior_single = 0.3, settings.prior_pair = 0.1, settings.prior_unknown = 0.1;
  settings.unknown_low = 0.3, settings.unknown_high = 6;
  VectorXd a(4), b(4), y(4);
  a << 1, 2, 0.5, -1;
  b << 1, -1, 1, 1;
  for (const double s : {0.0, 1.0, 2.0}) {
    y << 10.1 + s, 9.9 + 2 * s, 10.0 + 0.5 * s, 10.1 - s;
    const TableModel m = linear_model(y, {a, b}, 0, 3);
    const auto models = all_evidence(m, settings);
    ASSERT_EQ(models.size(), 5u);  // no gap, unknown, a, b, a+b
    double sum = 0, of_a = 0, none = 0;
    for (const ModelEvidence& model : models) {
      sum += model.probability;
      if (model.name() == "a") of_a = model.probability;
      if (model.name() == "no_gap") none = model.probability;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    if (s == 0) {
      EXPECT_GT(none, 0.5);
    }
    if (s == 2) {
      EXPECT_GT(of_a, 0.7);
    }
  }
}

// Benjamini and Hochberg 1995, the 15 p values of their example (section 3.2): four are below 0.05 (i/15 rule).
TEST(GapRegions, BenjaminiHochbergByHand) {
  const std::vector<double> p = {0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                                 0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
  const auto q = q_values(p, false);
  EXPECT_NEAR(q[0], 0.0001 * 15, 1e-12);
  EXPECT_NEAR(q[2], 0.0019 * 15 / 3, 1e-12);
  EXPECT_NEAR(q[3], 0.0095 * 15 / 4, 1e-12);
  EXPECT_NEAR(q[4], 0.0201 * 15 / 5, 1e-12);
  // 0.0278*15/6 = 0.0695, but 0.0298*15/7 = 0.063857 is smaller and stands for it.
  EXPECT_NEAR(q[5], 0.0298 * 15 / 7, 1e-12);
  int found = 0;
  for (const double x : q) found += x <= 0.05;
  EXPECT_EQ(found, 4);
  // Any dependence: times 1 + 1/2 + ... + 1/15 = 3.318228993.
  EXPECT_NEAR(q_values(p, true)[0], 0.0015 * 3.318228993, 1e-10);
  // The order of the input does not matter.
  EXPECT_NEAR(q_values({0.04, 0.001}, false)[1], 0.002, 1e-12);
}

// Two rows 1 and 2 over a baseline of 10 with noise of 0.5 each, and 0.3 that both share: the simulation shows 15 %
// less with u^2 = 5 %^2/2 + 3 %^2, to which the noise and the shared part add those two terms.
TEST(GapRegions, TellWhatTheirUncertaintyComesFrom) {
  VectorXd y(2);
  y << 11, 12;
  TableModel m = linear_model(y, {}, 0, 1);
  m.noise = MatrixXd::Identity(2, 2) * 0.25;
  m.family = MatrixXd::Constant(2, 2, 0.09);
  for (Observation& row : m.rows) row.apparatus = "mixer", row.observable = "power", row.speed = 1;
  const Location location = locate(m);
  ASSERT_EQ(location.regions.size(), 1u);
  const Region& r = location.regions[0];
  EXPECT_NEAR(r.relative_gap, -0.15, 1e-12);
  EXPECT_NEAR(r.u, std::sqrt(0.05 * 0.05 / 2 + 0.03 * 0.03), 1e-12);
  const std::map<std::string, double> parts(r.u_parts.begin(), r.u_parts.end());
  EXPECT_NEAR(parts.at("measurement"), 0.05 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(parts.at("calibration"), 0.03, 1e-12);
  for (const char* none : {"seeds", "emulator", "contact law"}) EXPECT_EQ(parts.at(none), 0) << none;
}

// Measured 8 and simulated 10 twice, relative noise of 5 % each: simulated over measured less 1 is +25 %, z is ln 1.25
// over 5 %/sqrt 2.
TEST(GapRegions, TellTheGapOfLogarithmsAsAFactor) {
  VectorXd y(2);
  y << 8, 8;
  TableModel m = linear_model(y, {}, 0, 1);
  m.relative.setOnes();
  m.noise = MatrixXd::Identity(2, 2) * std::pow(0.05 * 8, 2);
  for (Observation& row : m.rows) row.apparatus = "mixer", row.observable = "power", row.speed = 1;
  const Region r = locate(m.in_logarithms(TableModel::Values::measured)).regions.at(0);
  EXPECT_NEAR(r.relative_gap, 0.25, 1e-12);
  EXPECT_NEAR(r.u, 0.05 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(r.z, std::log(1.25) * std::sqrt(2.0) / 0.05, 1e-9);
}

// Two effects that multiply add up in logarithms; covariances become relative, an effect's over what it changes the
// value to; a row that adds up stays as it is.
TEST(GapLogarithms, MultiplyWhatTheValuesMultiply) {
  VectorXd y(3), a(3), b(3);
  y << 12, 8, -1;
  a << 2, 3, 4;
  b << -5, 1, 2;
  TableModel m = linear_model(y, {a, b}, 0, 1);
  m.relative << 1, 1, 0;
  m.discrepancy = 4 * MatrixXd::Identity(3, 3);
  for (EffectResponse& e : m.effects) e.covariance.assign(3, MatrixXd::Identity(3, 3));
  m.family_members = MatrixXd(3, 2);
  m.family_members << 0, 2, 0, 1, 0, 0;
  m.family_weights = VectorXd::Constant(2, 0.5);
  m.family_shift = m.family_members * m.family_weights;
  const MatrixXd centred = m.family_members.colwise() - m.family_shift;
  m.family = centred * m.family_weights.asDiagonal() * centred.transpose() + 0.01 * MatrixXd::Identity(3, 3);
  const TableModel logs = m.in_logarithms(TableModel::Values::measured);
  EXPECT_EQ(logs.logarithmic, (VectorXd(3) << 1, 1, 0).finished());
  const VectorXd sum = mean_at(logs, {&logs.effects[0], &logs.effects[1]}, {1, 1});
  // family: mean of ln 1 and ln 1.2, and of ln 1 and ln 1.1
  EXPECT_NEAR(sum[0], std::log(10 * 1.2 * 0.5) + std::log(1.2) / 2, 1e-12);
  EXPECT_NEAR(sum[1], std::log(10 * 1.3 * 1.1) + std::log(1.1) / 2, 1e-12);
  EXPECT_NEAR(sum[2], 10 + 4 + 2, 1e-12);
  // u is over the value that it was stated of
  EXPECT_NEAR(logs.noise(0, 1), 0.1 / (12 * 8), 1e-12);
  EXPECT_NEAR(logs.noise(1, 2), 0, 1e-12);
  EXPECT_NEAR(m.in_logarithms(TableModel::Values::placeholders).noise(0, 0), 0.25 / 100, 1e-12);
  // Before the data any number may stand in place of a value: what is sealed does not depend on it.
  TableModel blank = m;
  blank.observed.setZero();
  EXPECT_EQ(blank.in_logarithms(TableModel::Values::placeholders).logarithmic, logs.logarithmic);
  EXPECT_EQ(blank.in_logarithms(TableModel::Values::placeholders).null_covariance(),
            m.in_logarithms(TableModel::Values::placeholders).null_covariance());
  EXPECT_EQ(blank.in_logarithms(TableModel::Values::measured).logarithmic, VectorXd::Zero(3));
  EXPECT_NEAR(logs.discrepancy(0, 0), 0.04, 1e-12);
  EXPECT_NEAR(logs.discrepancy(2, 2), 4, 1e-12);
  EXPECT_NEAR(logs.family(0, 0), std::pow(std::log(1.2) / 2, 2) + 0.0001, 1e-12);
  EXPECT_NEAR(logs.effects[1].emulator(1)(0, 0), 1 / (5.0 * 5.0), 1e-12);
  EXPECT_NEAR(logs.effects[1].emulator(1)(2, 2), 1, 1e-12);
  EXPECT_NEAR(logs.gap()[0], std::log(1.2) / 2, 1e-12);
}

// Four rows at two speeds and two fills, measured over simulated speed^-0.4 fill^0.2: the exponents come back. With
// equal independent errors of s in the logarithm, u = s/sqrt(sum (ln c - mean)^2) = s/(ln of the ratio); an error that
// all rows share adds nothing, one that grows with the logarithm of the speed adds its own exponent.
TEST(GapTrends, AreWhatRegionsCannotShow) {
  TableModel m = linear_model(VectorXd::Zero(4), {}, 0, 1);
  m.noise.setZero();
  VectorXd slope(4);
  for (int i = 0; i < 4; ++i) {
    Observation& row = m.rows[static_cast<std::size_t>(i)];
    row.apparatus = "mixer", row.observable = "power";
    row.speed = i < 2 ? 0.5 : 1.5;
    row.fill = i % 2 ? 0.2 : 0.1;
    m.baseline[i] = 10 + i;
    m.observed[i] = m.baseline[i] * std::pow(*row.speed, -0.4) * std::pow(*row.fill, 0.2);
    slope[i] = m.baseline[i] * std::log(*row.speed);
  }
  const double s = 0.05;
  m.noise = (s * m.observed).array().square().matrix().asDiagonal();
  m.discrepancy = 0.09 * m.baseline * m.baseline.transpose();
  m.family = 0.01 * slope * slope.transpose();
  m.relative.setOnes();
  EXPECT_TRUE(trends_of(m).empty());  // values, not logarithms
  const TableModel logs = m.in_logarithms(TableModel::Values::measured);
  const auto trends = trends_of(logs);
  ASSERT_EQ(trends.size(), 2u);
  const Trend &speed = trends[trends[0].condition == "speed" ? 0 : 1],
              &fill = trends[trends[0].condition == "fill" ? 0 : 1];
  EXPECT_NEAR(speed.exponent, -0.4, 1e-9);
  EXPECT_NEAR(fill.exponent, 0.2, 1e-9);
  EXPECT_NEAR(speed.u, std::hypot(s / std::log(3.0), 0.1), 1e-9);
  EXPECT_NEAR(fill.u, s / std::log(2.0), 1e-9);
  const std::map<std::string, double> parts(speed.u_parts.begin(), speed.u_parts.end());
  EXPECT_NEAR(parts.at("measurement"), s / std::log(3.0), 1e-9);
  EXPECT_NEAR(parts.at("calibration"), 0.1, 1e-9);
  EXPECT_NEAR(parts.at("contact law"), 0, 1e-7);
  // two rows cannot tell a level and two exponents; a condition of 0 (an axis that lies level) has no logarithm
  EXPECT_TRUE(trends_of(logs.part({0, 3})).empty());
  for (Observation& row : m.rows) row.speed = 1, row.fill = std::nullopt, row.tilt = 0;
  m.rows[3].tilt = 45;
  EXPECT_TRUE(trends_of(m.in_logarithms(TableModel::Values::measured)).empty());
}

TEST(GapSmoothing, ResponseIsZeroAtZeroAndLearnsACurve) {
  std::vector<Point> points;
  VectorXd v(12);
  int i = 0;
  const auto truth = [](double t, double c) { return 0.4 * t * (1 + 0.5 * c) - 0.1 * t * t; };
  for (const double c : {0.0, 0.5, 1.0})
    for (const double t : {0.25, 0.5, 0.75, 1.0}) {
      points.push_back({t, VectorXd::Constant(1, c), {}});
      v[i++] = truth(t, c);
    }
  const GaussianProcess gp(GaussianProcess::Form::response, points, v, MatrixXd::Identity(12, 12) * 1e-6);
  const auto p = gp.at({{0, VectorXd::Constant(1, 0.3), {}}, {0.6, VectorXd::Constant(1, 0.25), {}}});
  EXPECT_EQ(p.mean[0], 0);
  EXPECT_EQ(p.covariance(0, 0), 0);
  EXPECT_NEAR(p.mean[1], truth(0.6, 0.25), 0.004);  // 2 % of the response, four times the noise
}

// One run at t = 1 that shows 0, known to 0.05: for an amplitude a in units of that, the response has the variance
// 0.05^2 a^2/(1 + a^2) left and the probability (1 + a^2)^-1/2 over their sum. The most probable amplitude alone (0.03)
// would say +-0.0015.
TEST(GapSmoothing, AmplitudesAreAveraged) {
  const GaussianProcess gp(GaussianProcess::Form::response, {{1, VectorXd::Zero(1), {}}}, VectorXd::Zero(1),
                           MatrixXd::Constant(1, 1, 0.0025));
  double sum = 0, variance = 0;
  for (const double a : {0.03, 0.1, 0.3, 1.0, 3.0}) {
    const double p = 1 / std::sqrt(1 + a * a);
    sum += p;
    variance += p * a * a / (1 + a * a) * 0.0025;
  }
  const auto p = gp.at({{1, VectorXd::Zero(1), {}}});
  EXPECT_EQ(p.mean[0], 0);
  EXPECT_NEAR(p.covariance(0, 0), variance / sum, 1e-9);
  EXPECT_GT(std::sqrt(p.covariance(0, 0)), 0.02);
}

// What a bench shows has a name: a gap that nobody named does not move it, and gains nothing from a bench row that is
// off.
TEST(GapUnknown, MovesNoBenchRow) {
  VectorXd y(2), a(2);
  y << 10, 15;
  a << 3, 3;
  TableModel m = linear_model(y, {a}, 0, 1);
  m.noise(0, 1) = m.noise(1, 0) = 0;
  m.rows[0].apparatus = "mixer";
  m.rows[1].apparatus = "bench";
  Settings settings = Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml");
  set_unknown_gap(m, {VectorXd::Zero(0), VectorXd::Zero(0)}, settings);
  EXPECT_GT(m.unknown[0].size[0], 0);
  EXPECT_EQ(m.unknown[0].size[1], 0);
  EXPECT_LE(unknown_evidence(m, settings).log_evidence, no_gap_evidence(m).log_evidence);
  m.rows[1].apparatus = "mixer";
  set_unknown_gap(m, {VectorXd::Zero(0), VectorXd::Zero(0)}, settings);
  EXPECT_GT(unknown_evidence(m, settings).log_evidence, no_gap_evidence(m).log_evidence + 1);
}

// A loss of the drive that is not held moves the dead weight's reading and the power alike, in its own way over speed:
// it is told from one that is held and goes another way, and costs the held one little where that is the cause.
TEST(GapUnknown, ALossOfTheDriveThatIsNotHeldIsNoOtherLoss) {
  const VectorXd flat = VectorXd::Constant(4, 10);
  TableModel m = linear_model(VectorXd::Constant(4, 10), {flat}, -0.15, 0.15);  // a: a factor on all four
  m.effects[0].kind = EffectKind::measurement;
  m.noise = MatrixXd::Identity(4, 4) * 0.01;  // 1 %
  const double speeds[] = {0.48, 1.58};
  for (std::size_t i = 0; i < 4; ++i) {
    m.rows[i].apparatus = i < 2 ? "mixer" : "bench";
    m.rows[i].observable = i < 2 ? "power" : "dead_weight_gain";
    m.rows[i].speed = speeds[i % 2];
  }
  const Settings settings = Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml");
  const auto odds_of_unknown = [&](double slow, double fast) {
    m.observed << 10 * (1 + slow), 10 * (1 + fast), 10 * (1 + slow), 10 * (1 + fast);
    set_unknown_gap(m, {VectorXd::Zero(1), VectorXd::Ones(1), VectorXd::Zero(1), VectorXd::Ones(1)}, settings);
    return unknown_evidence(m, settings).log_evidence - effect_evidence(m, {&m.effects[0]}).log_evidence;
  };
  EXPECT_GT(odds_of_unknown(0.12, 0.02), 10);  // five standard deviations off on four rows
  EXPECT_LT(odds_of_unknown(0.08, 0.08), -1);
  EXPECT_NEAR(m.unknown.back().weight, settings.unknown_kin_share, 1e-15);
  m.rows[2].observable = m.rows[3].observable = "shaft_speed";  // no kin: what it shows has a name
  EXPECT_LT(odds_of_unknown(0.12, 0.02), 10);
  EXPECT_EQ(m.unknown.back().weight, 0);
}

// Of two observables with one row each the worse one's chance counts twice; a strength takes up what its observable can
// show of it, here the mean of two rows, and leaves their difference, of variance 2 s^2, with one degree of freedom.
TEST(GapFit, OfEachObservable) {
  VectorXd y(4);
  y << 10.5, 11, 12, 13;
  TableModel m = linear_model(y, {}, 0, 1);
  m.noise = MatrixXd::Identity(4, 4) * 0.25;
  m.rows[0].observable = m.rows[1].observable = "restitution";
  m.rows[2].observable = m.rows[3].observable = "wall_angle";
  Fit fit = fit_of(m, ModelEvidence());
  EXPECT_NEAR(fit.all, vielto::chi2_exceedance((0.25 + 1 + 4 + 9) / 0.25, 4), 1e-12);
  EXPECT_NEAR(fit.worst, 2 * vielto::chi2_exceedance((4 + 9) / 0.25, 2), 1e-12);
  EXPECT_EQ(fit.observable, "wall_angle");

  VectorXd a(4);
  a << 0, 0, 1, 1;
  TableModel with = linear_model(y, {a}, 0, 5);
  with.noise = m.noise;
  with.rows = m.rows;
  const ModelEvidence e = effect_evidence(with, {&with.effects[0]});
  fit = fit_of(with, e);
  EXPECT_NEAR(fit.all, vielto::chi2_exceedance((0.25 + 1 + 0.5) / 0.25, 3), 1e-9);
  EXPECT_EQ(fit.observable, "restitution");
  with.observed[3] = 16;  // mean 14, each 2 off
  fit = fit_of(with, effect_evidence(with, {&with.effects[0]}));
  EXPECT_EQ(fit.observable, "wall_angle");
  EXPECT_NEAR(fit.worst / (2 * vielto::chi2_exceedance(16 / (2 * 0.25), 1)), 1, 1e-6);
}

// Under a model that holds, a stated chance is met: the worst of three correlated observables is rarer than 5 % in no
// more than 5 % of the tables, and in most of that (Bonferroni), within three standard deviations of 2000 draws.
TEST(GapFit, StatedChanceHolds) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  VectorXd a(6);
  a << 1, 2, 0.5, -1, 0.3, 1;
  TableModel m = linear_model(VectorXd::Constant(6, 10), {a}, -20, 20);
  m.noise = MatrixXd::Identity(6, 6) * 0.2 + MatrixXd::Constant(6, 6, 0.1);
  const MatrixXd half = m.noise.llt().matrixL();
  const char* names[] = {"restitution", "wall_angle", "power"};
  for (std::size_t i = 0; i < 6; ++i) m.rows[i].observable = names[i / 2];
  ModelEvidence e;
  e.effects = {"a"};
  e.posterior = {{{0.4}, 1}};  // a node beside the best: one step of least squares leads there
  const int draws = 2000;
  int rare = 0;
  for (int d = 0; d < draws; ++d) {
    VectorXd z(6);
    for (double& x : z) x = normal(random);
    m.observed = m.baseline + half * z;
    rare += fit_of(m, e).worst < 0.05;
  }
  EXPECT_LT(rare, draws * 0.05 + 3 * std::sqrt(draws * 0.05));
  EXPECT_GT(rare, draws * 0.03);
}

// Stated errors of the smoothed values hold: over many noisy libraries the squared error over the stated variance is 1.
TEST(GapSmoothing, StatedErrorsHold) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double sum = 0;
  constexpr int kLibraries = 200;
  for (int l = 0; l < kLibraries; ++l) {
    std::vector<Point> points;
    VectorXd v(9);
    for (int i = 0; i < 9; ++i) {
      points.push_back({0, VectorXd::Constant(1, i / 8.0), {}});
      v[i] = std::sin(2 * i / 8.0) + 0.05 * normal(random);
    }
    const GaussianProcess gp(GaussianProcess::Form::level, points, v, MatrixXd::Identity(9, 9) * 0.0025);
    const auto p = gp.at({{0, VectorXd::Constant(1, 0.4), {}}});
    sum += std::pow(p.mean[0] - std::sin(0.8), 2) / p.covariance(0, 0);
  }
  // Standard deviation of the mean of 200 chi^2: 0.1; the chosen kernel adds to either side.
  EXPECT_GT(sum / kLibraries, 0.5);
  EXPECT_LT(sum / kLibraries, 1.7);
}

TEST(GapDiscrepancy, RecoversItsSize) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::vector<LawDifference> laws;
  for (int l = 0; l < 30; ++l) {
    LawDifference law;
    const double shared = normal(random);
    law.difference.resize(6);
    for (int i = 0; i < 6; ++i) {
      law.c.push_back(VectorXd::Constant(1, i / 5.0));
      law.difference[i] = 0.05 * shared + 0.01 * normal(random);
    }
    law.noise = MatrixXd::Identity(6, 6) * 0.0001;
    laws.push_back(law);
  }
  const Discrepancy d = estimate_discrepancy(laws);
  // 30 laws give a standard deviation to 1/sqrt(60) = 13 %; three of those.
  EXPECT_NEAR(d.sd, 0.05, 0.02);
  EXPECT_GT(d.common, 0.5);
  // Three laws with the same scatter: uncertain, therefore larger.
  laws.resize(3);
  double squares = 0;
  for (const LawDifference& law : laws) squares += law.difference.squaredNorm() / 18;
  EXPECT_GT(estimate_discrepancy(laws).sd, std::sqrt(std::max(0.0, squares - 0.0001)));
}

// Without a law the prior stands: half normal with a spread of 0.2, of which
// the root of the mean square is 0.2 (cut off at 0.47, beyond which 2 % lie
// with 10 % of the mean square); laws that differ by nothing leave far less.
TEST(GapDiscrepancy, PriorIsHalfNormal) {
  EXPECT_NEAR(estimate_discrepancy({}).sd, 0.2, 0.02);
  LawDifference none;
  none.c = {VectorXd::Zero(1)};
  none.difference = VectorXd::Zero(1);
  none.noise = MatrixXd::Constant(1, 1, 1e-4);
  EXPECT_LT(estimate_discrepancy({none, none, none}).sd, 0.05);
  EXPECT_GT(estimate_discrepancy({none, none, none}).sd, 0.005);
}

}  // namespace

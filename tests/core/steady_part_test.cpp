// SPDX-License-Identifier: GPL-2.0-or-later
// The steady part of synthetic signals with a known start-up: AR(1) noise of unit long-run spread of a turn mean,
// plus start_up * exp(-turn / e_folding).
#include "core/steady_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace {

constexpr int kPeriod = 72;

// `start_up` and `drift` (a turn) in units of the standard deviation of a turn mean.
struct Case {
  double rho;
  int turns;
  double start_up = 0, e_folding = 1, drift = 0;
};

std::vector<double> signal(const Case& c, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  // AR(1) with unit innovations: long-run variance 1/(1-rho)^2, so a turn mean has 1/((1-rho)^2 period).
  const double turn_sd = 1 / ((1 - c.rho) * std::sqrt(kPeriod));
  double noise = normal(random) / std::sqrt(1 - c.rho * c.rho);
  std::vector<double> x;
  for (int i = 0; i < c.turns * kPeriod; ++i) {
    const double turn = (i + 0.5) / kPeriod;
    x.push_back(noise / turn_sd + c.start_up * std::exp(-turn / c.e_folding) + c.drift * turn);
    noise = c.rho * noise + normal(random);
  }
  return x;
}

struct Outcome {
  double accepted = 0;  // share
  double left_out = 0;  // mean number of turns left out, of the accepted
  double bias = 0;      // mean error of the accepted, over the standard deviation of a mean over all turns
  double mean_kept = 0;
};

Outcome outcome(const Case& c, int repeats) {
  std::mt19937_64 random(17);
  Outcome o;
  for (int r = 0; r < repeats; ++r) {
    const auto x = signal(c, random);
    const auto part = vielto::find_steady_part(x, kPeriod);
    if (part.verdict != vielto::Steadiness::steady) continue;
    o.accepted += 1;
    o.left_out += part.first;
    o.mean_kept += part.count;
    o.bias +=
        std::accumulate(x.begin() + part.first * kPeriod, x.end(), 0.0) / (part.count * kPeriod) * std::sqrt(c.turns);
  }
  o.left_out /= o.accepted;
  o.mean_kept /= o.accepted;
  o.bias /= o.accepted;
  o.accepted /= repeats;
  return o;
}

// Worked by hand: Y = 9, 1, 2, 3, 2. Sums of squares about the mean of the rest, over the square of their number:
//   d = 0: mean 3.4, 41.2 / 25 = 1.648      d = 1: mean 2, 2 / 16 = 0.125      d = 2: mean 7/3, 0.6667 / 9 = 0.0741
TEST(SteadyPart, MarginalStandardErrorByHand) {
  EXPECT_EQ(vielto::mser_truncation({9, 1, 2, 3, 2}, 0), 0);
  EXPECT_EQ(vielto::mser_truncation({9, 1, 2, 3, 2}, 1), 1);
  EXPECT_EQ(vielto::mser_truncation({9, 1, 2, 3, 2}, 2), 2);
  EXPECT_EQ(vielto::mser_truncation({4, 4, 4, 4}, 2), 0);  // nothing to gain
}

TEST(SteadyPart, TurnMeansByHand) {
  EXPECT_EQ(vielto::turn_means({1, 3, 5, 7, 9, 9}, 2), (std::vector<double>{2, 6, 9}));
}

// The promise of the header. Tolerance: the promise is an upper bound, 1000 repeats resolve it to 0.8 %.
TEST(SteadyPart, SteadyNoiseIsRefusedInAtMostSixPercent) {
  for (const double rho : {0.0, 0.9, 0.97})
    for (const int turns : {5, 8, 12, 20}) {
      const Outcome o = outcome({rho, turns}, 1000);
      EXPECT_LE(1 - o.accepted, 0.06) << "rho " << rho << ", " << turns << " turns";
      // No bias without a start-up: within three standard errors, 3/sqrt(1000), of a mean that varies by up to 1.3.
      EXPECT_NEAR(o.bias, 0, 0.13) << "rho " << rho << ", " << turns << " turns";
      EXPECT_GE(o.mean_kept, 0.75 * turns) << "rho " << rho << ", " << turns << " turns";
    }
}

// A start-up over within a turn (30 standard deviations, e-folding 0.3 turns: 9 in the first turn's mean, 0.3 in the
// second) is left out, always, and leaves no bias above a third of the standard deviation; untreated it would leave
// 9/sqrt(turns).
TEST(SteadyPart, ShortStartUpIsLeftOutWithoutBias) {
  for (const double rho : {0.0, 0.9, 0.97})
    for (const int turns : {5, 8, 12, 20}) {
      const Outcome o = outcome({rho, turns, 30, 0.3}, 300);
      EXPECT_GE(o.left_out, 1) << "rho " << rho << ", " << turns << " turns";
      EXPECT_GE(o.accepted, 0.9) << "rho " << rho << ", " << turns << " turns";
      EXPECT_LT(std::fabs(o.bias), 0.33) << "rho " << rho << ", " << turns << " turns";
    }
}

// e-folding one turn: from 12 turns on the bias is below half a standard deviation; untreated it would be
// 30/sqrt(turns).
TEST(SteadyPart, StartUpOfATurnIsLeftOutFromTwelveTurnsOn) {
  for (const double rho : {0.0, 0.9, 0.97})
    for (const int turns : {12, 20}) {
      const Outcome o = outcome({rho, turns, 30, 1}, 300);
      EXPECT_GE(o.left_out, 2);
      EXPECT_GE(o.accepted, 0.85) << "rho " << rho << ", " << turns << " turns";
      EXPECT_LT(std::fabs(o.bias), 0.5) << "rho " << rho << ", " << turns << " turns";
    }
}

// Records that never get steady. Detection rates are what they are: a drift of two standard deviations of a turn mean
// per turn is seen in four of five records of twelve turns, ten of them practically always.
TEST(SteadyPart, DriftIsRefused) {
  EXPECT_LE(outcome({0.0, 12, 0, 1, 2}, 300).accepted, 0.05);
  EXPECT_LE(outcome({0.9, 12, 0, 1, 2}, 300).accepted, 0.2);
  EXPECT_LE(outcome({0.9, 8, 0, 1, 10}, 300).accepted, 0.05);
  EXPECT_LE(outcome({0.97, 12, 0, 1, 10}, 300).accepted, 0.05);
}

// A start-up as long as the record (e-folding 3 turns in 5) leaves nothing to average.
TEST(SteadyPart, StartUpAsLongAsTheRecordIsRefused) {
  EXPECT_LE(outcome({0.0, 5, 30, 3}, 300).accepted, 0.05);
  EXPECT_LE(outcome({0.9, 5, 30, 3}, 300).accepted, 0.35);
}

TEST(SteadyPart, FewerTurnsThanAskedForAreNotEnough) {
  const std::vector<double> x(4 * kPeriod, 1.0);
  const auto part = vielto::find_steady_part(x, kPeriod, 5);
  EXPECT_EQ(part.verdict, vielto::Steadiness::too_few_turns);
  EXPECT_EQ(part.count, 4);
  EXPECT_EQ(vielto::find_steady_part({}, kPeriod, 3).verdict, vielto::Steadiness::too_few_turns);
}

// What is asked for is left over: with 8 turns of which 7 are asked, one turn at most is left out.
TEST(SteadyPart, LeavesTheTurnsAskedFor) {
  std::mt19937_64 random(3);
  for (int r = 0; r < 100; ++r) {
    const auto part = vielto::find_steady_part(signal({0.5, 8, 30, 0.3}, random), kPeriod, 7);
    EXPECT_EQ(part.first, 1);
    EXPECT_EQ(part.count, 7);
  }
}

TEST(SteadyPart, RefusesPartOfATurn) {
  EXPECT_THROW(vielto::find_steady_part(std::vector<double>(100, 1.0), kPeriod), std::invalid_argument);
  EXPECT_THROW(vielto::find_steady_part(std::vector<double>(5 * kPeriod, 1.0), kPeriod, 2), std::invalid_argument);
}

}  // namespace

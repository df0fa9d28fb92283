// SPDX-License-Identifier: GPL-2.0-or-later
// Records that go on until the rule says that their mean is known, with a mean known in closed form: AR(1) noise about
// a signal that repeats with the turn, a start-up that dies away, stick-slip bursts, and a drift, which has no mean.
#include "core/stopping_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace {

constexpr int kPeriod = 24, kMostTurns = 200, kRepeats = 250;
constexpr double kTarget = 0.02;

typedef std::mt19937_64 Random;
typedef std::function<double(int sample)> Record;

// Standard deviation 1.
Record ar1(double rho, Random& random) {
  double x = std::normal_distribution<double>()(random);
  return [=, &random](int) mutable {
    const double now = x;
    x = rho * x + std::sqrt(1 - rho * rho) * std::normal_distribution<double>()(random);
    return now;
  };
}

// Noise whose mean over `turns` has the standard deviation kTarget, about a mean of 1 that repeats with the turn.
Record noisy(double rho, double turns, Random& random) {
  const double tau = (1 + rho) / (1 - rho), sd = kTarget * std::sqrt(turns * kPeriod / tau);
  return [=, noise = ar1(rho, random)](int i) { return 1 + 0.3 * std::sin(2 * M_PI * i / kPeriod) + sd * noise(i); };
}

/* Load that grows by 1 a sample and slips to 0 when it has lasted T samples, T from a gamma distribution of shape 2 and
   scale 6. Renewal theory: a sample falls into a ramp with a chance proportional to its length, so that the mean is
   E[T(T-1)/2]/E[T], with T the whole number of samples 0 ... T-1. */
struct StickSlip {
  explicit StickSlip(Random& r) : random(r) {}
  int length() { return 1 + static_cast<int>(std::gamma_distribution<double>(2, 6)(random)); }
  double operator()(int) {
    if (at == last) at = 0, last = length();
    return at++;
  }
  Random& random;
  int at = 0, last = 0;
};

// P(floor(G) = k) of G of shape 2 and scale 6, from its distribution function 1 - (1 + g/6) exp(-g/6).
double stick_slip_mean() {
  const auto below = [](double g) { return 1 - (1 + g / 6) * std::exp(-g / 6); };
  double ramps = 0, lengths = 0;
  for (int k = 0; k < 400; k++) {
    const double p = below(k + 1) - below(k), length = k + 1;
    ramps += p * length * (length - 1) / 2;
    lengths += p * length;
  }
  return ramps / lengths;
}

struct Outcome {
  double ended = 0;      // share of records that the rule ended
  double covered = 0;    // of these: share whose mean +- u95 holds the true mean
  double error = 0;      // root mean square of (mean - true)/true
  double turns = 0;      // mean length
  double last_turn = 0;  // root mean square of (mean - that of the last turn)/true
};

Outcome outcome(double truth, const std::function<Record(Random&)>& make, int most = kMostTurns,
                int least = vielto::kLeastAveragedTurns) {
  Random random(11);
  Outcome o;
  for (int r = 0; r < kRepeats; r++) {
    const Record record = make(random);
    vielto::StoppingRule rule(kPeriod, kTarget, least);
    for (int i = 0; i < most * kPeriod && !rule.known(); i++) rule.add(record(i));
    if (!rule.known()) continue;
    const vielto::MeanUncertainty& mean = rule.last().mean;
    const double off = mean.mean - truth;
    o.ended += 1;
    o.covered += std::fabs(off) <= mean.u95();
    o.error += std::pow(off / truth, 2);
    o.turns += rule.turns();
  }
  o.covered /= o.ended, o.turns /= o.ended, o.error = std::sqrt(o.error / o.ended), o.ended /= kRepeats;
  return o;
}

struct Case {
  std::string name;
  double rho, turns, start_up;
  int least = vielto::kLeastAveragedTurns;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class StoppingRule : public testing::TestWithParam<Case> {};

/* What the header states. A share of 0.9 in 250 records is resolved to 1.9 %: the bounds lie two to three of these
   below the shares stated there. The error of the mean is below the target in root mean square. */
TEST_P(StoppingRule, EndsWithTheMeanKnown) {
  const Case c = GetParam();
  const Outcome o = outcome(
      1,
      [&](Random& random) -> Record {
        return [&c, noise = noisy(c.rho, c.turns, random)](int i) {
          return noise(i) + c.start_up * std::exp(-i / (1.5 * kPeriod));
        };
      },
      kMostTurns, c.least);
  EXPECT_GT(o.ended, 0.98);
  EXPECT_GT(o.covered, 0.83);
  EXPECT_LT(o.error, kTarget);
  EXPECT_GE(o.turns, c.turns);                          // no shorter than the noise asks for
  EXPECT_LT(o.turns, 2.5 * c.turns + 6 + c.least - 3);  // the upper limit of u costs turns, but no more than this
}

INSTANTIATE_TEST_SUITE_P(Noise, StoppingRule,
                         testing::Values(Case{"WhiteShort", 0, 4, 0}, Case{"WhiteLong", 0, 20, 0},
                                         Case{"CorrelatedShort", 0.8, 4, 0}, Case{"CorrelatedLong", 0.8, 20, 0},
                                         Case{"AlmostATurn", 0.92, 20, 0}, Case{"StartUp", 0.8, 8, 0.3},
                                         // quarters of a turn, of which eight are averaged at least
                                         Case{"Quarters", 0.8, 2, 0, 8}, Case{"QuartersAlmostATurn", 0.92, 20, 0, 8},
                                         Case{"QuartersAfterAStartUp", 0.8, 6, 0.8, 8}),
                         [](const auto& one) { return one.param.name; });

// Bursts: skew, and a variance that comes in with the rare long ramps, so that the rule does worse; bounds as above.
TEST(StoppingRuleOfBursts, EndsWithTheMeanKnown) {
  const double truth = 30 + stick_slip_mean();
  const Outcome o = outcome(truth, [](Random& random) -> Record {
    return [slip = StickSlip(random)](int i) mutable { return 30 + slip(i); };
  });
  EXPECT_GT(o.ended, 0.94);
  EXPECT_GT(o.covered, 0.72);
  EXPECT_LT(o.error, 1.5 * kTarget);
}

// The mean moves by the target in each turn: there is none to be known.
TEST(StoppingRuleOfDrift, DoesNotEnd) {
  for (const double turns : {8., 20.}) {
    const Outcome o = outcome(
        1,
        [&](Random& random) -> Record {
          return [noise = noisy(0.8, turns, random)](int i) { return noise(i) + kTarget * i / kPeriod; };
        },
        40);
    EXPECT_LT(o.ended, 0.15);
  }
}

// Three turns are averaged at least, and the rule looks twice; 72 samples at tau = 1 are enough.
TEST(StoppingRule, EndsAConstantAfterFourTurns) {
  vielto::StoppingRule rule(kPeriod, kTarget);
  int i = 0;
  for (; !rule.known() && i < 1000; i++) rule.add(5 + std::cos(2 * M_PI * i / kPeriod));
  EXPECT_EQ(i, 4 * kPeriod);
  EXPECT_NEAR(rule.last().mean.mean, 5, 1e-12);
}

// Quarters: eight, and one for the second look.
TEST(StoppingRule, EndsAConstantAfterNineQuarters) {
  vielto::StoppingRule rule(kPeriod, kTarget, 8);
  int i = 0;
  for (; !rule.known() && i < 1000; i++) rule.add(5 + std::cos(2 * M_PI * i / kPeriod));
  EXPECT_EQ(i, 9 * kPeriod);
}

// White noise of one value a turn, standard deviation 0.4 about 1: u = target after (0.4/0.02)^2 = 400 turns.
TEST(StoppingRule, TellsHowManyTurnsAreNeeded) {
  Random random(3);
  std::normal_distribution<double> normal(1, 0.4);
  vielto::StoppingRule rule(1, kTarget);
  for (int i = 0; i < 200; i++) rule.add(normal(random));
  EXPECT_FALSE(rule.known());
  EXPECT_GT(rule.last().turns_needed, 300);
  EXPECT_LT(rule.last().turns_needed, 1200);  // the estimate has a scatter, and its upper limit is taken
}

}  // namespace

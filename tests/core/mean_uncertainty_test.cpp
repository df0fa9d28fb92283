// SPDX-License-Identifier: GPL-2.0-or-later
// The uncertainty of the mean of autocorrelated noise, against AR(1) noise, whose variance of the mean is known:
//   var(mean) = sigma^2/N ((1+rho)/(1-rho) - 2 rho (1-rho^N) / (N (1-rho)^2)).
#include "core/mean_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace {

constexpr int kPeriod = 72;
const double kPi = std::acos(-1.0);

double ar1_variance_of_mean(double rho, double n) {
  return ((1 + rho) / (1 - rho) - 2 * rho * (1 - std::pow(rho, n)) / (n * (1 - rho) * (1 - rho))) / n;
}

// AR(1) noise of unit variance and mean 0, on a swing that repeats with the turn.
std::vector<double> ar1(double rho, int turns, double swing, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> x;
  double value = normal(random);
  for (int i = 0; i < turns * kPeriod; ++i) {
    x.push_back(value + swing * std::sin(2 * kPi * i / kPeriod * 4));
    value = rho * value + std::sqrt(1 - rho * rho) * normal(random);
  }
  return x;
}

struct Coverage {
  double covered = 0;         // share of 95 % intervals that hold the true mean, 0
  double variance_ratio = 0;  // mean u^2 over the true variance of the mean
  double samples = 0;         // effective samples, true
};

Coverage coverage(double rho, int turns, int repeats) {
  std::mt19937_64 random(static_cast<unsigned>(1000 * rho) + 7919u * static_cast<unsigned>(turns));
  Coverage result;
  const double variance = ar1_variance_of_mean(rho, turns * kPeriod);
  for (int r = 0; r < repeats; ++r) {
    const auto m = vielto::mean_uncertainty(ar1(rho, turns, 10, random), kPeriod);
    result.covered += (std::fabs(m.mean) <= m.u95() ? 1.0 : 0.0) / repeats;
    result.variance_ratio += m.u * m.u / variance / repeats;
  }
  result.samples = 1 / variance;
  return result;
}

TEST(Student, QuantileInClosedForm) {
  // 1 degree of freedom: tan(pi (p - 1/2)); 2: (2p-1) sqrt(2 / (4 p (1-p))); very many: the normal
  // distribution's 1.959964.
  EXPECT_NEAR(vielto::student_quantile(0.975, 1), std::tan(kPi * 0.475), 1e-8);
  EXPECT_NEAR(vielto::student_quantile(0.975, 2), 0.95 * std::sqrt(2 / (4 * 0.975 * 0.025)), 1e-9);
  EXPECT_NEAR(vielto::student_quantile(0.975, 1e7), 1.959964, 2e-6);
}

TEST(Student, TwoSidedProbabilityInClosedForm) {
  EXPECT_NEAR(vielto::student_two_sided(1, 1), 0.5, 1e-12);                      // 1 - 2 atan(t)/pi
  EXPECT_NEAR(vielto::student_two_sided(-2, 2), 1 - 2 / std::sqrt(6.0), 1e-12);  // 1 - t/sqrt(2+t^2)
  EXPECT_NEAR(vielto::student_two_sided(0, 3.7), 1, 1e-12);
}

TEST(MeanUncertainty, SwingThatRepeatsWithTheTurnAddsNoUncertainty) {
  std::vector<double> x;
  for (int i = 0; i < 5 * kPeriod; ++i) x.push_back(3 + 2 * std::cos(2 * kPi * i / kPeriod));
  const auto m = vielto::mean_uncertainty(x, kPeriod);
  EXPECT_NEAR(m.mean, 3, 1e-12);
  EXPECT_LE(m.u, 1e-8);
  EXPECT_GT(m.u, 0);
}

TEST(MeanUncertainty, WhiteNoiseHasSigmaOverRootN) {
  std::mt19937_64 random(5);
  const auto m = vielto::mean_uncertainty(ar1(0, 50, 10, random), kPeriod);
  // N = 3600: sigma estimated to 1.2 %, tau to sqrt(2*3/N) = 4 %, and the sequence ends on a positive pair: 10 % in u.
  EXPECT_NEAR(m.u * std::sqrt(50.0 * kPeriod), 1, 0.1);
  EXPECT_NEAR(m.correlation_time, 1, 0.2);
}

// The promise of the header: 95 % from 10 effective samples on, for three turns and for ten, without and with
// correlation. Tolerance: three binomial standard deviations of 1000 repeats (2.1 %) and 1 % for the short window.
TEST(MeanUncertainty, IntervalCoversTheMeanFromTenEffectiveSamplesOn) {
  for (const double rho : {0.0, 0.5, 0.9, 0.97, 0.99})
    for (const int turns : {3, 5, 10, 40}) {
      if (1 / ar1_variance_of_mean(rho, turns * kPeriod) < 10) continue;
      if (turns == 40 && rho < 0.9) continue;  // nothing new, only time
      const Coverage c = coverage(rho, turns, 1000);
      EXPECT_NEAR(c.covered, 0.95, 0.021 + 0.010) << "rho " << rho << ", " << turns << " turns";
      EXPECT_GT(c.variance_ratio, 0.9) << "rho " << rho << ", " << turns << " turns";
      EXPECT_LT(c.variance_ratio, 1.6) << "rho " << rho << ", " << turns << " turns";
    }
}

// Fewer effective samples than 10 carry less, as the header says; it takes more turns to do better.
// Tolerance: two binomial standard deviations of 1000 repeats.
TEST(MeanUncertainty, FewEffectiveSamplesCoverLess) {
  for (const double rho : {0.97, 0.99})
    for (const int turns : {3, 5, 10, 20}) {
      const Coverage c = coverage(rho, turns, 1000);
      if (c.samples >= 10) continue;
      EXPECT_GT(c.covered, c.samples > 3.8 ? 0.91 - 0.02 : 0.85 - 0.02)
          << "rho " << rho << ", " << turns << " turns, " << c.samples << " effective samples";
      EXPECT_LT(c.covered, 0.97);
    }
}

// Without an account of the correlation the interval would hold the mean in 35 % of cases: sqrt((1-rho)/(1+rho)) of its
// width.
TEST(MeanUncertainty, CorrelationWidensTheIntervalByTheKnownFactor) {
  std::mt19937_64 random(11);
  const double rho = 0.9;
  const auto m = vielto::mean_uncertainty(ar1(rho, 200, 0, random), kPeriod);
  // tau = (1+rho)/(1-rho) = 19; N = 14400, window about 3 tau: sqrt(2 * 120 / 14400) = 13 % in tau.
  EXPECT_NEAR(m.correlation_time, 19, 3 * 0.13 * 19);
  EXPECT_NEAR(m.u, std::sqrt(ar1_variance_of_mean(rho, 200 * kPeriod)), 0.2 * m.u);
}

TEST(MeanUncertainty, RefusesPartOfATurnAndASingleTurn) {
  EXPECT_THROW(vielto::mean_uncertainty(std::vector<double>(2 * kPeriod + 1, 1.0), kPeriod), std::invalid_argument);
  EXPECT_THROW(vielto::mean_uncertainty(std::vector<double>(kPeriod, 1.0), kPeriod), std::invalid_argument);
  EXPECT_THROW(
      vielto::mean_uncertainty(std::vector<double>(2 * kPeriod, 1.0), kPeriod, vielto::Remove::phase_means_and_trend),
      std::invalid_argument);
}

}  // namespace

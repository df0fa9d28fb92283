// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/mean_uncertainty.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unsupported/Eigen/SpecialFunctions>

namespace vielto {
namespace {

// A lower bound of tau, for signals that anticorrelate: no estimate from a short window is trusted below it.
constexpr double kLeastTau = 0.02;
constexpr double kResolution = 1e-9;

// Takes out the phase means, and the straight line through the turn means; `used` is 1 or 2, what that costs of each
// phase's turns. Scaled so that the variance of noise stays.
std::vector<double> residual(const std::vector<double>& signal, std::size_t period, Remove remove, double& used) {
  const std::size_t turns = signal.size() / period;
  std::vector<double> rest = signal;
  for (std::size_t phase = 0; phase < period; ++phase) {
    double mean = 0;
    for (std::size_t t = 0; t < turns; ++t) mean += signal[t * period + phase];
    mean /= static_cast<double>(turns);
    for (std::size_t t = 0; t < turns; ++t) rest[t * period + phase] -= mean;
  }
  used = 1;
  if (remove == Remove::phase_means_and_trend) {
    used = 2;
    const double middle = 0.5 * static_cast<double>(turns - 1);
    double sxy = 0, sxx = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const double x = static_cast<double>(i / period) - middle;
      sxy += x * rest[i];
      sxx += x * x;
    }
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= sxy / sxx * (static_cast<double>(i / period) - middle);
  }
  const double n = static_cast<double>(turns);
  for (double& value : rest) value *= std::sqrt(n / (n - used));
  return rest;
}

double autocovariance(const std::vector<double>& x, std::size_t lag) {
  return std::inner_product(x.begin() + static_cast<std::ptrdiff_t>(lag), x.end(), x.begin(), 0.0) /
         static_cast<double>(x.size());
}

}  // namespace

double MeanUncertainty::u95() const { return student_quantile(0.975, dof) * u; }

MeanUncertainty mean_uncertainty(const std::vector<double>& signal, int period, Remove remove) {
  const std::size_t least_turns = remove == Remove::phase_means ? 2 : 3;
  const auto per = static_cast<std::size_t>(std::max(period, 1));
  if (signal.size() % per != 0 || signal.size() < least_turns * per)
    throw std::invalid_argument(
        "mean_uncertainty: the signal must hold whole turns, at least two (three with a trend)");

  double used = 1;
  const std::vector<double> x = residual(signal, per, remove, used);
  const double n = static_cast<double>(x.size());
  const double variance = autocovariance(x, 0);
  double twice_pairs = 0, last_pair = std::numeric_limits<double>::infinity();
  std::size_t window = 0;
  for (std::size_t lag = 0; lag + 1 < x.size() / 2; lag += 2) {
    const double pair = autocovariance(x, lag) + autocovariance(x, lag + 1);
    if (pair <= 0) break;
    last_pair = std::min(last_pair, pair);
    twice_pairs += 2 * last_pair;
    window = lag + 1;
  }
  const double width = 2.0 * static_cast<double>(window) + 1;

  MeanUncertainty result;
  result.mean = std::accumulate(signal.begin(), signal.end(), 0.0) / n;
  const double tau = variance > 0 ? std::max(twice_pairs / variance - 1, kLeastTau) : 1;
  result.u = std::max(std::sqrt(variance * tau / n * (1 + used * width / n)), kResolution * std::fabs(result.mean));
  result.dof = std::max(1.0, n / width - (used - 1));
  result.correlation_time = tau;
  result.effective_samples = n / tau;
  return result;
}

double student_two_sided(double t, double dof) {
  // I_x(dof/2, 1/2) with x = dof/(dof + t^2) is the probability of both tails.
  using One = Eigen::Array<double, 1, 1>;
  return Eigen::betainc(One(0.5 * dof), One(0.5), One(dof / (dof + t * t)))(0);
}

double student_quantile(double probability, double dof) {
  const double tails = 2 * (1 - probability);
  double low = 0, high = 1;
  while (student_two_sided(high, dof) > tails) high *= 2;
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (student_two_sided(middle, dof) > tails ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/steady_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/mean_uncertainty.h"

namespace vielto {

std::vector<double> turn_means(const std::vector<double>& signal, int period) {
  std::vector<double> means;
  for (auto turn = signal.begin(); turn != signal.end(); turn += period)
    means.push_back(std::accumulate(turn, turn + period, 0.0) / period);
  return means;
}

int mser_truncation(const std::vector<double>& means, int most) {
  double best = std::numeric_limits<double>::infinity();
  int truncation = 0;
  for (int d = 0; d <= most; ++d) {
    const double n = static_cast<double>(means.size()) - d;
    const double mean = std::accumulate(means.begin() + d, means.end(), 0.0) / n;
    double squares = 0;
    for (auto y = means.begin() + d; y != means.end(); ++y) squares += (*y - mean) * (*y - mean);
    if (const double mser = squares / (n * n); mser < best) {
      best = mser;
      truncation = d;
    }
  }
  return truncation;
}

SteadyPart find_steady_part(const std::vector<double>& signal, int period, int minimum) {
  if (period < 1 || signal.size() % static_cast<std::size_t>(period) != 0 || minimum < kLeastAveragedTurns)
    throw std::invalid_argument("find_steady_part: needs whole turns, and at least three of them to average");
  const int turns = static_cast<int>(signal.size()) / period;
  SteadyPart part;
  if (turns < minimum) {
    part.count = turns;
    return part;
  }
  const std::vector<double> means = turn_means(signal, period);
  const int most = std::min(turns / 2, turns - minimum);
  part.first = mser_truncation(means, most);
  part.count = turns - part.first;

  const std::vector<double> kept(signal.begin() + part.first * period, signal.end());
  const MeanUncertainty noise = mean_uncertainty(kept, period, Remove::phase_means_and_trend);
  const double n = part.count;
  const double u_turn = noise.u * std::sqrt(n);  // of one turn's mean
  // Straight line through the kept means: sum of squared distances of 1 ... n from their middle is n(n^2-1)/12.
  const double spread = n * (n * n - 1) / 12;
  for (int i = 0; i < part.count; ++i) part.slope += (i - 0.5 * (n - 1)) * means[part.first + i] / spread;
  part.slope_p = student_two_sided(part.slope * std::sqrt(spread) / u_turn, noise.dof);

  part.verdict = Steadiness::steady;
  if (part.slope_p < kSteadyTestLevel) part.verdict = Steadiness::trend;
  if (most > 0 && part.first == most) {
    const double difference = (means[part.first - 1] - noise.mean) / (u_turn * std::sqrt(1 + 1 / n));
    if (student_two_sided(difference, noise.dof) < kSteadyTestLevel) part.verdict = Steadiness::start_up_reaches_limit;
  }
  return part;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the error of a mean power as a transmitter's record makes it, instead of one Gaussian draw: samples in time
// with correlated noise, a zero that drifts, the ripple of the turning rotor, and steps of the display.
//
// Equation: x_j = step round((P (1 + ripple sin(2 pi n t_j + phase)) + a_j + D t_j/T)/step), t_j = (j + 1/2)/rate, j <
// rate T; a AR(1) with correlation exp(-1/(rate tau)), error = mean x - P. Amplitudes: var(mean a) = (1 - drift) u^2
// and var(D/2) = drift u^2, so that the standard deviation of the error is the row's u (ripple and steps add what they
// do). step 0: no rounding. Units: P, u, step W; n, rate 1/s; T, tau s; ripple, drift 1.
#pragma once

#include <cmath>
#include <random>

namespace vielto::gap {

struct PowerSignal {
  double rate = 10, duration = 60, correlation = 2;
  double drift = 0.5;
  double ripple = 0.2;
  double step = 0.1;
};

// Variance of the mean of n samples of an AR(1) process over that of one sample.
inline double variance_of_mean(int n, double rho) {
  double sum = 1;
  for (int k = 1; k < n; ++k) sum += 2 * (1 - static_cast<double>(k) / n) * std::pow(rho, k);
  return sum / n;
}

inline double mean_error(const PowerSignal& s, double power, double speed, double u, std::mt19937_64& random) {
  constexpr double kTurn = 6.283185307179586;
  const int n = static_cast<int>(s.rate * s.duration);
  const double rho = std::exp(-1 / (s.rate * s.correlation));
  std::normal_distribution<double> normal;
  const double sigma = u * std::sqrt((1 - s.drift) / variance_of_mean(n, rho));
  const double drift = 2 * u * std::sqrt(s.drift) * normal(random);
  const double phase = std::uniform_real_distribution<double>(0, kTurn)(random);
  double a = sigma * normal(random), sum = 0;
  for (int j = 0; j < n; ++j) {
    const double t = (j + 0.5) / s.rate;
    const double x = power * (1 + s.ripple * std::sin(kTurn * speed * t + phase)) + a + drift * t / s.duration;
    sum += s.step > 0 ? s.step * std::round(x / s.step) : x;
    a = rho * a + std::sqrt(1 - rho * rho) * sigma * normal(random);
  }
  return sum / n - power;
}

}  // namespace vielto::gap

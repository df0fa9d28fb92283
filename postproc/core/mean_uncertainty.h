// SPDX-License-Identifier: GPL-2.0-or-later
// Standard uncertainty of the mean of an autocorrelated signal that repeats with the turn.
//
// The signal is x(i), i = 0 ... N-1, with `period` values a turn and whole turns only. Its mean over turns at each
// phase is taken out first: over whole turns it does not change the mean, and left in it would hide how fast the noise
// forgets.
//   u^2 = (sigma^2 / N) tau (1 + (2W+1)/N),   tau = 1 + 2 sum_{k=1..W} rho(k)
// with the autocorrelation rho of what is left, sigma^2 its variance (times n/(n-1) for n turns, for the phase means
// taken out). W is where Geyer's initial monotone sequence ends: the pair sums rho(2m) + rho(2m+1) are cut at the first
// one that is not positive and made non-increasing. The last factor is Wolff's correction for the mean taken out. The
// relative variance of u^2 is about 2(2W+1)/N (Madras and Sokal), that of chi^2 with dof = N/(2W+1) degrees of freedom:
//   95 % interval: mean +- t(0.975, dof) u.
// Measured coverage of that interval for AR(1) noise (tests/core/mean_uncertainty_test.cpp), by true effective samples
// N/tau: 95 % from 10 on, 91 to 94 % from 4 to 10, 85 % at 2. Below 10 the uncertainty is itself uncertain: average
// more turns.
//
// Sources: Geyer 1992, Statist. Sci. 7:473, section 3.3; Wolff 2004, Comput. Phys. Commun. 156:143, equation 49;
// Madras and Sokal 1988, J. Stat. Phys. 50:109, appendix C.
#pragma once

#include <vector>

namespace vielto {

struct MeanUncertainty {
  double mean = 0;               // unit of the signal
  double u = 0;                  // standard uncertainty (k = 1), same unit
  double dof = 0;                // degrees of freedom behind u, >= 1
  double correlation_time = 0;   // tau, in samples
  double effective_samples = 0;  // N / tau

  // Half width of the 95 % interval.
  double u95() const;
};

// What to take out of the signal before its autocorrelation is looked at.
enum class Remove { phase_means, phase_means_and_trend };

// Errors: std::invalid_argument unless `signal` holds whole turns of `period` values, at least two (three with trend).
// u is at least 1e-9 of the mean: a record's nine digits say no more.
MeanUncertainty mean_uncertainty(const std::vector<double>& signal, int period, Remove remove = Remove::phase_means);

// Quantile of Student's t distribution, 0.5 < probability < 1, dof > 0.
double student_quantile(double probability, double dof);

// Probability of an absolute value above abs(t).
double student_two_sided(double t, double dof);

}  // namespace vielto

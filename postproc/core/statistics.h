// SPDX-License-Identifier: GPL-2.0-or-later
// The few distributions that intervals and tests need.
#pragma once

namespace vielto {

constexpr double kNormal975 = 1.959963984540054;  // 97.5 % quantile of the standard normal distribution

// 97.5 % quantile of Student's t with `degrees_of_freedom` > 0: half the width of a 95 % interval in standard errors.
double t975(double degrees_of_freedom);

// Probability that a chi-squared variable with `degrees_of_freedom` > 0 exceeds `chi2`.
double chi2_exceedance(double chi2, double degrees_of_freedom);

// Expected largest magnitude of n >= 1 independent standard normal deviates,
// E max|z| = integral over x > 0 of 1 - (2 Phi(x) - 1)^n. A stated maximum relative error of n points divided by it
// estimates their relative standard deviation.
double expected_largest_magnitude(int n);

}  // namespace vielto

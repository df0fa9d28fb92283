// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/statistics.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

namespace vielto {

double t975(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

double chi2_exceedance(double chi2, double degrees_of_freedom) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees_of_freedom), chi2));
}

double expected_largest_magnitude(int n) {
  const auto exceedance = [n](double x) { return 1 - std::pow(std::erf(x / std::sqrt(2.0)), n); };
  // Beyond 12 standard deviations the integrand is below 1e-32 n.
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(exceedance, 0.0, 12.0, 10, 1e-12);
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: nonlinear least squares with standard errors, for any model f(b); `vielto fit` and the tests on the
// certified NIST StRD sets call this one function.
//
// Equation: minimise chi2(b) = (y - f(b))' V^-1 (y - f(b)), y the n observations, V their covariance (weights.h), b the
// p parameters. Covariance of the estimates: C = (J' V^-1 J)^-1 with J = df/db at the solution. C holds as it is if V
// is the true covariance of the observations; multiplied by s^2 = chi2/(n - p) if V is known up to a factor only.
//
// Method: trust region (Ceres, dense QR) from the given start, by Levenberg-Marquardt and by dogleg, with two initial
// radii each, then Gauss-Newton steps; the smallest chi2 is kept. The four runs differ in the valleys they can follow
// far from the solution, near it they agree. The options are the same for every model.
//
// Source: Bates & Watts, Nonlinear Regression Analysis and Its Applications (Wiley, 1988): sections 2.1 (tangent
// plane), 2.2.3 (relative offset).
#pragma once

#include <ceres/cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include <Eigen/Dense>

#include "equation/weights.h"

namespace vielto {

struct NonlinearFit {
  Eigen::VectorXd parameters;           // p
  Eigen::VectorXd residuals;            // n, y - f(b), in the unit of the observations
  Eigen::MatrixXd jacobian;             // n x p, df/db
  Eigen::MatrixXd covariance;           // p x p, C, without the factor s^2
  double chi2 = 0;                      // the residual sum of squares if every observation counts the same
  Eigen::Index degrees_of_freedom = 0;  // n - p
  double relative_offset = 0;  // |tangential part of the whitened residuals| / |whitened residuals|; 0 at a minimum

  // s^2; 0 if no degree of freedom is left.
  double residual_variance() const;
};

// `model`: one parameter block of p, n residuals which are the model values f(b); it returns false where f has no
// finite value. Errors: std::invalid_argument for sizes that do not fit or n < p; std::runtime_error if no strategy
// reaches a minimum (relative offset above 1e-4) or J loses rank there.
NonlinearFit nonlinear_least_squares(const ceres::CostFunction& model, const Eigen::VectorXd& observed,
                                     const Weights& weights, const Eigen::VectorXd& start);

// The same for a functor `template <class T> bool operator()(const T* b, T* f) const`, differentiated automatically.
template <class Functor>
NonlinearFit nonlinear_least_squares_of(const Functor& functor, const Eigen::VectorXd& observed, const Weights& weights,
                                        const Eigen::VectorXd& start) {
  const auto one_block = [&functor](const auto* const* b, auto* f) { return functor(b[0], f); };
  ceres::DynamicAutoDiffCostFunction<decltype(one_block)> model(new auto(one_block));
  model.AddParameterBlock(static_cast<int>(start.size()));
  model.SetNumResiduals(static_cast<int>(observed.size()));
  return nonlinear_least_squares(model, observed, weights, start);
}

}  // namespace vielto

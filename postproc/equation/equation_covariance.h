// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: how the errors of an equation fitted to a grid of measurements hang together, where only its largest error
// is known.
//
// The equation is linear in logarithms, ln P = X b with columns 1, ln l, ln n. Its error at a point has two parts:
//   the fitted coefficients' own error, s^2 H with the hat matrix H = X (X'X)^-1 X', for measurements scattered by s
//   about it; what the equation's form cannot follow, orthogonal to it and smooth: s^2 k M K M with M = I - H,
//     K_ij = exp(-d_ij^2/2), d the distance in steps of the grid (ln l and ln n each over its mean step).
// The booklet does not say how much of its 13.7 % is scatter of single measurements (which a fit averages out) and how
// much is want of form (which it keeps). All of it is taken as want of form, k making the mean variance s^2: the
// cautious choice, as it leaves u what doc/theory/equation.md says and only correlates neighbours. Correlations R_ij of
// that sum; covariance_ij = R_ij u_i u_j.
#pragma once

#include <Eigen/Dense>

namespace vielto {

// Correlation of the errors at points with fills `l` and speeds `n` (all > 0, at least 4 points, two values of each).
// Errors: std::invalid_argument for points that do not determine the equation.
Eigen::MatrixXd equation_error_correlation(const Eigen::VectorXd& l, const Eigen::VectorXd& n);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: weigh observations by their covariance V (n x n, unit of the observation squared).
// Equation: with V = L L' (Cholesky), L^-1 r has independent components of variance 1 if r has covariance V, so that
// r' V^-1 r = |L^-1 r|^2 (generalised least squares). L is sparse: independent rows cost n numbers, not n^2.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <vector>

namespace vielto {

class Weights {
 public:
  // Every observation counts the same: V is the unit matrix.
  static Weights equal(Eigen::Index n);
  // Independent observations with standard uncertainties u, all > 0. Errors: std::invalid_argument.
  static Weights independent(const Eigen::VectorXd& u);
  // Both triangles of V. Errors: std::invalid_argument if V is not positive definite (its correlations contradict each
  // other, or two rows are one and the same datum).
  static Weights correlated(const Eigen::SparseMatrix<double>& covariance);

  Eigen::Index size() const { return factor_.rows(); }
  // L^-1 m, for a vector or the columns of a matrix of n rows.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& m) const;
  // V^-1 m, and the diagonal of V^-1.
  Eigen::MatrixXd precision_times(const Eigen::MatrixXd& m) const;
  Eigen::VectorXd precision_diagonal() const;
  // The weights of the rows scaled by `scale` (of log values, say: scale = 1/value).
  Weights scaled(const Eigen::VectorXd& scale) const;

 private:
  Eigen::SparseMatrix<double> factor_;  // L
};

}  // namespace vielto

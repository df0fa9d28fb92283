// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/weights.h"

#include <Eigen/SparseCholesky>
#include <stdexcept>

namespace vielto {
namespace {

Eigen::SparseMatrix<double> diagonal(const Eigen::VectorXd& values) {
  Eigen::SparseMatrix<double> m(values.size(), values.size());
  m.reserve(Eigen::VectorXi::Ones(values.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) m.insert(i, i) = values[i];
  m.makeCompressed();
  return m;
}

}  // namespace

Weights Weights::equal(Eigen::Index n) { return independent(Eigen::VectorXd::Ones(n)); }

Weights Weights::independent(const Eigen::VectorXd& u) {
  if (!(u.array() > 0).all() || !u.allFinite()) throw std::invalid_argument("a standard uncertainty is not above 0");
  Weights w;
  w.factor_ = diagonal(u);
  return w;
}

Weights Weights::correlated(const Eigen::SparseMatrix<double>& covariance) {
  // Natural ordering: L itself whitens, not L of permuted rows.
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(covariance);
  Weights w;
  if (cholesky.info() == Eigen::Success) {
    w.factor_ = cholesky.matrixL();
    // A pivot this small is a difference of rounding errors: the rows before it determine the row fully.
    constexpr double kSmallestPivot = 1e-10;
    const Eigen::VectorXd pivots = w.factor_.diagonal().cwiseAbs2();
    const Eigen::VectorXd variances = covariance.diagonal();
    if ((pivots.array() > kSmallestPivot * variances.array()).all()) return w;
  }
  throw std::invalid_argument("the covariance matrix is not positive definite");
}

Eigen::MatrixXd Weights::whiten(const Eigen::MatrixXd& m) const {
  return factor_.triangularView<Eigen::Lower>().solve(m);
}

Eigen::MatrixXd Weights::precision_times(const Eigen::MatrixXd& m) const {
  return factor_.transpose().triangularView<Eigen::Upper>().solve(whiten(m));
}

Eigen::VectorXd Weights::precision_diagonal() const {
  const Eigen::Index n = size();
  if (factor_.nonZeros() == n) return factor_.diagonal().cwiseAbs2().cwiseInverse();
  Eigen::VectorXd diagonal(n);
  for (Eigen::Index i = 0; i < n; ++i) diagonal[i] = whiten(Eigen::VectorXd::Unit(n, i)).squaredNorm();
  return diagonal;
}

Weights Weights::scaled(const Eigen::VectorXd& scale) const {
  Weights w;
  w.factor_ = scale.asDiagonal() * factor_;
  return w;
}

}  // namespace vielto

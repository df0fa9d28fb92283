// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/equation_covariance.h"

#include <cmath>
#include <set>
#include <stdexcept>

namespace vielto {
namespace {

// Mean distance of neighbouring distinct values.
double mean_step(const Eigen::VectorXd& x) {
  const std::set<double> values(x.begin(), x.end());
  if (values.size() < 2) throw std::invalid_argument("an equation's errors need two fills and two speeds");
  return (*values.rbegin() - *values.begin()) / static_cast<double>(values.size() - 1);
}

}  // namespace

Eigen::MatrixXd equation_error_correlation(const Eigen::VectorXd& l, const Eigen::VectorXd& n) {
  const Eigen::Index points = l.size();
  if (points < 4) throw std::invalid_argument("an equation's errors need at least four points");
  Eigen::MatrixXd x(points, 3);
  x.col(0).setOnes();
  x.col(1) = l.array().log();
  x.col(2) = n.array().log();
  const double step_l = mean_step(x.col(1)), step_n = mean_step(x.col(2));
  const Eigen::MatrixXd hat = x * (x.transpose() * x).ldlt().solve(x.transpose());
  Eigen::MatrixXd smooth(points, points);
  for (Eigen::Index i = 0; i < points; ++i)
    for (Eigen::Index j = 0; j < points; ++j)
      smooth(i, j) =
          std::exp(-(std::pow((x(i, 1) - x(j, 1)) / step_l, 2) + std::pow((x(i, 2) - x(j, 2)) / step_n, 2)) / 2);
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(points, points) - hat;
  const Eigen::MatrixXd form = rest * smooth * rest;
  const double k = (static_cast<double>(points) - hat.trace()) / form.trace();
  const Eigen::MatrixXd sum = hat + k * form;
  const Eigen::VectorXd scale = sum.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * sum * scale.asDiagonal();
}

}  // namespace vielto

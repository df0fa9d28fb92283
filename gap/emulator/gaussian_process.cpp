// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/gaussian_process.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vielto::gap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd kernel_matrix(const GaussianProcess::Kernel& kernel, const std::vector<Point>& a,
                       const std::vector<Point>& b) {
  MatrixXd k(a.size(), b.size());
  for (Eigen::Index i = 0; i < k.rows(); ++i)
    for (Eigen::Index j = 0; j < k.cols(); ++j) k(i, j) = kernel(a[i], b[j]);
  return k;
}

}  // namespace

double GaussianProcess::Kernel::operator()(const Point& p, const Point& q) const {
  const double near = std::exp(-(p.c - q.c).squaredNorm() / (2 * length * length));
  if (form == Form::level) return plane * (1 + p.c.dot(q.c)) + a * a * near;
  const double over_conditions = common + (1 - common) * near;
  if (form == Form::parameters) {
    const double zz = p.z.dot(q.z);
    return (a * a * zz + quadratic * quadratic * zz * zz) * over_conditions;
  }
  // 1 at the end of the range whatever the saturation
  const auto amount = [&](double t) { return saturation > 0 ? t * (1 + saturation) / (std::fabs(t) + saturation) : t; };
  const double dt = (p.t - q.t) / length_t;
  return a * a * amount(p.t) * amount(q.t) * std::exp(-dt * dt / 2) * over_conditions;
}

GaussianProcess::GaussianProcess(Form form, std::vector<Point> points, const VectorXd& values, const MatrixXd& noise)
    : points_(std::move(points)) {
  const Eigen::Index n = values.size();
  if (n == 0 || static_cast<Eigen::Index>(points_.size()) != n || noise.rows() != n)
    throw std::invalid_argument("a Gaussian process needs one value and one noise for each point");
  centre_ = form == Form::level ? values.mean() : 0;
  const VectorXd v = values.array() - centre_;
  const double mean_noise = std::sqrt(noise.diagonal().mean());
  const double spread = std::max({std::sqrt(v.squaredNorm() / static_cast<double>(n)), mean_noise, 1e-12});
  double best = -std::numeric_limits<double>::infinity();
  const auto try_kernel = [&](const Kernel& kernel) {
    MatrixXd k = kernel_matrix(kernel, points_, points_) + noise;
    k.diagonal().array() += 1e-12 * (k.diagonal().mean() + spread * spread);
    Eigen::LLT<MatrixXd> factor(k);
    if (factor.info() != Eigen::Success) return;
    const MatrixXd l = factor.matrixL();
    const double log_likelihood = -0.5 * factor.matrixL().solve(v).squaredNorm() - l.diagonal().array().log().sum();
    if (log_likelihood <= best) return;
    best = log_likelihood;
    kernel_ = kernel;
    factor_ = factor;
  };
  Kernel kernel;
  kernel.form = form;
  if (form == Form::level) {
    kernel.plane = 100 * spread * spread;
    for (const double a : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0})
      for (const double length : {0.35, 0.7, 1.4}) {
        kernel.a = a * spread;
        kernel.length = length;
        try_kernel(kernel);
      }
  } else if (form == Form::parameters) {
    for (const double a : {0.03, 0.1, 0.3, 1.0, 3.0})
      for (const double q : {0.0, 0.3})
        for (const double common : {0.1, 0.5, 0.9})
          for (const double length : {0.35, 0.7, 1.4}) {
            kernel.a = a * spread;
            kernel.quadratic = q * a * spread;
            kernel.common = common;
            kernel.length = length;
            try_kernel(kernel);
          }
  } else {
    for (const double a : {0.03, 0.1, 0.3, 1.0, 3.0})
      for (const auto& [saturation, length_t] : {std::pair(0.0, 0.7), {0.0, 2.0}, {0.3, 2.0}, {0.1, 2.0}})
        for (const double common : {0.1, 0.5, 0.9})
          for (const double length : {0.35, 0.7, 1.4}) {
            kernel.a = a * spread;
            kernel.saturation = saturation;
            kernel.length_t = length_t;
            kernel.common = common;
            kernel.length = length;
            try_kernel(kernel);
          }
  }
  if (!std::isfinite(best)) throw std::runtime_error("the library's values allow no smoothing");
  solve(values);
}

void GaussianProcess::solve(const VectorXd& values) { weights_ = factor_.solve(VectorXd(values.array() - centre_)); }

GaussianProcess GaussianProcess::with_values(const VectorXd& values) const {
  GaussianProcess other = *this;
  if (kernel_.form == Form::level) other.centre_ = values.mean();
  other.solve(values);
  return other;
}

GaussianProcess::Prediction GaussianProcess::at(const std::vector<Point>& points) const {
  const MatrixXd cross = kernel_matrix(kernel_, points_, points);
  Prediction p;
  p.mean = (cross.transpose() * weights_).array() + centre_;
  p.covariance = kernel_matrix(kernel_, points, points) - cross.transpose() * factor_.solve(cross);
  // Rounding must not make a variance negative.
  p.covariance = (0.5 * (p.covariance + p.covariance.transpose())).eval();
  p.covariance.diagonal() = p.covariance.diagonal().cwiseMax(0);
  return p;
}

}  // namespace vielto::gap

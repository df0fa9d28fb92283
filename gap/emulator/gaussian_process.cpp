// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/gaussian_process.h"

#include <algorithm>
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

namespace {

using Kernel = GaussianProcess::Kernel;
using Form = GaussianProcess::Form;

constexpr double kLengths[] = {0.35, 0.7, 1.4}, kCommons[] = {0.1, 0.5, 0.9};

std::vector<double> amplitudes(Form form) {
  if (form == Form::level) return {0.003, 0.01, 0.03, 0.1, 0.3, 1.0};
  return {0.03, 0.1, 0.3, 1.0, 3.0};
}

// The kernels of one amplitude (of the values' spread).
std::vector<Kernel> kernels_of(Form form, double amplitude, double spread) {
  Kernel kernel;
  kernel.form = form;
  kernel.a = amplitude * spread;
  std::vector<Kernel> kernels;
  if (form == Form::level) {
    kernel.plane = 100 * spread * spread;
    for (const double length : kLengths) kernel.length = length, kernels.push_back(kernel);
    return kernels;
  }
  const auto over_conditions = [&] {
    for (const double common : kCommons)
      for (const double length : kLengths) {
        kernel.common = common;
        kernel.length = length;
        kernels.push_back(kernel);
      }
  };
  if (form == Form::parameters) {
    for (const double q : {0.0, 0.3}) kernel.quadratic = q * kernel.a, over_conditions();
    return kernels;
  }
  for (const auto& [saturation, length_t] : {std::pair(0.0, 0.7), {0.0, 2.0}, {0.3, 2.0}, {0.1, 2.0}}) {
    kernel.saturation = saturation;
    kernel.length_t = length_t;
    over_conditions();
  }
  return kernels;
}

}  // namespace

GaussianProcess::GaussianProcess(Form form, std::vector<Point> points, const VectorXd& values, const MatrixXd& noise)
    : points_(std::move(points)) {
  const Eigen::Index n = values.size();
  if (n == 0 || static_cast<Eigen::Index>(points_.size()) != n || noise.rows() != n)
    throw std::invalid_argument("a Gaussian process needs one value and one noise for each point");
  centre_ = form == Form::level ? values.mean() : 0;
  const VectorXd v = values.array() - centre_;
  const double mean_noise = std::sqrt(noise.diagonal().mean());
  const double spread = std::max({std::sqrt(v.squaredNorm() / static_cast<double>(n)), mean_noise, 1e-12});
  std::vector<Member> best;  // of each amplitude
  for (const double amplitude : amplitudes(form)) {
    std::optional<Member> of_amplitude;
    for (const Kernel& kernel : kernels_of(form, amplitude, spread))
      if (auto m = member(kernel, v, noise, spread);
          m && (!of_amplitude || m->log_likelihood > of_amplitude->log_likelihood))
        of_amplitude = std::move(m);
    if (of_amplitude) best.push_back(std::move(*of_amplitude));
  }
  if (best.empty()) throw std::runtime_error("the library's values allow no smoothing");
  average(std::move(best));
  solve(values);
}

std::optional<GaussianProcess::Member> GaussianProcess::member(const Kernel& kernel, const VectorXd& v,
                                                               const MatrixXd& noise, double spread) const {
  MatrixXd k = kernel_matrix(kernel, points_, points_) + noise;
  k.diagonal().array() += 1e-12 * (k.diagonal().mean() + spread * spread);
  Member m;
  m.kernel = kernel;
  m.factor.compute(k);
  if (m.factor.info() != Eigen::Success) return std::nullopt;
  const MatrixXd l = m.factor.matrixL();
  m.log_likelihood = -0.5 * m.factor.matrixL().solve(v).squaredNorm() - l.diagonal().array().log().sum();
  if (!std::isfinite(m.log_likelihood)) return std::nullopt;
  return m;
}

void GaussianProcess::average(std::vector<Member> candidates) {
  const auto most = std::max_element(candidates.begin(), candidates.end(), [](const Member& a, const Member& b) {
    return a.log_likelihood < b.log_likelihood;
  });
  if (most->kernel.form == Form::level) {
    members_ = {*most};
    return;
  }
  constexpr double kLeastPart = 0.01;  // of the most probable
  double sum = 0;
  for (Member& m : candidates) {
    m.probability = std::exp(m.log_likelihood - most->log_likelihood);
    if (m.probability >= kLeastPart) sum += m.probability;
  }
  for (Member& m : candidates) {
    if (m.probability < kLeastPart) continue;
    m.probability /= sum;
    members_.push_back(std::move(m));
  }
}

void GaussianProcess::solve(const VectorXd& values) {
  for (Member& m : members_) m.weights = m.factor.solve(VectorXd(values.array() - centre_));
}

GaussianProcess GaussianProcess::with_values(const VectorXd& values) const {
  GaussianProcess other = *this;
  if (members_.front().kernel.form == Form::level) other.centre_ = values.mean();
  other.solve(values);
  return other;
}

GaussianProcess::Prediction GaussianProcess::at(const Member& m, const std::vector<Point>& points) const {
  const MatrixXd cross = kernel_matrix(m.kernel, points_, points);
  Prediction p;
  p.mean = (cross.transpose() * m.weights).array() + centre_;
  p.covariance = kernel_matrix(m.kernel, points, points) - cross.transpose() * m.factor.solve(cross);
  return p;
}

GaussianProcess::Prediction GaussianProcess::at(const std::vector<Point>& points) const {
  Prediction p;
  if (members_.size() == 1) {
    p = at(members_.front(), points);
  } else {
    std::vector<Prediction> all;
    for (const Member& member : members_) all.push_back(at(member, points));
    p.mean = VectorXd::Zero(all[0].mean.size());
    p.covariance = MatrixXd::Zero(p.mean.size(), p.mean.size());
    for (std::size_t k = 0; k < all.size(); ++k) p.mean += members_[k].probability * all[k].mean;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const VectorXd d = all[k].mean - p.mean;
      p.covariance += members_[k].probability * (all[k].covariance + d * d.transpose());
    }
  }
  // Rounding must not make a variance negative.
  p.covariance = (0.5 * (p.covariance + p.covariance.transpose())).eval();
  p.covariance.diagonal() = p.covariance.diagonal().cwiseMax(0);
  return p;
}

}  // namespace vielto::gap

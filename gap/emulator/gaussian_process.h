// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: smooth a noisy simulated quantity over conditions and strength, with the error of the smoothed values.
//
// Equation (Rasmussen and Williams 2006, Gaussian Processes for Machine Learning, eqs. 2.25, 2.26, 2.30):
//   mean = K*' (K + N)^-1 v,   covariance = K** - K*' (K + N)^-1 K*
// with the noise covariance N of the values v known. A point is (t, c): t the strength over the largest one in the
// prior range, c the conditions in units of the library's range. Three kernels:
//   level       V (1 + c.c') + a^2 exp(-|c-c'|^2 / 2 l^2)   after the mean of v is taken out; V = (10 spread)^2: a free
//               plane
//   response    a^2 f(t) f(t') exp(-(t-t')^2 / 2 l_t^2) (w + (1-w) exp(-|c-c'|^2 / 2 l^2)):  0 at t = 0; f(t) = t, so
//               that it is nearly linear for large l_t, or f(t) = t (1+b)/(|t|+b), an effect that saturates beyond t =
//               b
//   parameters  (a^2 z.z' + q^2 (z.z')^2) (w + (1-w) exp(-|c-c'|^2 / 2 l^2)):  linear (and quadratic for q > 0) in z,
//               the calibrated parameters' distance from the baseline's in units of their spread
// b, q, l, l_t, w: for each amplitude a of a fixed grid the most probable (2.30). Amplitudes are averaged by their
// marginal likelihood, even in the logarithm before: the most probable alone would take an effect that nothing is known
// of for one of nothing (mean = sum_a p_a m_a, covariance = sum_a p_a (C_a + (m_a - mean)(m_a - mean)')). The level
// keeps its best: its runs are many. A redrawn library keeps kernels and p_a.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

namespace vielto::gap {

struct Point {
  double t = 0;
  Eigen::VectorXd c, z;
};

class GaussianProcess {
 public:
  enum class Form { level, response, parameters };
  struct Kernel {
    Form form = Form::level;
    double plane = 0, a = 0, saturation = 0, length = 1, length_t = 1, common = 0, quadratic = 0;
    double operator()(const Point& p, const Point& q) const;
  };
  struct Prediction {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };

  GaussianProcess() = default;
  // Chooses the kernel. `noise` is the covariance of `values`.
  GaussianProcess(Form form, std::vector<Point> points, const Eigen::VectorXd& values, const Eigen::MatrixXd& noise);
  // The same points and kernel with other values (a redrawn library).
  GaussianProcess with_values(const Eigen::VectorXd& values) const;

  Prediction at(const std::vector<Point>& points) const;

 private:
  // One kernel with its part of the average.
  struct Member {
    Kernel kernel;
    double log_likelihood = 0, probability = 1;
    Eigen::LLT<Eigen::MatrixXd> factor;
    Eigen::VectorXd weights;
  };

  // The member of this kernel, if its matrix has an inverse.
  std::optional<Member> member(const Kernel& kernel, const Eigen::VectorXd& v, const Eigen::MatrixXd& noise,
                               double spread) const;
  void average(std::vector<Member> candidates);
  Prediction at(const Member& member, const std::vector<Point>& points) const;
  void solve(const Eigen::VectorXd& values);

  std::vector<Point> points_;
  std::vector<Member> members_;
  double centre_ = 0;
};

}  // namespace vielto::gap

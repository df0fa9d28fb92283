// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: smooth a noisy simulated quantity over conditions and strength, with the error of the smoothed values.
//
// Equation (Rasmussen and Williams 2006, Gaussian Processes for Machine Learning, eqs. 2.25, 2.26, 2.30):
//   mean = K*' (K + N)^-1 v,   covariance = K** - K*' (K + N)^-1 K*
// with the noise covariance N of the values v known. A point is (t, c): t the strength over the largest one in the
// prior range, c the conditions in units of the library's range. Two kernels:
//   level     V (1 + c.c') + a^2 exp(-|c-c'|^2 / 2 l^2)   after the mean of v is taken out; V = (10 spread)^2: a free
//   plane response  a^2 f(t) f(t') exp(-(t-t')^2 / 2 l_t^2) (w + (1-w) exp(-|c-c'|^2 / 2 l^2)):  0 at t = 0; f(t) = t,
//   so that it is nearly linear for large l_t, or f(t) = t (1+b)/(|t|+b), an effect that saturates beyond t = b
//   parameters  (a^2 z.z' + q^2 (z.z')^2) (w + (1-w) exp(-|c-c'|^2 / 2 l^2)):  linear (and quadratic for
//   q > 0) in z, the
//             calibrated parameters' distance from the baseline's in units of their spread
// a, b, q, l, l_t, w: the most probable (2.30) of a fixed grid; a redrawn library keeps them.
#pragma once

#include <Eigen/Dense>
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
  const Kernel& kernel() const { return kernel_; }

 private:
  void solve(const Eigen::VectorXd& values);

  Kernel kernel_;
  std::vector<Point> points_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double centre_ = 0;
  Eigen::VectorXd weights_;
};

}  // namespace vielto::gap

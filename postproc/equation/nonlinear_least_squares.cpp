// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/nonlinear_least_squares.h"

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vielto {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kLargestOffset = 1e-4;

// Model values and their derivatives; false where they are not finite.
bool evaluate(const ceres::CostFunction& model, const double* b, Eigen::VectorXd& values, RowMajorMatrix* jacobian) {
  double* jacobians[] = {jacobian ? jacobian->data() : nullptr};
  if (!model.Evaluate(&b, values.data(), jacobian ? jacobians : nullptr)) return false;
  return values.allFinite() && (!jacobian || jacobian->allFinite());
}

// The whitened residuals L^-1 (y - f(b)) as Ceres wants them.
class WhitenedResiduals : public ceres::CostFunction {
 public:
  WhitenedResiduals(const ceres::CostFunction& model, const Eigen::VectorXd& observed, const Weights& weights)
      : model_(model), observed_(observed), weights_(weights) {
    set_num_residuals(model.num_residuals());
    *mutable_parameter_block_sizes() = model.parameter_block_sizes();
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index n = num_residuals(), p = parameter_block_sizes()[0];
    const bool wants_jacobian = jacobians && jacobians[0];
    Eigen::VectorXd values(n);
    RowMajorMatrix derivatives(wants_jacobian ? n : 0, p);
    if (!evaluate(model_, parameters[0], values, wants_jacobian ? &derivatives : nullptr)) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, n) = weights_.whiten(observed_ - values);
    if (wants_jacobian) Eigen::Map<RowMajorMatrix>(jacobians[0], n, p) = -weights_.whiten(derivatives);
    return true;
  }

 private:
  const ceres::CostFunction& model_;
  const Eigen::VectorXd& observed_;
  const Weights& weights_;
};

struct Point {
  NonlinearFit fit;
  Eigen::VectorXd step;  // to the minimum of the model linearised here (Gauss-Newton)
};

// The fit as it stands at `b`, or nothing where the model has no value or J no full rank.
std::optional<Point> describe(const ceres::CostFunction& model, const Eigen::VectorXd& observed, const Weights& weights,
                              const Eigen::VectorXd& b) {
  const Eigen::Index n = observed.size(), p = b.size();
  Eigen::VectorXd values(n);
  RowMajorMatrix jacobian(n, p);
  if (!evaluate(model, b.data(), values, &jacobian)) return std::nullopt;

  Point point;
  NonlinearFit& fit = point.fit;
  fit.parameters = b;
  fit.residuals = observed - values;
  fit.jacobian = jacobian;
  fit.degrees_of_freedom = n - p;
  const Eigen::VectorXd r = weights.whiten(fit.residuals);
  fit.chi2 = r.squaredNorm();

  // Columns scaled to length 1: parameters of different units would hide a loss of rank.
  Eigen::MatrixXd j = weights.whiten(fit.jacobian);
  const Eigen::VectorXd length = j.colwise().norm();
  if (!(length.array() > 0).all()) return std::nullopt;
  j *= length.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  if (!(s[p - 1] > std::numeric_limits<double>::epsilon() * static_cast<double>(n) * s[0])) return std::nullopt;
  const Eigen::MatrixXd root = length.cwiseInverse().asDiagonal() * svd.matrixV() * s.cwiseInverse().asDiagonal();
  fit.covariance = root * root.transpose();

  const Eigen::VectorXd tangential = svd.matrixU().transpose() * r;
  point.step = root * tangential;
  // Model values are rounded; a tangential part of that size is none.
  const double rounding = 1e-14 * weights.whiten(observed).norm();
  fit.relative_offset = tangential.norm() <= rounding ? 0 : tangential.norm() / r.norm();
  return point;
}

// A trust region stops when chi2 no longer falls, half the digits before the parameters stop moving. Gauss-Newton steps
// gain the other half, as long as they come closer to the minimum.
std::optional<NonlinearFit> refine(const ceres::CostFunction& model, const Eigen::VectorXd& observed,
                                   const Weights& weights, const Eigen::VectorXd& b) {
  std::optional<Point> point = describe(model, observed, weights, b);
  if (!point) return std::nullopt;
  for (;;) {
    const std::optional<Point> next = describe(model, observed, weights, point->fit.parameters + point->step);
    if (!next || !(next->fit.relative_offset < point->fit.relative_offset)) return point->fit;
    point = next;
  }
}

}  // namespace

double NonlinearFit::residual_variance() const {
  return degrees_of_freedom > 0 ? chi2 / static_cast<double>(degrees_of_freedom) : 0;
}

NonlinearFit nonlinear_least_squares(const ceres::CostFunction& model, const Eigen::VectorXd& observed,
                                     const Weights& weights, const Eigen::VectorXd& start) {
  const std::vector<int>& blocks = model.parameter_block_sizes();
  if (blocks.size() != 1 || blocks[0] != start.size() || model.num_residuals() != observed.size() ||
      weights.size() != observed.size())
    throw std::invalid_argument("nonlinear least squares: model, observations, weights and start differ in size");
  if (observed.size() < start.size())
    throw std::invalid_argument(
        fmt::format("{} observations cannot determine {} parameters", observed.size(), start.size()));

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 5000;
  options.max_num_consecutive_invalid_steps = 50;
  options.function_tolerance = 1e-18;
  options.parameter_tolerance = 1e-15;
  options.gradient_tolerance = 1e-25;
  options.logging_type = ceres::SILENT;
  WhitenedResiduals residuals(model, observed, weights);
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;

  std::optional<NonlinearFit> best;
  for (const double radius : {1e4, 10.0}) {
    options.initial_trust_region_radius = radius;
    for (const auto strategy : {ceres::LEVENBERG_MARQUARDT, ceres::DOGLEG}) {
      options.trust_region_strategy_type = strategy;
      Eigen::VectorXd b = start;
      ceres::Problem problem(problem_options);
      problem.AddResidualBlock(&residuals, nullptr, b.data());
      ceres::Solver::Summary summary;
      ceres::Solve(options, &problem, &summary);
      const std::optional<NonlinearFit> fit = refine(model, observed, weights, b);
      if (fit && (!best || fit->chi2 < best->chi2)) best = fit;
    }
  }
  if (!best || best->relative_offset > kLargestOffset)
    throw std::runtime_error("nonlinear least squares: no minimum found from this start");
  return *best;
}

}  // namespace vielto

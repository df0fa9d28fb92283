// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/measured_noise.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/bad_input.h"
#include "core/condition.h"

namespace vielto::gap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd measured_noise(const ReducedTable& table) {
  MatrixXd noise(table.covariance);
  const VectorXd over_u = noise.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd correlation = over_u.asDiagonal() * noise * over_u.asDiagonal();
  if (correlation.isIdentity(0)) return noise;
  const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(correlation, Eigen::EigenvaluesOnly).eigenvalues()[0];
  // Correlations are computed from rounded numbers, u and covariance to six digits or so.
  constexpr double kRounding = 1e-5;
  if (least < -kRounding)
    throw BadInput(table.covariance_path, 0, "is no covariance: its correlations contradict each other (not positive)",
                   "correct the correlations");
  constexpr double kOwnVariance = kOwnPartOfSharedErrors * kOwnPartOfSharedErrors;
  if (least < kOwnVariance) noise.diagonal() *= 1 + kOwnVariance + std::max(0.0, -least);
  return noise;
}

std::vector<std::string> contradictions(const std::vector<Observation>& rows, const MatrixXd& noise,
                                        const VectorXd& own) {
  constexpr double kMany = 5;
  const auto under = [](const Observation& r) {
    return fmt::format("{},{},{},{},{}", r.apparatus, r.observable, conditions_text(r), r.wall, r.material);
  };
  struct Pairs {
    double most = 0;  // times what is left to them
    std::string worst;
    int count = 0;
  };
  std::map<std::string, Pairs> places;
  for (Index i = 0; i < noise.rows(); ++i)
    for (Index j = 0; j < i; ++j) {
      const Observation &a = rows[static_cast<std::size_t>(j)], &b = rows[static_cast<std::size_t>(i)];
      if (noise(i, j) <= 0 || under(a) != under(b)) continue;
      const double sd = std::sqrt(noise(i, i) + noise(j, j) - 2 * noise(i, j) + own[i] + own[j]);
      const double apart = std::fabs(a.value - b.value);
      if (!(apart > kMany * sd)) continue;
      Pairs& here = places[under(a)];
      ++here.count;
      if (!(apart > here.most * sd)) continue;
      here.most = apart / sd;
      here.worst = fmt::format(
          "{} and {} share their conditions and their error, but differ by {:.3g} {}, {:.0f} times what is left to "
          "them: no simulation explains that; check the covariance",
          a.test, b.test, apart, a.unit, here.most);
    }
  std::vector<std::string> found;
  for (const auto& [place, pairs] : places)
    found.push_back(pairs.count == 1 ? pairs.worst : fmt::format("{} ({} such pairs there)", pairs.worst, pairs.count));
  return found;
}

void raise_to_resolution(const std::vector<Observation>& rows, const VectorXd& scale, MatrixXd& noise,
                         std::vector<std::string>& notes) {
  for (Index i = 0; i < noise.rows(); ++i) {
    const double u = std::sqrt(noise(i, i)), least = kLeastRelativeU * std::fabs(scale[i]);
    if (u >= least) continue;
    noise.row(i) *= least / u;
    noise.col(i) *= least / u;
    const Observation& row = rows[static_cast<std::size_t>(i)];
    notes.push_back(
        fmt::format("u of {} {} is raised from {:.3g} to {:.3g} {}, {:g} of the value: the simulation is "
                    "known to no more",
                    row.test, row.observable, u, least, row.unit, kLeastRelativeU));
  }
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/shearbox/shear_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/bad_input.h"
#include "core/quality_limits.h"
#include "core/steady_part.h"

namespace vielto {
namespace {

double mean_of(const std::vector<double>& values, std::size_t first = 0) {
  return std::accumulate(values.begin() + static_cast<long>(first), values.end(), 0.0) /
         static_cast<double>(values.size() - first);
}

// Block of each row: equal parts of the displacement.
std::vector<double> block_means(const std::vector<double>& values) {
  std::vector<double> means;
  for (std::size_t b = 0; b < kShearBlocks; ++b) {
    const std::size_t from = b * values.size() / kShearBlocks, to = (b + 1) * values.size() / kShearBlocks;
    means.push_back(
        std::accumulate(values.begin() + static_cast<long>(from), values.begin() + static_cast<long>(to), 0.0) /
        static_cast<double>(to - from));
  }
  return means;
}

double greatest_departure(const std::vector<double>& values, double from) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::fabs(value / from - 1));
  return most;
}

void add_warnings(ShearResult& r) {
  const auto over = [&](const char* what, double value, double limit) {
    if (value > limit) r.warnings.push_back(fmt::format("{} is {:.3g}, over {:.3g}", what, value, limit));
  };
  over("time step over the shortest half period", r.header.dt_over_tc, kMostDtOverTc * (1 + 1e-6));
  over("mean overlap over diameter", r.overlap_mean, kMostOverlapMean);
  over("greatest overlap over diameter", r.overlap_max, kMostOverlapMax);
  over("number of lost grains", std::fabs(r.lost_grains), 0);
  over("force on halves and plate left over, part of the shear force,", std::fabs(r.force_imbalance),
       kMostForceImbalance);
  if (!r.is_steady)
    r.warnings.push_back(
        fmt::format("the shear stress is not steady (drift {:.2g} % a mm): raise displacement", 100 * r.drift));
}

}  // namespace

ShearResult shear_result(const ShearRecord& record) {
  const ShearRecordHeader& h = record.header;
  const std::size_t rows = record.displacement.size();
  if (rows < kShearBlocks)
    throw BadInput(record.path, 0, fmt::format("holds {} rows, fewer than {}", rows, kShearBlocks),
                   "run the case with a smaller rowInterval or a greater displacement");
  ShearResult r;
  r.header = h;
  std::vector<double> stress = record.shear_force;
  for (double& value : stress) value /= h.area;
  r.shear_stress = block_means(stress);
  r.plate_force = block_means(record.plate_force);
  r.displacement = block_means(record.displacement);

  const SteadyPart part = find_steady_part(r.shear_stress, 1, kShearBlocks / 2);
  const std::vector<double> kept(r.shear_stress.begin() + part.first, r.shear_stress.end());
  const std::size_t first_row = static_cast<std::size_t>(part.first) * rows / kShearBlocks;
  r.steady = mean_uncertainty(kept, 1);
  r.is_steady = part.verdict == Steadiness::steady;
  r.steady_from = first_row > 0 ? record.displacement[first_row - 1] : 0;
  const double block_length = record.displacement.back() / kShearBlocks;
  r.drift = part.slope / r.steady.mean / block_length * 1e-3;

  double squares = 0;
  for (const double value : kept) squares += (value - r.steady.mean) * (value - r.steady.mean);
  const auto peak = std::max_element(r.shear_stress.begin(), r.shear_stress.end());
  r.peak = *peak;
  r.peak_u = std::sqrt(squares / static_cast<double>(kept.size() - 1));
  r.peak_displacement = r.displacement[static_cast<std::size_t>(peak - r.shear_stress.begin())];

  r.friction = r.steady.mean / h.normal_stress;
  r.friction_u = r.steady.u / h.normal_stress;
  r.plane_stress = mean_of(record.plane_force, first_row) / h.area;
  r.plane_friction = r.steady.mean / r.plane_stress;

  r.plate_mean = mean_of(record.plate_force, first_row);
  std::vector<double> deviation;
  for (std::size_t i = first_row; i < rows; ++i) deviation.push_back(std::pow(record.plate_force[i] - r.plate_mean, 2));
  const MeanUncertainty variance = mean_uncertainty(deviation, 1);
  r.plate_fluctuation = std::sqrt(variance.mean) / r.plate_mean;
  r.plate_fluctuation_u = 0.5 * variance.u / std::sqrt(variance.mean) / r.plate_mean;
  r.plate_departure_row = greatest_departure(record.plate_force, h.plate_weight());
  r.plate_departure_block = greatest_departure(r.plate_force, h.plate_weight());

  r.dilation_end = record.dilation.back();
  r.dilation_most = *std::max_element(record.dilation.begin(), record.dilation.end());
  r.porosity_start = record.porosity.front();
  r.porosity_end = record.porosity.back();
  r.inertial_number = h.shear_velocity / kShearBand * std::sqrt(h.density / h.normal_stress);

  r.overlap_mean = mean_of(record.overlap_mean);
  r.overlap_max = *std::max_element(record.overlap_max.begin(), record.overlap_max.end());
  r.lost_grains = record.first_grains - record.last_grains;
  r.force_imbalance = (mean_of(record.shear_force, first_row) + mean_of(record.upper_force, first_row) +
                       mean_of(record.plate_side_force, first_row)) /
                      mean_of(record.shear_force, first_row);
  add_warnings(r);
  return r;
}

}  // namespace vielto

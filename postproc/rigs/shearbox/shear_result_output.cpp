// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/shearbox/shear_result_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/mixing_numbers.h"
#include "core/quality_limits.h"

namespace vielto {
namespace {

// An observation's u must be above 0, even that of a plate that does not move at all.
constexpr double kLeastU = 1e-9;

}  // namespace

nlohmann::ordered_json shear_json(const ShearResult& r) {
  const ShearRecordHeader& h = r.header;
  nlohmann::ordered_json json = head_of_result("shearbox", h);
  json.update({
      {"normal_stress_Pa", h.normal_stress},
      {"shear_velocity_m_s", h.shear_velocity},
      {"grain_diameter_m", h.grain_diameter},
      {"youngs_modulus_Pa", h.youngs_modulus},
      {"inertial_number", r.inertial_number},
      {"shear_stress_peak_Pa", r.peak},
      {"shear_stress_peak_u_Pa", r.peak_u},
      {"peak_displacement_m", r.peak_displacement},
      {"shear_stress_steady_Pa", r.steady.mean},
      {"shear_stress_steady_u_Pa", r.steady.u},
      {"steady_from_m", r.steady_from},
      {"steady", r.is_steady},
      {"drift_per_mm", r.drift},
      {"friction_coefficient", r.friction},
      {"friction_coefficient_u", r.friction_u},
      {"friction_angle_deg", std::atan(r.friction) * 180 / kPi},
      {"plane_normal_stress_Pa", r.plane_stress},
      {"plane_friction_coefficient", r.plane_friction},
      {"plate_force_mean_N", r.plate_mean},
      {"plate_weight_N", h.plate_weight()},
      {"plate_force_fluctuation", r.plate_fluctuation},
      {"plate_force_fluctuation_u", r.plate_fluctuation_u},
      {"plate_force_departure_row", r.plate_departure_row},
      {"plate_force_departure_block", r.plate_departure_block},
      {"dilation_end_m", r.dilation_end},
      {"dilation_most_m", r.dilation_most},
      {"porosity_start", r.porosity_start},
      {"porosity_end", r.porosity_end},
      {"quality",
       {{"ok", r.warnings.empty()},
        {"dt_over_tc", h.dt_over_tc},
        {"overlap_mean", r.overlap_mean},
        {"overlap_max", r.overlap_max},
        {"lost_grains", r.lost_grains},
        {"force_imbalance", r.force_imbalance},
        {"warnings", r.warnings}}},
  });
  return json;
}

std::string shear_table(const ShearResult& r) {
  const ShearRecordHeader& h = r.header;
  ResultTable table(r.warnings);
  table.text(fmt::format("{} in {}, {} Pa, {} mm/s, grains of {} mm, seed {}", material_text(h.material, h.provisional),
                         h.wall, h.normal_stress, 1e3 * h.shear_velocity, 1e3 * h.grain_diameter, h.seed));
  table.heading("direct shear");
  table.line("peak shear stress", r.peak, r.peak_u, "Pa");
  table.line("  at displacement", 1e3 * r.peak_displacement, "mm");
  table.line("steady shear stress", r.steady.mean, r.steady.u, "Pa");
  table.line("  from displacement", 1e3 * r.steady_from, "mm");
  table.line("  drift", 100 * r.drift, "%/mm");
  table.line("friction coefficient, nominal normal stress", r.friction, r.friction_u, "1");
  table.line("  as an angle", std::atan(r.friction) * 180 / kPi, "deg");
  table.line("friction coefficient on the shear plane", r.plane_friction, "1");
  table.line("  normal stress there", r.plane_stress, "Pa");
  table.line("plate force, mean", r.plate_mean, "N");
  table.line("  over weight less 1", 100 * (r.plate_mean / h.plate_weight() - 1), "%");
  table.line("plate force fluctuation (std/mean)", 100 * r.plate_fluctuation, 100 * r.plate_fluctuation_u, "%");
  table.line("  greatest departure of a row", 100 * r.plate_departure_row, "%");
  table.line(fmt::format("  greatest departure of a mean over 1/{}", kShearBlocks), 100 * r.plate_departure_block, "%");
  table.line("dilation at the end", 1e3 * r.dilation_end, "mm");
  table.line("porosity at the start", r.porosity_start, "1");
  table.line("porosity at the end", r.porosity_end, "1");
  table.line(fmt::format("inertial number (band of {} diameters)", kShearBand), r.inertial_number,
             r.inertial_number < kQuasiStatic ? "1, quasi-static" : "1, not quasi-static");
  table.limits_heading();
  table.limit("time step over t_c", h.dt_over_tc, fmt::format("{}", kMostDtOverTc));
  table.limit("mean overlap, % of diameter", 100 * r.overlap_mean, fmt::format("{}", 100 * kMostOverlapMean));
  table.limit("greatest overlap, % of diameter", 100 * r.overlap_max, fmt::format("{}", 100 * kMostOverlapMax));
  table.limit("lost grains", r.lost_grains, "0");
  table.limit("force left over, % of shear force", 100 * r.force_imbalance,
              fmt::format("{}", 100 * kMostForceImbalance));
  return table.written();
}

std::string shear_curve_csv(const ShearResult& r) {
  std::string text = "displacement_m,shear_stress_Pa,plate_force_N\n";
  for (std::size_t i = 0; i < r.displacement.size(); ++i)
    text += fmt::format("{:.9g},{:.9g},{:.9g}\n", r.displacement[i], r.shear_stress[i], r.plate_force[i]);
  return text;
}

std::string default_test_name(const ShearResult& r) {
  return fmt::format("shear-{}Pa-{}", r.header.normal_stress, r.header.shear_velocity);
}

std::vector<Observation> shear_observations(const ShearResult& r, const TestLabel& label) {
  Observation row = label.row("shearbox", r.header.material, r.header.wall);
  row.normal_stress = r.header.normal_stress;
  row.shear_velocity = r.header.shear_velocity;
  return {with_value(row, "shear_stress_peak", r.peak, std::max(r.peak_u, kLeastU)),
          with_value(row, "shear_stress_steady", r.steady.mean, std::max(r.steady.u, kLeastU)),
          with_value(row, "plate_force_fluctuation", r.plate_fluctuation, std::max(r.plate_fluctuation_u, kLeastU))};
}

}  // namespace vielto

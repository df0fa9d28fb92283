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
  return {
      {"schema", 1},
      {"rig", "shearbox"},
      {"material", h.material},
      {"provisional", h.provisional},
      {"wall", h.wall},
      {"seed", h.seed},
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
  };
}

std::string shear_table(const ShearResult& r) {
  const ShearRecordHeader& h = r.header;
  std::string text;
  for (const std::string& warning : r.warnings) text += fmt::format("WARNING: {}\n", warning);
  text += fmt::format("{}{} in {}, {} Pa, {} mm/s, grains of {} mm, seed {}\n\n", h.material,
                      h.provisional ? " (provisional)" : "", h.wall, h.normal_stress, 1e3 * h.shear_velocity,
                      1e3 * h.grain_diameter, h.seed);
  text += fmt::format("  {:<44}{:>12}{:>12}  {}\n", "direct shear", "value", "u (k=1)", "unit");
  const auto line = [&](const std::string& name, double value, double u, const std::string& unit) {
    text += fmt::format("  {:<44}{:>12.5g}{:>12}  {}\n", name, value, u > 0 ? fmt::format("{:.2g}", u) : "", unit);
  };
  line("peak shear stress", r.peak, r.peak_u, "Pa");
  line("  at displacement", 1e3 * r.peak_displacement, 0, "mm");
  line("steady shear stress", r.steady.mean, r.steady.u, "Pa");
  line("  from displacement", 1e3 * r.steady_from, 0, "mm");
  line("  drift", 100 * r.drift, 0, "%/mm");
  line("friction coefficient, nominal normal stress", r.friction, r.friction_u, "1");
  line("  as an angle", std::atan(r.friction) * 180 / kPi, 0, "deg");
  line("friction coefficient on the shear plane", r.plane_friction, 0, "1");
  line("  normal stress there", r.plane_stress, 0, "Pa");
  line("plate force, mean", r.plate_mean, 0, "N");
  line("  over weight less 1", 100 * (r.plate_mean / h.plate_weight() - 1), 0, "%");
  line("plate force fluctuation (std/mean)", 100 * r.plate_fluctuation, 100 * r.plate_fluctuation_u, "%");
  line("  greatest departure of a row", 100 * r.plate_departure_row, 0, "%");
  line(fmt::format("  greatest departure of a mean over 1/{}", kShearBlocks), 100 * r.plate_departure_block, 0, "%");
  line("dilation at the end", 1e3 * r.dilation_end, 0, "mm");
  line("porosity at the start", r.porosity_start, 0, "1");
  line("porosity at the end", r.porosity_end, 0, "1");
  line(fmt::format("inertial number (band of {} diameters)", kShearBand), r.inertial_number, 0,
       r.inertial_number < kQuasiStatic ? "1, quasi-static" : "1, not quasi-static");
  text += fmt::format("\n  {:<44}{:>12}{:>12}\n", "quality", "value", "limit");
  const auto quality = [&](const std::string& name, double value, const std::string& limit) {
    text += fmt::format("  {:<44}{:>12.3g}{:>12}\n", name, value, limit);
  };
  quality("time step over t_c", h.dt_over_tc, fmt::format("{}", kMostDtOverTc));
  quality("mean overlap, % of diameter", 100 * r.overlap_mean, fmt::format("{}", 100 * kMostOverlapMean));
  quality("greatest overlap, % of diameter", 100 * r.overlap_max, fmt::format("{}", 100 * kMostOverlapMax));
  quality("lost grains", r.lost_grains, "0");
  quality("force left over, % of shear force", 100 * r.force_imbalance, fmt::format("{}", 100 * kMostForceImbalance));
  return text;
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
  std::vector<Observation> rows;
  const auto add = [&](const std::string& observable, double value, double u) {
    Observation row;
    row.test = label.test;
    row.role = label.role;
    row.apparatus = "shearbox";
    row.observable = observable;
    row.value = value;
    row.u = std::max(u, kLeastU);
    row.unit = *observable_unit("shearbox", observable);
    row.moisture = label.moisture;
    row.normal_stress = r.header.normal_stress;
    row.shear_velocity = r.header.shear_velocity;
    row.wall = label.wall.empty() ? r.header.wall : label.wall;
    row.material = r.header.material;
    rows.push_back(row);
  };
  add("shear_stress_peak", r.peak, r.peak_u);
  add("shear_stress_steady", r.steady.mean, r.steady.u);
  add("plate_force_fluctuation", r.plate_fluctuation, r.plate_fluctuation_u);
  return rows;
}

}  // namespace vielto

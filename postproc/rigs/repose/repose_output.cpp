// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/repose_output.h"

#include <fmt/format.h>

#include <algorithm>

namespace vielto {
namespace {

// An observation's u must be above 0; an angle is not known better than this from any heap of grains, deg.
constexpr double kLeastU = 1e-6;

std::size_t grain_count(const Heap& heap) {
  return heap.grains.size() / static_cast<std::size_t>(heap.header.spheres_per_grain);
}

}  // namespace

nlohmann::ordered_json repose_json(const Heap& heap, const ConeFit& f) {
  const HeapHeader& h = heap.header;
  nlohmann::ordered_json json = head_of_result("repose", h);
  json.update({
      {"base", h.base},
      {"lift_speed_m_s", h.lift_speed},
      {"grain_diameter_m", h.grain_diameter},
      {"youngs_modulus_Pa", h.youngs_modulus},
      {"grains", grain_count(heap)},
      {"rest_time_s", h.rest_time},
      {"angle_deg", f.angle},
      {"angle_u_deg", f.u},
      {"angle_spread_deg", f.spread},
      {"strips", f.strip_angles.size()},
      {"curvature_deg", f.curvature},
      {"height_m", f.height},
      {"flank_from_m", f.flank_from},
      {"flank_to_m", f.flank_to},
      {"line_intercept_m", f.intercept},
      {"line_slope", f.slope},
      {"summit_off_axis_m", f.off_axis},
      {"about_summit", f.about_summit},
      {"off_cone_m", f.off_cone},
      {"quality", {{"ok", f.warnings.empty()}, {"warnings", f.warnings}}},
      {"dt_over_tc", h.dt_over_tc},
      {"strip_angles_deg", f.strip_angles},
  });
  return json;
}

std::string repose_table(const Heap& heap, const ConeFit& f) {
  const HeapHeader& h = heap.header;
  ResultTable table(f.warnings);
  table.text(fmt::format("{} on {} ({} base), {} {} of {} mm, lifted at {} mm/s, seed {}",
                         material_text(h.material, h.provisional), h.wall, h.base, grain_count(heap),
                         h.spheres_per_grain > 1
                             ? fmt::format("clumps of {} spheres, as large as spheres", h.spheres_per_grain)
                             : "grains",
                         1e3 * h.grain_diameter, 1e3 * h.lift_speed, h.seed));
  table.heading("heap");
  table.line("static angle of repose", f.angle, f.u, "deg");
  table.line(fmt::format("  standard deviation over {} azimuths", f.strip_angles.size()), f.spread, "deg");
  table.line("  upper half of the flank less lower half", f.curvature, "deg");
  table.line("height of the mean profile", 1e3 * f.height, "mm");
  table.line("flank from radius", 1e3 * f.flank_from, "mm");
  table.line("flank to radius", 1e3 * f.flank_to, "mm");
  table.line(f.about_summit ? "summit off the axis (measured about it)" : "summit off the axis", 1e3 * f.off_axis,
             "mm");
  table.line("flank off the mean cone (root mean square)", 1e3 * f.off_cone, "mm");
  table.line("at rest after", h.rest_time, "s");
  table.time_step(h);
  return table.written();
}

std::string repose_profile_csv(const ConeFit& f) {
  std::string text = "radius_m,height_m\n";
  for (const SurfacePoint& p : f.profile) text += fmt::format("{:.9g},{:.9g}\n", p.r, p.z);
  return text;
}

std::vector<Observation> repose_observations(const Heap& heap, const ConeFit& f, const TestLabel& label) {
  const Observation row = label.row("repose", heap.header.material, heap.header.wall);
  return {with_value(row, "angle", f.angle, std::max(f.u, kLeastU))};
}

}  // namespace vielto

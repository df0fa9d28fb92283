// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/bed_output.h"

#include <fmt/format.h>

#include <algorithm>

namespace vielto {
namespace {

// An observation's u must be above 0; an angle is not known better than this from any bed of grains, deg.
constexpr double kLeastU = 1e-6;

}  // namespace

nlohmann::ordered_json bed_json(const BedAngle& bed) {
  const BedHeader& h = bed.header;
  nlohmann::ordered_json json = head_of_result("drum", h);
  json.update({
      {"speed_1_s", h.speed},
      {"fill", h.fill},
      {"tilt_deg", h.tilt},
      {"drum_diameter_m", h.drum_diameter},
      {"drum_length_m", h.drum_length},
      {"grain_diameter_m", h.grain_diameter},
      {"youngs_modulus_Pa", h.youngs_modulus},
      {"grains", bed.grains},
      {"angle_deg", bed.angle.value},
      {"angle_u_deg", bed.angle.u},
      {"looks", bed.looks.size()},
      {"dt_over_tc", h.dt_over_tc},
  });
  if (!bed.surface) return json;
  for (const SurfaceWindow& window : kSurfaceWindows) {
    json[fmt::format("{}_deg", window.observable)] = bed.surface->angles.*window.angle;
    json[fmt::format("{}_u_deg", window.observable)] = bed.surface->u.*window.angle;
  }
  json["bed_area"] = bed.surface->area.value;
  json["bed_area_u"] = bed.surface->area.u;
  return json;
}

std::string bed_table(const BedAngle& bed) {
  const BedHeader& h = bed.header;
  ResultTable table;
  table.text(fmt::format("{} in a drum of {}, {} grains of {} mm, fill {}, {} 1/s, tilt {} deg, seed {}",
                         material_text(h.material, h.provisional), h.wall, bed.grains, 1e3 * h.grain_diameter, h.fill,
                         h.speed, h.tilt, h.seed));
  table.heading("bed");
  table.line("dynamic angle of the free surface", bed.angle.value, bed.angle.u, "deg");
  for (const BedLook& look : bed.looks)
    table.line(fmt::format("  after {:.3f} turns", look.turn), look.angle.value, look.angle.u, "deg");
  if (bed.surface) {
    for (const SurfaceWindow& window : kSurfaceWindows)
      table.line(fmt::format("{}, {} < x/R < {}", window.observable, window.from, window.to),
                 bed.surface->angles.*window.angle, bed.surface->u.*window.angle, "deg");
    table.line("bed over the drum's section", bed.surface->area.value, bed.surface->area.u, "1");
  } else {
    table.text("  no slopes of the surface: " + bed.no_surface);
  }
  table.time_step(h);
  return table.written();
}

std::string bed_looks_csv(const BedAngle& bed) {
  std::string text = "turn,angle_deg,u_deg\n";
  for (const BedLook& look : bed.looks)
    text += fmt::format("{:.9g},{:.9g},{:.9g}\n", look.turn, look.angle.value, look.angle.u);
  return text;
}

std::string bed_surface_csv(const BedSurface& surface) {
  std::string text = "x_m,y_m\n";
  for (const SurfacePoint& p : surface.points) text += fmt::format("{:.9g},{:.9g}\n", p.x, p.y);
  return text;
}

std::vector<Observation> bed_observations(const BedAngle& bed, const TestLabel& label) {
  const BedHeader& h = bed.header;
  Observation row = label.row("drum", h.material, h.wall);
  row.speed = h.speed;
  row.fill = h.fill;
  row.tilt = h.tilt;
  std::vector<Observation> rows = {with_value(row, "angle", bed.angle.value, std::max(bed.angle.u, kLeastU))};
  if (!bed.surface) return rows;
  for (const SurfaceWindow& window : kSurfaceWindows)
    rows.push_back(with_value(row, window.observable, bed.surface->angles.*window.angle,
                              std::max(bed.surface->u.*window.angle, kLeastU)));
  return rows;
}

}  // namespace vielto

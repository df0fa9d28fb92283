// SPDX-License-Identifier: GPL-2.0-or-later
// The silo: its meshes; outflow and what stays -> discharge rate, drained angle, observation rows, pictures.
//
// Meshes: silo (mantle, normals inward), bottom (ring in z = 0, normals up), outlet (square below the orifice at which
// what has fallen is taken out; no wall). The orifice's polygon has the area of its circle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "picture/chart.h"
#include "rigs/rig_code.h"
#include "rigs/rig_picture.h"
#include "rigs/silo/silo_discharge.h"

namespace vielto {
namespace {

constexpr double kOutletDepth = 0.05;  // m
constexpr double kLeastAngleU = 1e-6;  // deg; an observation's u must be above 0

RigGeometry silo_geometry(GeometryInput& input) {
  const double radius = input.positive("siloDiameter") / 2;
  const double height = input.positive("siloHeight");
  const double orifice = input.positive("orificeDiameter") / 2;
  const int segments = input.count("siloSegments", 12, 360);
  if (orifice > 0.8 * radius) input.refuse("orificeDiameter", "over 0.8 siloDiameter", "leave a bottom");

  const double turn = 2 * kPi / segments;
  auto circle = arc(radius, 0, 2 * kPi, segments);
  const auto edge = arc(orifice * std::sqrt(turn / std::sin(turn)), 0, 2 * kPi, segments);
  Surface bottom;
  for (std::size_t i = 0; i < circle.size(); ++i) {
    const std::size_t next = (i + 1) % circle.size();
    bottom.push_back(plate({edge[i], circle[i], circle[next], edge[next]}, 0, true));
  }
  std::reverse(circle.begin(), circle.end());  // normals inward
  const Surface mantle = sweep(circle, true, 0, height, strip_pieces(height, 2 * radius * std::sin(kPi / segments)));
  const Surface outlet{plate(rectangle(2 * radius, 2 * radius), -kOutletDepth, true)};
  RigGeometry g;
  g.parts = {{"silo", "drum", false, triangulate(upright(mantle))},
             {"bottom", "plate", false, triangulate(upright(bottom))},
             {"outlet", "drum", false, triangulate(upright(outlet))}};
  g.derived = {{"siloRadius", fmt::format("{:.12g}", radius * std::cos(kPi / segments))},
               {"outletDepth", fmt::format("{:.12g}", kOutletDepth)}};
  return g;
}

nlohmann::ordered_json silo_json(const SiloDischarge& d) {
  const SiloHeader& h = d.header;
  nlohmann::ordered_json json = head_of_result("silo", h);
  json.update({{"silo_diameter_m", h.silo_diameter},
               {"orifice_diameter_m", h.orifice_diameter},
               {"grain_diameter_m", h.grain_diameter},
               {"youngs_modulus_Pa", h.youngs_modulus},
               {"mass_filled_kg", h.mass_filled},
               {"mass_left_kg", d.flow.mass.back()},
               {"bulk_density_kg_m3", h.bulk_density},
               {"discharge_rate_kg_s", d.rate.mean},
               {"discharge_rate_u_kg_s", d.rate.u},
               {"rate_from_s", d.rate_from},
               {"rate_to_s", d.rate_to},
               {"drift", d.drift},
               {"beverloo_kg_s", d.beverloo},
               {"over_beverloo", d.rate.mean / d.beverloo},
               {"angle_deg", d.angle.mean},
               {"angle_u_deg", d.angle.u},
               {"angle_spread_deg", d.angle.spread},
               {"grains_left", d.grains},
               {"quality", {{"ok", d.warnings.empty()}, {"dt_over_tc", h.dt_over_tc}, {"warnings", d.warnings}}}});
  return json;
}

std::string silo_table(const SiloDischarge& d) {
  const SiloHeader& h = d.header;
  ResultTable table;
  table.text(fmt::format("{} out of a silo of {}, orifice of {} mm, grains of {} mm, seed {}",
                         material_text(h.material, h.provisional), h.wall, 1e3 * h.orifice_diameter,
                         1e3 * h.grain_diameter, h.seed));
  table.heading("silo");
  table.line("discharge rate", d.rate.mean, d.rate.u, "kg/s");
  table.line("  second half over first, less 1", 100 * d.drift, "%");
  table.line("  Beverloo, C = 0.58, k = 1.4", d.beverloo, "kg/s");
  table.line("drained angle", d.angle.mean, d.angle.u, "deg");
  table.line(fmt::format("  standard deviation over {} azimuths", kSiloStrips), d.angle.spread, "deg");
  table.line("mass filled", h.mass_filled, "kg");
  table.line("mass that stays", d.flow.mass.back(), "kg");
  table.line("bulk density before", h.bulk_density, "kg/m3");
  table.time_step(h);
  return table.written();
}

std::vector<Observation> silo_observations(const SiloDischarge& d, const TestLabel& label) {
  const Observation row = label.row("silo", d.header.material, d.header.wall);
  return {with_value(row, "discharge_rate", d.rate.mean, d.rate.u),
          with_value(row, "angle", d.angle.mean, std::max(d.angle.u, kLeastAngleU))};
}

void draw_flow(const SiloDischarge& d, const std::string& path) {
  std::vector<double> grams;
  for (const double mass : d.flow.mass) grams.push_back(1e3 * mass);
  Chart chart(fmt::format("{}, orifice of {} mm: {:.0f} g/s, Beverloo {:.0f} g/s", d.header.material,
                          1e3 * d.header.orifice_diameter, 1e3 * d.rate.mean, 1e3 * d.beverloo));
  chart.shade("averaged", d.rate_from, d.rate_to, 0, 1.05e3 * d.header.mass_filled);
  chart.line("mass in the silo", d.flow.time, grams, kBlue, 3);
  chart.horizontal_axis("time since opening / s", 0, d.flow.time.back());
  chart.vertical_axis("mass / g", 0, 1.05e3 * d.header.mass_filled);
  chart.write(path);
}

PostResult post_silo(const PostInput& input) {
  const SiloDischarge d = read_silo_discharge(input.record);
  PostResult result;
  result.rows = silo_observations(d, input.label_or(fmt::format("silo-{}", d.header.orifice_diameter)));
  result.table = silo_table(d);
  result.numbers = silo_json(d);
  std::string profile = "radius_m,height_m\n";
  for (const SurfacePoint& p : d.profile) profile += fmt::format("{:.9g},{:.9g}\n", p.r, p.z);
  result.files = {{"profile.csv", profile}};
  result.pictures = {{"flow.png", [d](const std::string& path) { draw_flow(d, path); }}};
  add_grains(input.run(), result);
  result.warnings = d.warnings;
  return result;
}

}  // namespace

RigCode silo_rig() { return {silo_geometry, post_silo}; }

}  // namespace vielto

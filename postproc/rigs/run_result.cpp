// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/run_result.h"

#include <fmt/format.h>

#include "core/quality_limits.h"

namespace vielto {

void read_run_header(const Keys& keys, RunHeader& h) {
  keys.demand_schema(1);
  h.grain_diameter = keys.number("grain_diameter", 0, true);
  h.youngs_modulus = keys.number("youngs_modulus", 0, true);
  h.dt_over_tc = keys.number("dt_over_tc", 0);
  h.seed = keys.text("seed");
  h.material = keys.text("material");
  h.wall = keys.text("wall");
  h.provisional = keys.integer("provisional", 0) != 0;
}

nlohmann::ordered_json head_of_result(const std::string& rig, const RunHeader& h) {
  return {{"schema", 1},    {"rig", rig},    {"material", h.material}, {"provisional", h.provisional},
          {"wall", h.wall}, {"seed", h.seed}};
}

std::string material_text(const std::string& material, bool provisional) {
  return material + (provisional ? " (provisional)" : "");
}

ResultTable::ResultTable(const std::vector<std::string>& warnings, int name_width) : width_(name_width) {
  for (const std::string& warning : warnings) text(fmt::format("WARNING: {}", warning));
}

void ResultTable::text(const std::string& line) { text_ += line + "\n"; }

void ResultTable::heading(const std::string& name) {
  text_ += fmt::format("\n  {:<{}}{:>12}{:>12}  {}\n", name, width_, "value", "u (k=1)", "unit");
}

void ResultTable::row(const std::string& name, double value, const std::string& u, const std::string& unit) {
  text_ += fmt::format("  {:<{}}{:>12.5g}{:>12}  {}\n", name, width_, value, u, unit);
}

void ResultTable::line(const std::string& name, double value, const std::string& unit) { row(name, value, "", unit); }

void ResultTable::line(const std::string& name, double value, double u, const std::string& unit) {
  row(name, value, fmt::format("{:.2g}", u), unit);
}

void ResultTable::limits_heading() {
  text_ += fmt::format("\n  {:<{}}{:>12}{:>12}\n", "quality", width_, "value", "limit");
}

void ResultTable::limit(const std::string& name, double value, const std::string& limit) {
  text_ += fmt::format("  {:<{}}{:>12.3g}{:>12}\n", name, width_, value, limit);
}

void ResultTable::time_step(const RunHeader& header) {
  line("time step over t_c", header.dt_over_tc, fmt::format("1, limit {}", kMostDtOverTc));
}

}  // namespace vielto

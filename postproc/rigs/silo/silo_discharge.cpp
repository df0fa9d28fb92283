// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/silo/silo_discharge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/bad_input.h"
#include "core/quality_limits.h"
#include "core/record_file.h"

namespace vielto {
namespace {

SiloHeader read_header(const Keys& keys) {
  SiloHeader h;
  read_run_header(keys, h);
  h.silo_diameter = keys.number("silo_diameter", 0, true);
  h.orifice_diameter = keys.number("orifice_diameter", 0, true);
  h.bulk_density = keys.number("bulk_density", 0, true);
  h.mass_filled = keys.number("mass_filled", 0, true);
  h.gravity = keys.number("gravity", 0, true);
  return h;
}

SiloFlow read_flow(const std::string& path) {
  RecordFile file(path, "a run folder with silo.csv and flow.csv");
  const std::size_t time = file.columns().at("time_s"), mass = file.columns().at("mass_kg");
  SiloFlow flow;
  for (std::vector<double> row; file.next_row(row);) {
    if (!flow.time.empty() && !(row[time] > flow.time.back()))
      throw BadInput(path, file.line(), "time_s", "does not grow", "run the case again");
    flow.time.push_back(row[time]);
    flow.mass.push_back(row[mass]);
  }
  return flow;
}

void average_rate(SiloDischarge& d, const std::string& path) {
  const std::vector<double>&time = d.flow.time, &mass = d.flow.mass;
  const double left = mass.empty() ? 0 : d.header.mass_filled - mass.back();
  if (!(left > 0.05 * d.header.mass_filled))
    throw BadInput(path, 0, "the silo did not run: hardly a grain has left it", "give a wider orifice or finer grains");
  std::vector<double> rates;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double out = d.header.mass_filled - mass[i];
    if (out < kFlowFrom * left || out > kFlowTo * left) continue;
    if (rates.empty()) d.rate_from = time[i - 1];
    d.rate_to = time[i];
    rates.push_back((mass[i - 1] - mass[i]) / (time[i] - time[i - 1]));
  }
  if (rates.size() < kLeastFlowRows)
    throw BadInput(path, 0, fmt::format("{} rows of steady outflow, {} are needed", rates.size(), kLeastFlowRows),
                   "give a smaller rowTime or more grain");
  d.rate = mean_uncertainty(rates, 1);
  const auto middle = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2);
  const auto mean = [](auto from, auto to) {
    double sum = 0;
    for (auto i = from; i != to; ++i) sum += *i;
    return sum / static_cast<double>(to - from);
  };
  d.drift = mean(middle, rates.end()) / mean(rates.begin(), middle) - 1;
}

void measure_crater(SiloDischarge& d, const std::vector<Grain>& grains, const std::string& path) {
  const double cell = d.header.grain_diameter;
  const auto top = surface_strips(grains, {0, 0}, cell, kSiloStrips);
  const auto first = static_cast<std::size_t>(std::ceil(0.5 * d.header.orifice_diameter / cell + 1));
  const auto end = std::min(top[0].size(), static_cast<std::size_t>(0.5 * d.header.silo_diameter / cell - 1));
  std::vector<double> angles;
  for (const auto& strip : top) {
    std::vector<SurfacePoint> points;
    for (std::size_t c = first; c < end; ++c)
      if (strip[c] > kNoGrain) points.push_back({(static_cast<double>(c) + 0.5) * cell, strip[c]});
    if (points.size() >= kLeastCraterCells) angles.push_back(-line_through(points).angle());
  }
  if (angles.size() < kSiloStrips / 2)
    throw BadInput(path, 0, "too few grains stay between orifice and wall for an angle",
                   fmt::format("leave room for {} grains there", kLeastCraterCells + 2));
  d.angle = azimuth_mean(angles);
  for (std::size_t c = 0; c < top[0].size(); ++c) {
    double sum = 0;
    for (const auto& strip : top) sum += std::max(strip[c], 0.0);
    d.profile.push_back({(static_cast<double>(c) + 0.5) * cell, sum / kSiloStrips});
  }
  double high = 0;
  for (std::size_t c = first; c < end; ++c) high = std::max(high, d.profile[c].z);
  if (high < kLeastCraterHeight * cell)
    d.warnings.push_back(
        fmt::format("what stays is {:.2g} grains high, below {} the angle is that of a layer on the bottom",
                    high / cell, kLeastCraterHeight));
}

}  // namespace

double beverloo_rate(double bulk_density, double gravity, double orifice, double grain, double c, double k) {
  return c * bulk_density * std::sqrt(gravity) * std::pow(std::max(0.0, orifice - k * grain), 2.5);
}

SiloDischarge read_silo_discharge(const std::string& path) {
  RecordFile file(path, "a run folder or its silo.csv");
  SiloDischarge d;
  d.header = read_header(file.keys());
  const std::vector<Grain> grains = read_grains(file, path);
  d.grains = grains.size();
  d.flow = read_flow((std::filesystem::path(path).parent_path() / "flow.csv").string());
  average_rate(d, path);
  measure_crater(d, grains, path);
  const SiloHeader& h = d.header;
  d.beverloo = beverloo_rate(h.bulk_density, h.gravity, h.orifice_diameter, h.grain_diameter);
  if (h.dt_over_tc > kMostDtOverTc)
    d.warnings.push_back(fmt::format("the time step is {:.3g} of t_c, limit {}", h.dt_over_tc, kMostDtOverTc));
  if (h.orifice_diameter < kLeastOrifice * h.grain_diameter)
    d.warnings.push_back(fmt::format("the orifice is {:.3g} grains wide, below {} it may arch",
                                     h.orifice_diameter / h.grain_diameter, kLeastOrifice));
  return d;
}

}  // namespace vielto

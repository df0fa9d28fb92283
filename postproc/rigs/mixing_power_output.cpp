// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/mixing_power_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/csv.h"

namespace vielto {
namespace {

using Json = nlohmann::ordered_json;

// The ripple of a machine that repeats exactly; an observation's u must be above 0.
constexpr double kLeastRippleU = 1e-9, kLeastShareU = 1e-6;

Json or_null(const std::optional<MeanUncertainty>& m, double MeanUncertainty::*member) {
  return m ? Json((*m).*member) : Json(nullptr);
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::string line(const std::string& name, double value, const std::string& u, const std::string& unit) {
  return fmt::format("  {:<34}{:>12.5g}{:>12}  {}\n", name, value, u, unit);
}

std::string line(const std::string& name, const MeanUncertainty& m, const std::string& unit) {
  return line(name, m.mean, fmt::format("{:.2g}", m.u), unit);
}

}  // namespace

Json power_json(const MixingPower& p) {
  const TorqueRecordHeader& h = p.header;
  Json parts;
  for (std::size_t i = 0; i < p.parts.size(); ++i)
    parts[p.part_names[i].name] = {{"torque_Nm", p.parts[i].mean}, {"torque_u_Nm", p.parts[i].u}};
  Json losses;
  if (p.losses)
    for (std::size_t i = 0; i < kLosses.size(); ++i) losses[kLosses[i]] = {{"power_W", (*p.losses)[i]}};
  const RunQuality& q = p.quality;
  Json quality = {
      {"ok", q.ok()},
      {"dt_over_tc", q.dt_over_tc},
      {"overlap_mean", q.overlap_mean},
      {"overlap_max", q.overlap_max},
      {"lost_grains", q.lost_grains},
      {"mass_kg", q.mass},
      {"mass_target_kg", q.mass_target},
      {"intervals_per_turn", q.intervals_per_turn},
      {"torque_balance_Nm", or_null(q.torque_balance, &MeanUncertainty::mean)},
      {"torque_balance_u_Nm", or_null(q.torque_balance, &MeanUncertainty::u)},
      {"torque_balance_relative", q.torque_balance ? Json(q.torque_balance_relative) : Json(nullptr)},
      {"energy_closure_relative", q.energy_gap ? Json(*q.energy_gap) : Json(nullptr)},
      {"warnings", q.warnings},
      {"notes", q.notes},
  };
  return {
      {"schema", 1},
      {"material", h.material},
      {"provisional", h.provisional},
      {"speed", h.speed},
      {"fill", or_null(h.fill)},
      {"slice", h.slice},
      {"paddles", h.paddles},
      {"seed", h.seed},
      {"turns_total", p.turns_total},
      {"turns_averaged", p.averaged.count},
      {"turn_first", p.turn_first},
      {"stationary", true},  // a record that is not is refused
      {"drift_per_turn", p.averaged.slope},
      {"drift_probability", p.averaged.slope_p},
      {"torque_Nm", p.torque.mean},
      {"torque_u_Nm", p.torque.u},
      {"torque_u95_Nm", p.torque.u95()},
      {"degrees_of_freedom", p.torque.dof},
      {"effective_samples", p.torque.effective_samples},
      {"correlation_time_turns", p.torque.correlation_time / kPhases},
      {"power_loaded_W", or_null(p.loaded, &MeanUncertainty::mean)},
      {"power_loaded_u_W", or_null(p.loaded, &MeanUncertainty::u)},
      {"power_idle_W", or_null(p.idle, &MeanUncertainty::mean)},
      {"power_idle_u_W", or_null(p.idle, &MeanUncertainty::u)},
      {"power_W", p.power.mean},
      {"power_u_W", p.power.u},
      {"power_u95_W", p.power.u95()},
      {"scale_uncertainty", kScaleUncertainty},
      {"scale_uncertainty_of",
       "power, relative: the assumed bulk density, common to every run of the material, not in u"},
      {"N_P", or_null(p.n_p)},
      {"N_PC", or_null(p.n_pc)},
      {"N_C", or_null(p.n_c)},
      {"Fr_M", or_null(p.fr_m)},
      {"thesis_power_W", or_null(p.thesis_power)},
      {"thesis_in_range", p.in_thesis_range},
      {"relative_gap", or_null(p.relative_gap)},
      {"relative_gap_u", p.thesis_power ? Json(p.power.u / *p.thesis_power) : Json(nullptr)},
      {"torque_ripple", p.curves.ripple},
      {"torque_ripple_u", p.curves.ripple_u},
      {"torque_ripple_noise", p.curves.ripple_noise},
      {"parts", parts},
      {"losses", losses},
      {"quality", quality},
  };
}

std::string power_table(const MixingPower& p) {
  const TorqueRecordHeader& h = p.header;
  const RunQuality& q = p.quality;
  std::string text;
  for (const std::string& warning : q.warnings) text += fmt::format("WARNING: {}\n", warning);
  text += fmt::format("{}, seed {}\n", h.what_ran(), h.seed);
  text += fmt::format("steady turns {} to {}: {} of {} averaged, {} left out as start-up\n\n", p.turn_first + 1,
                      p.turn_first + p.averaged.count, p.averaged.count, p.turns_total, p.averaged.first);
  text += fmt::format("  {:<34}{:>12}{:>12}  {}\n", "whole drum", "value", "u (k=1)", "unit");
  text += line("mean torque on the grains", p.torque, "N m");
  for (std::size_t i = 0; i < p.parts.size(); ++i)
    text += line(fmt::format("  of the {}", p.part_names[i].name), p.parts[i], "N m");
  if (p.losses)
    for (std::size_t i = 0; i < kLosses.size(); ++i)
      text += line(fmt::format("power lost, {}", kLosses[i]), (*p.losses)[i], "", "W");
  text += line("torque ripple", p.curves.ripple, fmt::format("{:.2g}", p.curves.ripple_u), "1");
  if (p.loaded) text += line("loaded power", *p.loaded, "W");
  if (p.idle) text += line("idling power", *p.idle, "W");
  text += line("mixing power", p.power, "W");
  text += line("  95 % interval, half width", p.power.u95(), "", "W");
  text += line("  common scale (bulk density)", 100 * kScaleUncertainty, "", "%");
  const auto number = [&](const char* name, const std::optional<double>& value) {
    if (value) text += line(name, *value, "", "1");
  };
  number("N_P  power number", p.n_p);
  number("N_PC cohesive power number", p.n_pc);
  number("N_C  cohesion number", p.n_c);
  number("Fr_M mixing Froude number", p.fr_m);
  if (h.rig != "mixer" && h.power_lever) text += line("  with the lever stated", *h.power_lever, "", "m");
  if (p.thesis_power) {
    text += line("published equation", *p.thesis_power, "", p.in_thesis_range ? "W" : "W, outside its range");
    text += line("gap to it", 100 * *p.relative_gap, fmt::format("{:.2g}", 100 * p.power.u / *p.thesis_power), "%");
  }
  text += fmt::format("\n  {:<34}{:>12}{:>12}\n", "quality", "value", "limit");
  const auto quality = [&](const std::string& name, double value, const std::string& limit) {
    text += fmt::format("  {:<34}{:>12.3g}{:>12}\n", name, value, limit);
  };
  quality("time step over t_c", q.dt_over_tc, fmt::format("{}", kMostDtOverTc));
  quality("mean overlap, % of diameter", 100 * q.overlap_mean, fmt::format("{}", 100 * kMostOverlapMean));
  quality("greatest overlap, % of diameter", 100 * q.overlap_max, fmt::format("{}", 100 * kMostOverlapMax));
  quality("lost grains", q.lost_grains, "0");
  quality("grain mass over target, %", 100 * (q.mass / q.mass_target - 1),
          fmt::format("{}", 100 * kMostMassDifference));
  quality("rows a turn", q.intervals_per_turn, "");
  quality("effective samples", p.torque.effective_samples, "");
  quality("drift, % a turn", 100 * p.averaged.slope, "");
  if (q.torque_balance)
    quality("torque balance, % of rotor", 100 * q.torque_balance_relative,
            fmt::format("{:.2g}",
                        300 * q.torque_balance->u / std::fabs(q.torque_balance->mean / q.torque_balance_relative)));
  if (q.energy_gap)
    quality("energy left over, % of work", 100 * *q.energy_gap, fmt::format("{}", 100 * kMostEnergyGap));
  for (const std::string& note : q.notes) text += fmt::format("note: {}\n", note);
  return text;
}

std::string phase_csv(const MixingPower& p) {
  const ShaftCurves& c = p.curves;
  const bool paddles = p.header.rig == "mixer";
  std::string text = paddles ? "phase_deg,paddle_Nm" : "phase_deg";
  const auto of = [&](bool turning, const std::function<void(std::size_t)>& add) {
    for (std::size_t part = 0; part < p.part_names.size(); ++part)
      if (p.part_names[part].turns == turning) add(part);
  };
  const auto name = [&](std::size_t part) { text += fmt::format(",{}_Nm", p.part_names[part].name); };
  of(true, name);
  text += ",rotor_Nm,rotor_u_Nm";
  of(false, name);
  text += "\n";
  for (std::size_t i = 0; i < kPhases; ++i) {
    text += fmt::format("{}", 360.0 / kPhases * (static_cast<double>(i) + 0.5));
    if (paddles) text += "," + (c.paddle.empty() ? "" : fmt::format("{:.9g}", c.paddle[i]));
    const auto value = [&](std::size_t part) { text += fmt::format(",{:.9g}", c.part[part][i]); };
    of(true, value);
    text += fmt::format(",{:.9g},{:.9g}", c.rotor[i], c.rotor_u[i]);
    of(false, value);
    text += "\n";
  }
  return text;
}

std::string default_test_name(const MixingPower& p) {
  const TorqueRecordHeader& h = p.header;
  return h.fill ? fmt::format("n{}-l{}", h.speed, *h.fill) : fmt::format("n{}-m{}", h.speed, h.mass);
}

std::vector<Observation> power_observations(const MixingPower& p, const TestLabel& label) {
  std::vector<Observation> rows;
  const auto add = [&](const std::string& observable, double value, double u) {
    Observation row;
    row.test = label.test;
    row.role = label.role;
    row.apparatus = p.header.rig;
    row.observable = observable;
    row.value = value;
    row.u = u;
    row.unit = *observable_unit(p.header.rig, observable);
    row.speed = p.header.speed;
    row.fill = p.header.fill;
    row.moisture = label.moisture;
    row.wall = label.wall;
    row.material = p.header.material;
    rows.push_back(row);
  };
  if (p.loaded && p.idle) {
    add("power_loaded", p.loaded->mean, p.loaded->u);
    add("power_idle", p.idle->mean, p.idle->u);
  } else {
    add("power", p.power.mean, p.power.u);
  }
  add("torque_ripple", p.curves.ripple, std::max(p.curves.ripple_u, kLeastRippleU));
  for (std::size_t k = 0; k < kPaddleShares.size() && !p.curves.paddle.empty(); ++k)
    if (observable_unit(p.header.rig, kPaddleShares[k].observable))
      add(kPaddleShares[k].observable, p.curves.shares[k], std::max(p.curves.shares_u[k], kLeastShareU));
  return rows;
}

}  // namespace vielto

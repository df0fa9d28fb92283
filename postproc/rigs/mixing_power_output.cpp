// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/mixing_power_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/csv.h"
#include "rigs/run_result.h"

namespace vielto {
namespace {

using Json = nlohmann::ordered_json;

// The ripple of a machine that repeats exactly; an observation's u must be above 0.
constexpr double kLeastRippleU = 1e-9, kLeastShareU = 1e-6;

Json or_null(const std::optional<MeanUncertainty>& m, double MeanUncertainty::*member) {
  return m ? Json((*m).*member) : Json(nullptr);
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// Turns, most often whole ones.
Json counted(double turns) { return turns == std::floor(turns) ? Json(static_cast<long>(turns)) : Json(turns); }

}  // namespace

Json power_json(const MixingPower& p) {
  const TorqueRecordHeader& h = p.header;
  Json parts;
  for (std::size_t i = 0; i < p.parts.size(); ++i)
    parts[p.part_names[i].name] = {
        {"torque_Nm", p.parts[i].mean}, {"torque_u_Nm", p.parts[i].u}, {"turns", p.part_names[i].turns}};
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
      {"turns_total", counted(p.turns_total)},
      {"turns_averaged", counted(p.averaged.turns_kept())},
      {"turn_first", counted(p.turn_first)},
      {"stationary", true},  // a record that is not is refused
      {"drift_per_turn", p.averaged.slope},
      {"drift_probability", p.averaged.slope_p},
      {"torque_Nm", p.torque.mean},
      {"torque_u_Nm", p.torque.u},
      {"torque_u95_Nm", p.torque.u95()},
      {"degrees_of_freedom", p.torque.dof},
      {"effective_samples", p.torque.effective_samples},
      {"correlation_time_turns", p.torque.correlation_time * p.averaged.turns / p.averaged.phases},
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
  ResultTable table(q.warnings, 34);
  table.text(fmt::format("{}, seed {}", h.what_ran(), h.seed));
  const double kept = p.averaged.turns_kept();
  // Parts of a turn have no number of their own: said by the turns done.
  const double from = p.averaged.turns < 1 ? p.turn_first : p.turn_first + 1;
  table.text(fmt::format("steady turns {:.10g} to {:.10g}: {:.10g} of {:.10g} averaged, {:.10g} left out as start-up",
                         from, p.turn_first + kept, kept, p.turns_total, p.averaged.turns_left_out()));
  table.heading("whole drum");
  const auto line = [&](const std::string& name, const MeanUncertainty& m, const char* unit) {
    table.line(name, m.mean, m.u, unit);
  };
  line("mean torque on the grains", p.torque, "N m");
  for (std::size_t i = 0; i < p.parts.size(); ++i)
    line(fmt::format("  of the {}", p.part_names[i].name), p.parts[i], "N m");
  if (p.losses)
    for (std::size_t i = 0; i < kLosses.size(); ++i)
      table.line(fmt::format("power lost, {}", kLosses[i]), (*p.losses)[i], "W");
  table.line("torque ripple", p.curves.ripple, p.curves.ripple_u, "1");
  if (p.loaded) line("loaded power", *p.loaded, "W");
  if (p.idle) line("idling power", *p.idle, "W");
  line("mixing power", p.power, "W");
  table.line("  95 % interval, half width", p.power.u95(), "W");
  table.line("  common scale (bulk density)", 100 * kScaleUncertainty, "%");
  const auto number = [&](const char* name, const std::optional<double>& value) {
    if (value) table.line(name, *value, "1");
  };
  number("N_P  power number", p.n_p);
  number("N_PC cohesive power number", p.n_pc);
  number("N_C  cohesion number", p.n_c);
  number("Fr_M mixing Froude number", p.fr_m);
  if (h.rig != "mixer" && h.power_lever) table.line("  with the lever stated", *h.power_lever, "m");
  if (p.thesis_power) {
    table.line("published equation", *p.thesis_power, p.in_thesis_range ? "W" : "W, outside its range");
    table.line("gap to it", 100 * *p.relative_gap, 100 * p.power.u / *p.thesis_power, "%");
  }
  table.limits_heading();
  table.limit("time step over t_c", q.dt_over_tc, fmt::format("{}", kMostDtOverTc));
  table.limit("mean overlap, % of diameter", 100 * q.overlap_mean, fmt::format("{}", 100 * kMostOverlapMean));
  table.limit("greatest overlap, % of diameter", 100 * q.overlap_max, fmt::format("{}", 100 * kMostOverlapMax));
  table.limit("lost grains", q.lost_grains, "0");
  table.limit("grain mass over target, %", 100 * (q.mass / q.mass_target - 1),
              fmt::format("{}", 100 * kMostMassDifference));
  table.limit("rows a turn", q.intervals_per_turn, "");
  table.limit("effective samples", p.torque.effective_samples, "");
  table.limit("drift, % a turn", 100 * p.averaged.slope, "");
  if (q.torque_balance)
    table.limit("torque balance, % of rotor", 100 * q.torque_balance_relative,
                fmt::format("{:.2g}",
                            300 * q.torque_balance->u / std::fabs(q.torque_balance->mean / q.torque_balance_relative)));
  if (q.energy_gap)
    table.limit("energy left over, % of work", 100 * *q.energy_gap, fmt::format("{}", 100 * kMostEnergyGap));
  for (const std::string& note : q.notes) table.text("note: " + note);
  return table.written();
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
  Observation row = label.row(p.header.rig, p.header.material, "");
  row.speed = p.header.speed;
  row.fill = p.header.fill;
  std::vector<Observation> rows;
  const auto add = [&](const std::string& observable, double value, double u) {
    rows.push_back(with_value(row, observable, value, u));
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

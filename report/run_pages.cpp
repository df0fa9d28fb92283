// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/run_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/bad_input.h"
#include "core/json_file.h"
#include "core/mixing_numbers.h"
#include "core/steady_part.h"
#include "report/data_file.h"
#include "rigs/mixing_power.h"
#include "rigs/torque_record.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Look = Series::Look;

// Points of the torque over time; more are averaged in groups.
constexpr std::size_t kMostTimes = 1440;

std::string named(const std::string& name, const std::string& what) { return name.empty() ? what : name + "_" + what; }
std::string titled(const std::string& name, const std::string& what) {
  return name.empty() ? what : what + ": " + name;
}

Plot torque_plot(const TorqueRecord& record, const std::optional<json>& power) {
  const TorqueRecordHeader& h = record.header;
  const bool idling = h.idling();
  std::vector<double> torque = idling ? record.idle : record.rotor();
  if (!idling)
    for (double& value : torque) value *= h.whole_drum();
  const double turn_time = record.turns_per_block / h.speed, start = record.first_turn / h.speed;
  Plot plot;
  plot.x_name = "time since the start of the rotor / s";
  plot.y_name = idling ? "idling torque / (N m)" : "torque on the grains / (N m)";
  plot.zoom = true;
  const std::size_t group = (torque.size() + kMostTimes - 1) / kMostTimes;
  Series curve{group > 1 ? fmt::format("torque, means of {} phases", group) : "torque", Look::line, 0, {}, {}, {}};
  for (std::size_t i = 0; group > 0 && i + group <= torque.size(); i += group) {
    double mean = 0;
    for (std::size_t j = i; j < i + group; ++j) mean += torque[j] / static_cast<double>(group);
    curve.xy.push_back(
        {start + (static_cast<double>(i) + 0.5 * static_cast<double>(group)) / record.block_phases() * turn_time,
         mean});
  }
  Series means{record.turns_per_block == 1 ? "turn means" : fmt::format("means of {} turns", record.turns_per_block),
               Look::line,
               1,
               {},
               {},
               {}};
  const std::vector<double> turns = turn_means(torque, record.block_phases());
  for (std::size_t t = 0; t < turns.size(); ++t)
    for (const double end : {0.0, 1.0})
      means.xy.push_back({start + (static_cast<double>(t) + end) * turn_time, turns[t]});
  plot.series = {curve, means};
  if (power) {
    const double first = power->at("turn_first");
    plot.x_band =
        Band{first / h.speed, (first + power->at("turns_averaged").get<double>()) / h.speed, "averaged turns"};
  }
  plot.caption =
      idling || h.slice == 0
          ? "Means over phases of 5° of the turn."
          : fmt::format("Torque of the simulated slice times {}/{}: its mean is the drum's, its ripple is not.",
                        h.paddles, h.slice);
  return plot;
}

Plot phase_plot(const std::string& path) {
  const DataFile file = read_data_file(path);
  Plot plot;
  plot.x_name = "angle of the shaft / °";
  plot.y_name = "torque of the whole drum / (N m)";
  plot.caption =
      "Mean over the averaged turns. The whole shaft is the phase-shifted sum of its paddles; bars: standard "
      "uncertainty (k = 1).";
  const int x = file.find("phase_deg"), u = file.find("rotor_u_Nm");
  if (x < 0 || u < 0 || file.values[static_cast<std::size_t>(x)].empty() ||
      file.values[static_cast<std::size_t>(u)].empty())
    throw BadInput(path, 1, "has no columns phase_deg and rotor_u_Nm of numbers", "run `vielto post` on the run again");
  int colour = 0;
  std::vector<std::string> parts = {"rotor"};  // then what turns, which stands before it in the file
  for (std::size_t k = 1; k < file.columns.size() && file.columns[k] != "rotor_Nm"; ++k)
    if (file.columns[k] != "paddle_Nm") parts.push_back(file.columns[k].substr(0, file.columns[k].rfind("_Nm")));
  for (const std::string& part : parts) {
    const int y = file.find(part + "_Nm");
    if (y < 0 || file.values[static_cast<std::size_t>(y)].empty()) continue;
    Series series{part, Look::line, colour++, {}, {}, {}};
    for (std::size_t i = 0; i < file.values[static_cast<std::size_t>(x)].size(); ++i)
      series.xy.push_back({file.values[static_cast<std::size_t>(x)][i], file.values[static_cast<std::size_t>(y)][i]});
    if (part == "rotor") series.u = file.values[static_cast<std::size_t>(u)];
    plot.series.push_back(series);
  }
  return plot;
}

std::string number(const json& value) {
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : kNotRecorded;
}
std::string number(const json& value, double factor) {
  return value.is_number() ? fmt::format("{:.3g}", factor * value.get<double>()) : kNotRecorded;
}

Table number_table(const json& p) {
  Table table{
      "Numbers of the whole drum; u is the standard uncertainty (k = 1)", {"quantity", "value", "u", "unit"}, {}};
  const auto add = [&](const std::string& name, const json& value, const std::string& u, const std::string& unit) {
    if (value.is_number()) table.rows.push_back({name, number(value), u, unit});
  };
  add("mean torque on the grains", p.at("torque_Nm"), number(p.at("torque_u_Nm")), "N m");
  for (const auto& [part, t] : p.at("parts").items())
    add("of the " + part, t.at("torque_Nm"), number(t.at("torque_u_Nm")), "N m");
  add("torque ripple", p.at("torque_ripple"), number(p.at("torque_ripple_u")), "1");
  add("loaded power", p.at("power_loaded_W"), number(p.at("power_loaded_u_W")), "W");
  add("idling power", p.at("power_idle_W"), number(p.at("power_idle_u_W")), "W");
  add("mixing power", p.at("power_W"), number(p.at("power_u_W")), "W");
  add("N_P, power number", p.at("N_P"), "", "1");
  add("N_PC, cohesive power number", p.at("N_PC"), "", "1");
  add("N_C, cohesion number", p.at("N_C"), "", "1");
  add("Fr_M, mixing Froude number", p.at("Fr_M"), "", "1");
  add("published equation", p.at("thesis_power_W"), "",
      p.at("thesis_in_range").get<bool>() ? "W" : "W, outside its range");
  return table;
}

Table limit_table(const json& p) {
  const json& q = p.at("quality");
  Table table{"Limits every reported power is held to", {"quantity", "value", "limit"}, {}};
  table.rows = {
      {"time step over the shortest half period", number(q.at("dt_over_tc")), fmt::format("{}", kMostDtOverTc)},
      {"mean overlap, % of the diameter", number(q.at("overlap_mean"), 100), fmt::format("{}", 100 * kMostOverlapMean)},
      {"greatest overlap, % of the diameter", number(q.at("overlap_max"), 100),
       fmt::format("{}", 100 * kMostOverlapMax)},
      {"lost grains", number(q.at("lost_grains")), "0"},
      {"turns averaged", number(p.at("turns_averaged")),
       fmt::format("at least {}; of parts of a turn {}", kLeastAveragedTurns, kLeastPartTurns)},
      {"effective samples", number(p.at("effective_samples")), fmt::format("at least {}", kFewSamples)},
      {"energy left over, % of the work", number(q.at("energy_closure_relative"), 100),
       fmt::format("{}", 100 * kMostEnergyGap)},
      {"torque balance, % of the rotor's", number(q.at("torque_balance_relative"), 100), "three u"}};
  return table;
}

void add_alone(const json& p, Page& page) {
  const double power = p.at("power_W"), u95 = p.at("power_u95_W");
  const bool ok = p.at("quality").at("ok"), provisional = p.at("provisional"), in_range = p.at("thesis_in_range");
  const bool thesis = p.at("thesis_power_W").is_number();
  std::string material = p.at("material");
  std::replace(material.begin(), material.end(), '_', ' ');
  if (material.empty()) material = "the grain";
  page.figures.push_back({"Mixing power", fmt::format("{:.1f} ± {:.1f} W", power, u95), "95 % interval of the mean"});
  if (thesis)
    page.figures.push_back({"Published equation", fmt::format("{:.1f} W", p.at("thesis_power_W").get<double>()),
                            fmt::format("the run is {:+.1f} % from it", 100 * p.at("relative_gap").get<double>())});
  page.figures.push_back({"Cohesive power number N_PC", number(p.at("N_PC")),
                          fmt::format("N_C {}, Fr_M {}", number(p.at("N_C")), number(p.at("Fr_M")))});
  page.figures.push_back({"Limits of the run",
                          ok ? "all met" : fmt::format("{} violated", p["quality"]["warnings"].size()), "listed below",
                          !ok});
  page.summary.push_back({fmt::format(
      "To stir {} at {:g} 1/s{} takes {:.1f} W (95 % interval {:.1f} to {:.1f} W), "
      "{:.1f} kJ for each minute of mixing. The assumed bulk density adds a common scale of ± {:g} %. Bearings and air "
      "are not in it.",
      material, p.at("speed").get<double>(),
      p.at("fill").is_number() ? fmt::format(", the drum filled to {:.3g} %,", 100 * p.at("fill").get<double>()) : "",
      power, power - u95, power + u95, 0.06 * power, 100 * p.at("scale_uncertainty").get<double>())});
  if (thesis)
    page.summary.push_back({fmt::format(
        "The published equation gives {:.1f} W at this point{}; it is itself up to {:.1f} % off its measurements.",
        p["thesis_power_W"].get<double>(), in_range ? "" : ", outside the range it was fitted in",
        100 * ThesisEquation::max_relative_error)});
  if (provisional)
    page.summary.push_back({"Provisional: the material card of " + material +
                                " is not calibrated yet. Do not decide anything by these numbers.",
                            Paragraph::Tone::warning});
}

}  // namespace

bool is_power_run(const std::string& folder) {
  std::ifstream in(fs::path(folder) / "torque.csv");
  bool found = static_cast<bool>(in), other = false;
  for (std::string line; std::getline(in, line) && line.rfind('#', 0) == 0;)
    other = other ||
            (line.rfind("# rig=", 0) == 0 && line.rfind("# rig=mixer", 0) != 0 && line.rfind("# rig=machine", 0) != 0);
  return found && !other;
}

std::optional<PowerPoint> add_run(RunOfReport& run, bool alone, Page& page) {
  const fs::path folder(run.folder), post = folder / "post";
  Section section{titled(run.name, "Run"), {}, !alone};
  const auto use = [&](const fs::path& path) {
    run.read.push_back(path.string());
    return path.string();
  };
  const TorqueRecord record = read_torque_record(use(folder / "torque.csv"));
  const bool idling = record.header.idling();
  std::optional<json> power;
  std::optional<PowerPoint> point;
  if (fs::exists(post / "power.json")) {
    const std::string path = use(post / "power.json");
    try {
      power = read_json_file(path, "evaluate the run again");
      if (record.header.rig == "mixer") point = power_point(*power, path, run.name);
      if (alone) add_alone(*power, page);
      for (const json& warning : power->at("quality").at("warnings")) {
        const Paragraph text{titled(run.name, "Limit violated") + ": " + warning.get<std::string>(),
                             Paragraph::Tone::warning};
        section.blocks.push_back(text);
        page.summary.push_back(text);
      }
      for (const json& note : power->at("quality").at("notes"))
        section.blocks.push_back(Paragraph{"Note: " + note.get<std::string>()});
      section.blocks.push_back(number_table(*power));
      section.blocks.push_back(limit_table(*power));
    } catch (const json::exception& error) {
      throw BadInput(path, 0, fmt::format("is no power.json ({})", error.what()), "run `vielto post` on the run again");
    }
  } else {
    section.blocks.push_back(
        Paragraph{idling ? "The empty machine: in the measurement chain its idling power is taken off the loaded runs'."
                         : "Not evaluated: `vielto post` on the run folder makes its power.",
                  idling ? Paragraph::Tone::plain : Paragraph::Tone::warning});
    if (!idling)
      page.summary.push_back({titled(run.name, "Not evaluated") + ": `vielto post` on the run folder makes its power.",
                              Paragraph::Tone::warning});
  }
  if (!run.picture.empty())
    section.blocks.push_back(
        Picture{"The rig at the end of the run, rendered from its meshes and grains", use(run.picture)});
  if (record.blocks > 0) {
    Plot torque = torque_plot(record, power);
    torque.file = named(run.name, "torque_over_time");
    torque.title = titled(run.name, idling ? "Idling torque over time" : "Torque over time");
    section.blocks.push_back(torque);
  }
  if (fs::exists(post / "phase.csv")) {
    Plot phase = phase_plot(use(post / "phase.csv"));
    phase.file = named(run.name, "torque_over_phase");
    phase.title = titled(run.name, "Torque over the phase of the turn");
    section.blocks.push_back(phase);
  }
  page.sections.push_back(std::move(section));
  return point;
}

}  // namespace vielto

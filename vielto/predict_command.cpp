// SPDX-License-Identifier: GPL-2.0-or-later
// vielto predict: mixing power, largest fill for a motor and energy of a mixing time after a fitted equation or the
// booklet's.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "core/csv.h"
#include "equation/equation_use.h"
#include "material_options.h"
#include "row_options.h"

namespace vielto {
namespace {

using nlohmann::json;

struct PredictOptions {
  std::string equation, mixer, wall, out;
  Role role = Role::fit;
  bool thesis = false, extrapolate = false, json = false;
  MaterialOptions materials;
  std::vector<double> speeds, fills, check_fills;
  bool covariance = false;
  double motor_power = 0, idle_power = 0, mixing_time = 0;
  std::optional<double> moisture;
};

EquationUse use_of(const PredictOptions& o) {
  EquationUse use;
  use.source = o.thesis ? "the booklet's equation" : o.equation;
  use.equation = o.thesis ? thesis_equation() : read_equation(o.equation);
  use.extrapolate = o.extrapolate;
  if (!o.mixer.empty()) use.mixer = MixerDimensions::read(o.mixer);
  const std::vector<BulkMaterial> materials = o.materials.read();
  if (materials.size() != 1)
    throw BadInput("--material", 0, "names more than one grain", "give one card, and the wall's with --wall");
  use.material = materials[0];
  if (!use.material.bulk_density || !use.material.bulk_cohesion)
    throw BadInput(use.material.name, 0, "the card does not state bulkDensity and bulkCohesion",
                   "add both to the card");
  if (!o.wall.empty()) use.wall = BulkMaterial::read(named_in("materials", o.wall, ".par"));
  return use;
}

std::string flag(const Prediction& p) {
  return p.outside.empty() ? "" : fmt::format("  OUTSIDE THE FITTED RANGE: {}", fmt::join(p.outside, ", "));
}

struct Report {
  json result;
  std::string text;
};

void add_powers(const PredictOptions& o, const EquationUse& use, Report& report) {
  report.text += fmt::format("{:>8}{:>7}{:>11}{:>10}{:>10}{:>10}{:>11}{:>11}", "speed", "fill",
                             number_name(use.equation.number), "power_W", "low95", "high95", "new_low95", "new_high95");
  if (o.mixing_time > 0) report.text += fmt::format("{:>12}{:>10}{:>10}", "energy_kJ", "low95", "high95");
  report.text += "\n";
  for (const double fill : o.fills) {
    for (const double speed : o.speeds) {
      const Prediction p = use.checked(fill, speed);
      json row = {{"speed", speed},
                  {"fill", fill},
                  {"number", p.number},
                  {"power", p.power},
                  {"low95", p.low95},
                  {"high95", p.high95},
                  {"u", p.u},
                  {"new_low95", p.new_low95},
                  {"new_high95", p.new_high95},
                  {"outside", p.outside}};
      report.text += fmt::format("{:>8.4g}{:>7.4g}{:>11.5g}{:>10.2f}{:>10.2f}{:>10.2f}{:>11.2f}{:>11.2f}", speed, fill,
                                 p.number, p.power, p.low95, p.high95, p.new_low95, p.new_high95);
      if (o.mixing_time > 0) {
        row["energy"] = {{"value", p.power * o.mixing_time},
                         {"low95", p.low95 * o.mixing_time},
                         {"high95", p.high95 * o.mixing_time},
                         {"unit", "J"}};
        report.text += fmt::format("{:>12.2f}{:>10.2f}{:>10.2f}", p.power * o.mixing_time / 1e3,
                                   p.low95 * o.mixing_time / 1e3, p.high95 * o.mixing_time / 1e3);
      }
      report.text += flag(p) + "\n";
      report.result["predictions"].push_back(row);
    }
  }
}

void add_largest_fills(const PredictOptions& o, const EquationUse& use, Report& report) {
  if (o.idle_power >= o.motor_power)
    throw BadInput("--idle-power", 0, "leaves nothing of the motor's power", "state less than --motor-power");
  for (const double speed : o.speeds) {
    const LargestFill fill = largest_fill(use, speed, o.motor_power - o.idle_power);
    if (!report.result.contains("largest_fill"))
      report.text +=
          fmt::format("largest fill for a motor of {:g} W, {:g} W of it idling (fitted fills {:g} to {:g})\n",
                      o.motor_power, o.idle_power, fill.range.low, fill.range.high);
    const auto in_words = [&](const std::optional<double>& limit) {
      if (!limit) return fmt::format("below {:g}", fill.range.low);
      return *limit == fill.range.high ? fmt::format("{:g} or more", *limit) : fmt::format("{:.4f}", *limit);
    };
    report.text += fmt::format("  speed {:g} 1/s: {} expected, {} with the power's upper 95 % limit\n", speed,
                               in_words(fill.expected), in_words(fill.safe));
    report.result["largest_fill"].push_back({{"speed", speed},
                                             {"motor_power", o.motor_power},
                                             {"idle_power", o.idle_power},
                                             {"expected", fill.expected ? json(*fill.expected) : json()},
                                             {"safe", fill.safe ? json(*fill.safe) : json()},
                                             {"range", {fill.range.low, fill.range.high}}});
  }
}

void write_rows(const PredictOptions& o, const EquationUse& use) {
  const auto role = [&](double fill) {
    return std::count(o.check_fills.begin(), o.check_fills.end(), fill) > 0 ? Role::check : o.role;
  };
  const std::vector<Observation> rows = predicted_rows(use, {o.fills, o.speeds, role, o.moisture});
  if (o.covariance)
    write_whole_file(std::filesystem::path(o.out).replace_extension(".covariance.csv").string(),
                     predicted_covariances(rows));
  write_observations(o.out, rows);
}

void predict_power(const PredictOptions& o) {
  if (o.thesis == !o.equation.empty()) throw CLI::RequiredError("either --equation FIT.json or --thesis");
  if (o.fills.empty() && o.motor_power == 0)
    throw CLI::RequiredError("--fills, or --motor-power for the largest fill,");
  if (o.fills.empty() && !o.out.empty()) throw CLI::RequiredError("--fills for the table of --out");
  const EquationUse use = use_of(o);

  Report report;
  report.result["schema"] = 1;
  report.result["equation"] = use.source;
  report.result["provisional"] = use.provisional();
  if (!o.fills.empty()) add_powers(o, use, report);
  if (o.motor_power > 0) add_largest_fills(o, use, report);
  if (use.provisional()) report.text += "note: provisional: a material card is not calibrated yet\n";
  if (o.thesis)
    report.text += fmt::format(
        "note: u = {:.1f} % of the power, from the booklet's maximum error of 13.7 % (doc/theory/equation.md)\n",
        100 * thesis_relative_u());
  if (!o.out.empty()) write_rows(o, use);
  std::fputs((o.json ? report.result.dump(2) + "\n" : report.text).c_str(), stdout);
}

}  // namespace

void add_predict_command(CLI::App& app) {
  auto o = std::make_shared<PredictOptions>();
  CLI::App* command = app.add_subcommand(
      "predict",
      "mixing power of a mixer, material, speed and fill after an equation\n"
      "low95 and high95 bound the equation's power, new_low95 and new_high95 one new measurement. Outside the fitted "
      "range\n"
      "of a group nothing is predicted without --extrapolate.\n"
      "Example: vielto predict --equation equation.json --mixer mixer.par --material hulled_millet.par --speeds 0.5,1 "
      "--fills 0.15\n"
      "Largest fill for a motor: ... --speeds 1 --motor-power 60 --idle-power 10\n"
      "Energy of a mixing time: ... --speeds 1 --fills 0.15 --mixing-time 3600");
  command->add_option("--equation", o->equation, "file of `vielto fit --out`");
  command->add_flag("--thesis", o->thesis, "the booklet's equation, N_PC = 15.68 l^1.04 N_C^0.1 Fr_M^-0.25");
  command->add_option("--mixer", o->mixer, "mixer file (mixer.par); without it L_kl = 0.114 m and no geometry groups");
  o->materials.add_to(command);
  command->add_option("--wall", o->wall, "material card of the mixer's wall, where the equation holds mu_d/mu_sz");
  command->add_option("--speeds,--speed", o->speeds, "rotational speeds, 1/s")
      ->delimiter(',')
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--fills,--fill", o->fills, "drum loading factors, 0 to 1")
      ->delimiter(',')
      ->check(CLI::Range(1e-6, 1.0));
  command->add_flag("--extrapolate", o->extrapolate, "predict outside the fitted range too, flagged");
  CLI::Option* motor = command->add_option("--motor-power", o->motor_power, "W: the largest fill this motor can mix")
                           ->check(CLI::PositiveNumber);
  command->add_option("--idle-power", o->idle_power, "W of the motor's power that the empty mixer takes")
      ->needs(motor)
      ->check(CLI::NonNegativeNumber);
  command->add_option("--mixing-time", o->mixing_time, "s: adds the energy of mixing")->check(CLI::PositiveNumber);
  command->add_flag("--json", o->json, "print JSON instead of tables");
  command->add_option("--out", o->out, "also write the powers as an observation table");
  add_role_option(command, o->role, "role of the rows in --out");
  command->add_option("--check-fills", o->check_fills, "fills whose rows in --out have the role check")->delimiter(',');
  command->add_flag(
      "--covariance", o->covariance,
      "also write OUT.covariance.csv: how the errors of one equation hang together (equation_covariance.h)");
  command->add_option("--moisture", o->moisture, "moisture (wet basis) of the rows in --out")
      ->check(CLI::Range(0.0, 1.0));
  command->callback([o] { predict_power(*o); });
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// vielto predict: mixing power, largest fill for a motor and energy of a mixing time after a fitted equation or the
// booklet's.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "core/csv.h"
#include "equation/equation_covariance.h"
#include "equation/power_equation.h"
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

struct Setting {
  std::string source;  // the equation, for messages
  Equation equation;
  MixerDimensions mixer;
  BulkMaterial material;
  std::optional<BulkMaterial> wall;

  Prediction at(double fill, double speed) const {
    const Groups groups = groups_of(fill, speed, mixer, material, wall ? &*wall : nullptr);
    return predict(equation, source, groups, speed, mixer, material);
  }
};

Setting setting_of(const PredictOptions& o) {
  Setting s;
  s.source = o.thesis ? "the booklet's equation" : o.equation;
  s.equation = o.thesis ? thesis_equation() : read_equation(o.equation);
  if (!o.mixer.empty()) s.mixer = MixerDimensions::read(o.mixer);
  const std::vector<BulkMaterial> materials = o.materials.read();
  if (materials.size() != 1)
    throw BadInput("--material", 0, "names more than one grain", "give one card, and the wall's with --wall");
  s.material = materials[0];
  if (!s.material.bulk_density || !s.material.bulk_cohesion)
    throw BadInput(s.material.name, 0, "the card does not state bulkDensity and bulkCohesion", "add both to the card");
  if (!o.wall.empty()) s.wall = BulkMaterial::read(named_in("materials", o.wall, ".par"));
  return s;
}

Prediction checked(const PredictOptions& o, const Setting& s, double fill, double speed) {
  Prediction p = s.at(fill, speed);
  if (!p.outside.empty() && !o.extrapolate)
    throw BadInput(s.source, 0,
                   fmt::format("does not hold at speed {} and fill {}: {}", speed, fill, fmt::join(p.outside, ", ")),
                   "stay inside, or add --extrapolate to be told all the same");
  return p;
}

std::string flag(const Prediction& p) {
  return p.outside.empty() ? "" : fmt::format("  OUTSIDE THE FITTED RANGE: {}", fmt::join(p.outside, ", "));
}

// The fill at which `power(fill)` reaches the motor's power, within `range`; the upper limit of the range if it is not
// reached there, nothing if it is exceeded everywhere. Power must grow with the fill.
template <class Power>
std::optional<double> largest_fill(Power power, double limit, const FittedRange& range) {
  if (power(range.low) > limit) return std::nullopt;
  if (power(range.high) <= limit) return range.high;
  double low = range.low, high = range.high;
  for (int i = 0; i < 100 && high - low > 1e-12 * high; ++i) {
    const double middle = (low + high) / 2;
    (power(middle) <= limit ? low : high) = middle;
  }
  return low;
}

struct Report {
  json result;
  std::string text;
};

void add_powers(const PredictOptions& o, const Setting& s, Report& report) {
  report.text += fmt::format("{:>8}{:>7}{:>11}{:>10}{:>10}{:>10}{:>11}{:>11}", "speed", "fill",
                             number_name(s.equation.number), "power_W", "low95", "high95", "new_low95", "new_high95");
  if (o.mixing_time > 0) report.text += fmt::format("{:>12}{:>10}{:>10}", "energy_kJ", "low95", "high95");
  report.text += "\n";
  for (const double fill : o.fills) {
    for (const double speed : o.speeds) {
      const Prediction p = checked(o, s, fill, speed);
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

void add_largest_fills(const PredictOptions& o, const Setting& s, Report& report) {
  const auto& range = s.equation.group_range[0];
  if (!range || range->high <= range->low)
    throw BadInput(s.source, 0, "was fitted at one fill", "fit rows of several fills to ask for the largest");
  if (o.idle_power >= o.motor_power)
    throw BadInput("--idle-power", 0, "leaves nothing of the motor's power", "state less than --motor-power");
  const double limit = o.motor_power - o.idle_power;
  report.text += fmt::format("largest fill for a motor of {:g} W, {:g} W of it idling (fitted fills {:g} to {:g})\n",
                             o.motor_power, o.idle_power, range->low, range->high);
  for (const double speed : o.speeds) {
    checked(o, s, range->low, speed);
    if (!(s.at(range->high, speed).power > s.at(range->low, speed).power))
      throw BadInput(s.source, 0, "has a power that does not grow with the fill",
                     "there is no largest fill to ask for");
    const auto expected = largest_fill([&](double fill) { return s.at(fill, speed).power; }, limit, *range);
    const auto safe = largest_fill([&](double fill) { return s.at(fill, speed).new_high95; }, limit, *range);
    const auto in_words = [&](const std::optional<double>& fill) {
      if (!fill) return fmt::format("below {:g}", range->low);
      return *fill == range->high ? fmt::format("{:g} or more", *fill) : fmt::format("{:.4f}", *fill);
    };
    report.text += fmt::format("  speed {:g} 1/s: {} expected, {} with the power's upper 95 % limit\n", speed,
                               in_words(expected), in_words(safe));
    report.result["largest_fill"].push_back({{"speed", speed},
                                             {"motor_power", o.motor_power},
                                             {"idle_power", o.idle_power},
                                             {"expected", expected ? json(*expected) : json()},
                                             {"safe", safe ? json(*safe) : json()},
                                             {"range", {range->low, range->high}}});
  }
}

std::vector<Observation> observations(const PredictOptions& o, const Setting& s) {
  std::vector<Observation> rows;
  for (const double fill : o.fills) {
    for (const double speed : o.speeds) {
      const Prediction p = checked(o, s, fill, speed);
      Observation row;
      row.test = fmt::format("l{:.4g}_n{:.4g}", fill, speed);
      row.role = std::count(o.check_fills.begin(), o.check_fills.end(), fill) > 0 ? Role::check : o.role;
      row.apparatus = "mixer";
      row.observable = "power";
      // Six digits are far more than the equation is good for, and read better.
      row.value = std::stod(fmt::format("{:.6g}", p.power));
      row.u = std::stod(fmt::format("{:.3g}", p.u));
      row.unit = "W";
      row.speed = speed;
      row.fill = fill;
      row.moisture = o.moisture;
      row.wall = s.wall ? s.wall->name : "";
      row.material = s.material.name;
      rows.push_back(row);
    }
  }
  return rows;
}

// Beside TABLE.csv: TABLE.covariance.csv, the errors of one equation hang together.
void write_covariance(const std::string& table, const std::vector<Observation>& rows) {
  const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
  Eigen::VectorXd fill(n), speed(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    fill[i] = *rows[static_cast<std::size_t>(i)].fill;
    speed[i] = *rows[static_cast<std::size_t>(i)].speed;
  }
  Eigen::MatrixXd correlation;
  try {
    correlation = equation_error_correlation(fill, speed);
  } catch (const std::invalid_argument& error) {
    throw BadInput("--covariance", 0, error.what(), "ask for a grid of --speeds and --fills");
  }
  std::string text = "test_a,observable_a,test_b,observable_b,covariance\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = i + 1; j < rows.size(); ++j)
      text +=
          fmt::format("{},power,{},power,{:.6g}\n", rows[i].test, rows[j].test,
                      correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * rows[i].u * rows[j].u);
  write_whole_file(std::filesystem::path(table).replace_extension(".covariance.csv").string(), text);
}

void predict_power(const PredictOptions& o) {
  if (o.thesis == !o.equation.empty()) throw CLI::RequiredError("either --equation FIT.json or --thesis");
  if (o.fills.empty() && o.motor_power == 0)
    throw CLI::RequiredError("--fills, or --motor-power for the largest fill,");
  if (o.fills.empty() && !o.out.empty()) throw CLI::RequiredError("--fills for the table of --out");
  const Setting s = setting_of(o);
  const Equation& e = s.equation;

  Report report;
  report.result["schema"] = 1;
  report.result["equation"] = s.source;
  report.result["provisional"] = e.provisional || s.material.provisional;
  if (!o.fills.empty()) add_powers(o, s, report);
  if (o.motor_power > 0) add_largest_fills(o, s, report);
  if (e.provisional || s.material.provisional)
    report.text += "note: provisional: a material card is not calibrated yet\n";
  if (o.thesis)
    report.text += fmt::format(
        "note: u = {:.1f} % of the power, from the booklet's maximum error of 13.7 % (doc/theory/equation.md)\n",
        100 * thesis_relative_u());
  if (!o.out.empty()) {
    const std::vector<Observation> rows = observations(o, s);
    if (o.covariance) write_covariance(o.out, rows);
    write_observations(o.out, rows);
  }
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

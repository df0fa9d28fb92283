// SPDX-License-Identifier: GPL-2.0-or-later
// vielto import yade: torque and positions that a Yade script of one's own has saved -> rows of an observation table.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "core/lone_value.h"
#include "core/mixing_numbers.h"
#include "core/observation_table.h"
#include "core/steady_part.h"
#include "import/column_text.h"
#include "import/sampled_torque.h"
#include "import/sphere_file.h"
#include "rigs/drum/bed_shape.h"
#include "rigs/mixing_power.h"
#include "rigs/whole_shaft.h"
#include "row_options.h"

namespace vielto {
namespace {

struct ImportOptions : RowOptions {
  std::string torque, idle;
  TorqueColumns columns{"t", "", 1, 1, {}, false};
  int turns = kLeastAveragedTurns;
  bool ripple = false;

  std::vector<std::string> bed;
  std::string angle_of, across = "y", up = "z";
  std::vector<double> window, box;
  double length_factor = 1, grain_density = 0;
};

int axis_of(const std::string& name) { return name[0] - 'x'; }

Observation row_of(const ImportOptions& o, const std::string& apparatus, const std::string& observable, double value,
                   double u) {
  Observation row = o.row;
  row.apparatus = apparatus;
  return with_value(row, observable, value, u);
}

struct SteadyTorque {
  std::vector<double> signal;
  AveragedTurns turns;
  MeanUncertainty mean;
};

SteadyTorque steady_torque(const ImportOptions& o, const std::string& path) {
  const SampledTorque sampled = sampled_torque(read_column_text(path), o.columns, *o.row.speed);
  SteadyTorque result;
  result.turns = steady_turns(path, 0, sampled.signal, o.turns);
  result.mean = mean_over(sampled.signal, result.turns);
  if (!(result.mean.mean > 0))
    throw BadInput(path, 0, o.columns.torque, fmt::format("has the mean {:.4g} N m", result.mean.mean),
                   "the drive supplies positive torque; turn the sign with --torque-factor -1");
  fmt::print("{}: {} whole turns of {:.0f} samples, {} averaged from turn {} on; torque {:.6g} N m, u {:.2g} N m\n",
             path, sampled.turns, sampled.samples_per_turn, result.turns.count, result.turns.first + 1,
             result.mean.mean, result.mean.u);
  const auto from = sampled.signal.begin() + static_cast<std::ptrdiff_t>(result.turns.first) * kPhases;
  if (const auto lone = lone_value({from, from + static_cast<std::ptrdiff_t>(result.turns.count) * kPhases}))
    fmt::print("note: the torque near turn {:.2f} alone moves the mean from {:.4g} to {:.4g} N m: look at these rows\n",
               result.turns.first + static_cast<double>(lone->index) / kPhases, lone->without, lone->mean);
  if (result.mean.effective_samples < kFewSamples)
    fmt::print("note: only {:.1f} effective samples, u is itself uncertain\n", result.mean.effective_samples);
  result.signal = sampled.signal;
  return result;
}

void add_torque_rows(const ImportOptions& o, std::vector<Observation>& rows) {
  const SteadyTorque loaded = steady_torque(o, o.torque);
  const double watt = shaft_power(1, *o.row.speed);
  if (o.idle.empty()) {
    rows.push_back(row_of(o, "mixer", "power", watt * loaded.mean.mean, watt * loaded.mean.u));
  } else {
    const SteadyTorque idle = steady_torque(o, o.idle);
    rows.push_back(row_of(o, "mixer", "power_loaded", watt * loaded.mean.mean, watt * loaded.mean.u));
    rows.push_back(row_of(o, "mixer", "power_idle", watt * idle.mean.mean, watt * idle.mean.u));
  }
  if (o.ripple) {
    TorqueRecord whole;  // its rotor is the one signal
    whole.parts = {{"rotor"}};
    whole.part = {loaded.signal};
    const ShaftCurves curves = shaft_curves(whole, loaded.turns.first, loaded.turns.count);
    rows.push_back(row_of(o, "mixer", "torque_ripple", curves.ripple, std::max(curves.ripple_u, 1e-9)));
  }
}

void add_bed_rows(const ImportOptions& o, std::vector<Observation>& rows) {
  std::vector<Estimate> angles, densities;
  for (const std::string& path : o.bed) {
    const std::vector<Grain> grains = read_spheres(path, o.length_factor);
    try {
      if (!o.angle_of.empty()) {
        std::optional<std::pair<double, double>> window;
        if (!o.window.empty()) window = {o.window[0], o.window[1]};
        angles.push_back(surface_angle(grains, {axis_of(o.across), axis_of(o.up)}, window));
      }
      if (!o.box.empty()) {
        std::array<double, 6> box{};
        std::copy(o.box.begin(), o.box.end(), box.begin());
        densities.push_back(bulk_density(grains, o.grain_density, box));
      }
    } catch (const std::invalid_argument& error) {
      throw BadInput(path, 0, error.what(), "choose --window or --box inside the bed");
    }
  }
  const auto add = [&](const std::string& apparatus, const std::string& observable, const std::vector<Estimate>& all) {
    const Estimate e = over_time(all);
    if (!(e.u > 0))
      throw BadInput(o.bed[0], 0, observable + " has no scatter to take an uncertainty from",
                     "choose a larger --window or --box");
    rows.push_back(row_of(o, apparatus, observable, e.value, e.u));
  };
  if (!angles.empty()) add(o.angle_of, "angle", angles);
  if (!densities.empty()) add(o.angle_of.empty() ? "mixer" : o.angle_of, "bulk_density", densities);
}

// What an option needs beside it, in one line instead of CLI11's several.
void check(const ImportOptions& o) {
  const auto refuse = [](const std::string& what, const std::string& mend) {
    throw BadInput("vielto import yade", 0, what, mend);
  };
  if (o.torque.empty() && o.bed.empty()) refuse("imports nothing", "give --torque FILE, --bed FILE, or both");
  if (!o.torque.empty() && o.columns.torque.empty()) refuse("--torque has no column", "name it with --torque-column");
  if (!o.torque.empty() && !(o.row.speed && *o.row.speed > 0))
    refuse("--torque has no speed", "give --speed, in turns a second");
  if (o.torque.empty() && (!o.idle.empty() || o.ripple))
    refuse("--idle and --ripple have no torque", "give --torque FILE");
  if (!o.bed.empty() && o.angle_of.empty() && o.box.empty())
    refuse("--bed makes no observation", "give --angle drum or repose, or --box with --grain-density");
  if (o.bed.empty() && (!o.angle_of.empty() || !o.box.empty()))
    refuse("--angle and --box have no bed", "give --bed FILE");
  if (o.box.empty() != (o.grain_density == 0)) refuse("--box and --grain-density go together", "give both or neither");
  for (std::size_t d = 0; d < o.box.size(); d += 2)
    if (!(o.box[d] < o.box[d + 1]))
      refuse("--box is turned inside out", "give it as x0 x1 y0 y1 z0 z1, each from low to high");
  if (!o.window.empty() && !(o.window[0] < o.window[1]))
    refuse("--window is turned inside out", "give it from low to high");
  if (o.across == o.up) refuse("--across and --up are the same axis", "name two axes");
}

void import_yade(const ImportOptions& o) {
  check(o);
  std::vector<Observation> rows = o.earlier();
  const std::size_t before = rows.size();
  if (!o.torque.empty()) add_torque_rows(o, rows);
  if (!o.bed.empty()) add_bed_rows(o, rows);
  write_observations(o.out, rows);
  for (std::size_t i = before; i < rows.size(); ++i)
    fmt::print("{}: {} {} = {:.6g} {}, u {:.2g}\n", o.out, rows[i].test, rows[i].observable, rows[i].value,
               rows[i].unit, rows[i].u);
}

}  // namespace

void add_import_command(CLI::App& app) {
  auto o = std::make_shared<ImportOptions>();
  CLI::App* import = app.add_subcommand("import", "results of other programs as rows of an observation table");
  import->require_subcommand(1);
  add_import_logger(*import);
  add_import_surface(*import);
  CLI::App* command = import->add_subcommand(
      "yade",
      "torque and positions saved by a Yade script (plot.saveDataTxt, VTKRecorder, export.text); see "
      "doc/guide/yade_results.md\n"
      "Example: vielto import yade --torque plot.txt --torque-column Tx --time-column t --speed 1 --fill 0.15 \\\n"
      "           --test seed1 --out observations.csv");
  o->add_to(command);
  command->add_option("--tilt", o->row.tilt, "deg, of the axis from horizontal")->check(CLI::Range(-90.0, 90.0));

  command->add_option("--torque", o->torque, "text with the torque on the rotor against time")->group("Torque");
  command->add_option("--idle", o->idle, "the same of the empty machine: rows power_loaded and power_idle")
      ->group("Torque");
  command->add_option("--torque-column", o->columns.torque, "its column, as the file names it")->group("Torque");
  command->add_option("--time-column", o->columns.time, "column of the time")->capture_default_str()->group("Torque");
  command->add_option("--torque-factor", o->columns.torque_factor, "times the column is N m; -1 turns the sign")
      ->capture_default_str()
      ->group("Torque");
  command->add_option("--time-factor", o->columns.time_factor, "times the column is s; O.dt if it holds O.iter")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Torque");
  command->add_option("--start", o->columns.start, "s, when the rotor began to turn (default: the first row)")
      ->group("Torque");
  command->add_flag("--skip-nan", o->columns.skip_nan, "leave out rows without a torque (other plot.addData calls)")
      ->group("Torque");
  command->add_option("--turns", o->turns, "steady whole turns asked for")
      ->check(CLI::Range(kLeastAveragedTurns, 1000000))
      ->capture_default_str()
      ->group("Torque");
  command->add_flag("--ripple", o->ripple, "also torque_ripple; only if the whole rotor was simulated")
      ->group("Torque");

  command
      ->add_option("--bed", o->bed,
                   ".vtu or .vtp of the spheres, or text with x y z r; several: snapshots in their order")
      ->group("Bed");
  command->add_option("--length-factor", o->length_factor, "times the file's lengths are m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Bed");
  command->add_option("--angle", o->angle_of, "slope of the free surface, as the angle of a drum or of a repose test")
      ->check(CLI::IsMember({"drum", "repose"}))
      ->group("Bed");
  command->add_option("--across", o->across, "horizontal axis along which the surface falls")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str()
      ->group("Bed");
  command->add_option("--up", o->up, "vertical axis")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str()
      ->group("Bed");
  command->add_option("--window", o->window, "m, from and to along --across (default: the middle half of the grains)")
      ->expected(2)
      ->group("Bed");
  command->add_option("--box", o->box, "m, x0 x1 y0 y1 z0 z1 inside the bed: bulk_density")->expected(6)->group("Bed");
  command->add_option("--grain-density", o->grain_density, "kg/m3, for --box")
      ->check(CLI::PositiveNumber)
      ->group("Bed");
  command->callback([o] { import_yade(*o); });
}

}  // namespace vielto

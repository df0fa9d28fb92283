// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/script_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/lone_value.h"
#include "core/mixing_numbers.h"
#include "import/sphere_file.h"
#include "rigs/drum/bed_shape.h"
#include "rigs/mixing_power.h"
#include "rigs/whole_shaft.h"

namespace vielto {
namespace {

// The ripple of a machine that repeats exactly; an observation's u must be above 0.
constexpr double kLeastRippleU = 1e-9;

struct SteadyTorque {
  std::vector<double> signal;
  AveragedTurns turns;
  MeanUncertainty mean;
};

SteadyTorque steady_torque(const ScriptTorque& torque, const std::string& path, double speed,
                           std::vector<std::string>& said) {
  SampledTorque sampled = sampled_torque(read_column_text(path), torque.columns, speed);
  SteadyTorque result;
  result.turns = steady_turns(path, 0, sampled.signal, torque.turns);
  result.mean = mean_over(sampled.signal, result.turns);
  if (!(result.mean.mean > 0))
    throw BadInput(path, 0, torque.columns.torque, fmt::format("has the mean {:.4g} N m", result.mean.mean),
                   "the drive supplies positive torque; turn the sign with --torque-factor -1");
  said.push_back(
      fmt::format("{}: {} whole turns of {:.0f} samples, {} averaged from turn {} on; torque {:.6g} N m, u {:.2g} N m",
                  path, sampled.turns, sampled.samples_per_turn, result.turns.count, result.turns.first + 1,
                  result.mean.mean, result.mean.u));
  const std::vector<double>& signal = sampled.signal;
  if (const auto lone = lone_value({signal.begin() + result.turns.begin(), signal.begin() + result.turns.end()}))
    said.push_back(fmt::format(
        "note: the torque near turn {:.2f} alone moves the mean from {:.4g} to {:.4g} N m: look at these rows",
        result.turns.first + static_cast<double>(lone->index) / kPhases, lone->without, lone->mean));
  if (result.mean.effective_samples < kFewSamples)
    said.push_back(
        fmt::format("note: only {:.1f} effective samples, u is itself uncertain", result.mean.effective_samples));
  result.signal = std::move(sampled.signal);
  return result;
}

}  // namespace

ScriptRows torque_rows(const ScriptTorque& torque, const Observation& common) {
  ScriptRows result;
  Observation row = common;
  row.apparatus = "mixer";
  const double watt = shaft_power(1, row.speed.value());
  const auto add = [&](const char* observable, double value, double u) {
    result.rows.push_back(with_value(row, observable, value, u));
  };
  const SteadyTorque loaded = steady_torque(torque, torque.file, *row.speed, result.said);
  if (torque.idle.empty()) {
    add("power", watt * loaded.mean.mean, watt * loaded.mean.u);
  } else {
    const SteadyTorque idle = steady_torque(torque, torque.idle, *row.speed, result.said);
    add("power_loaded", watt * loaded.mean.mean, watt * loaded.mean.u);
    add("power_idle", watt * idle.mean.mean, watt * idle.mean.u);
  }
  if (torque.ripple) {
    TorqueRecord whole;  // its rotor is the one signal
    whole.parts = {{"rotor"}};
    whole.part = {loaded.signal};
    const ShaftCurves curves = shaft_curves(whole, static_cast<int>(loaded.turns.begin()), loaded.turns.count);
    add("torque_ripple", curves.ripple, std::max(curves.ripple_u, kLeastRippleU));
  }
  return result;
}

ScriptRows bed_rows(const ScriptBed& bed, const Observation& common) {
  std::vector<Estimate> angles, densities;
  for (const std::string& path : bed.files) {
    const std::vector<Grain> grains = read_spheres(path, bed.length_factor);
    try {
      if (!bed.angle_of.empty()) angles.push_back(surface_angle(grains, {bed.axes[0], bed.axes[1]}, bed.window));
      if (bed.box) densities.push_back(bulk_density(grains, bed.grain_density, *bed.box));
    } catch (const std::invalid_argument& error) {
      throw BadInput(path, 0, error.what(), "choose --window or --box inside the bed");
    }
  }
  ScriptRows result;
  const auto add = [&](const std::string& apparatus, const char* observable, const std::vector<Estimate>& all) {
    const Estimate e = over_time(all);
    if (!(e.u > 0))
      throw BadInput(bed.files[0], 0, fmt::format("{} has no scatter to take an uncertainty from", observable),
                     "choose a larger --window or --box");
    Observation row = common;
    row.apparatus = apparatus;
    result.rows.push_back(with_value(row, observable, e.value, e.u));
  };
  if (!angles.empty()) add(bed.angle_of, "angle", angles);
  if (!densities.empty()) add(bed.angle_of.empty() ? "mixer" : bed.angle_of, "bulk_density", densities);
  return result;
}

}  // namespace vielto

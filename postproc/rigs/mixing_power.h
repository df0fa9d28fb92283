// SPDX-License-Identifier: GPL-2.0-or-later
// From a loaded and an idling torque record to the mixing power of the whole drum and its dimensionless numbers.
//
//   power         P = 2 pi n T, T the mean torque on the grains of the whole shaft (slice torque times N/k) over the
//                 steady whole turns (steady_part.h), with the uncertainty of an autocorrelated mean
//                 (mean_uncertainty.h)
//   power_loaded  2 pi n mean(torque on the grains + idling torque)
//   power_idle    2 pi n mean(idling torque of the idling record)
// The last two are the measurement chain. Grain torque holds no idling, so P needs neither.
//
// P is proportional to the assumed bulk density: kScaleUncertainty is common to every run of a material and not in u.
//
// Quality limits of every reported power: dt/t_c <= 1/20, mean overlap < 0.5 % and maximum < 5 % of the diameter over
// the averaged turns, no lost grain, the mass asked for within 2 %, no single interval that moves the mean
// (lone_value.h); where recorded, work = dissipation + change of energy within 1 %, and the torques of rotor, drum and
// gravity balance within three standard uncertainties. A violated one marks the power (warnings), it does not hide it.
//
// Errors: BadInput if a record has no steady part of the turns asked for (saying how many more), if the idling record
// is not one (fill 0) or ran at another speed (over 0.1 %), if the idling torque or the mean torque is not positive.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/mean_uncertainty.h"
#include "core/quality_limits.h"
#include "rigs/torque_record.h"
#include "rigs/whole_shaft.h"

namespace vielto {

constexpr double kScaleUncertainty = 0.05;     // relative
constexpr double kMostEnergyGap = 0.01;        // of the work
constexpr double kMostSpeedDifference = 1e-3;  // loaded to idling record
constexpr double kMostMassDifference = 0.02;   // of the mass asked for; a run of few large grains is half a grain off
constexpr double kFewSamples = 10;             // effective samples below which u is uncertain itself

// What is averaged: `first` of the record's blocks left out, `count` kept, each of `phases` values and `turns` turns.
struct AveragedTurns {
  int first = 0, count = 0;
  int phases = kPhases;
  double turns = 1;
  double slope = 0;    // of the kept means, per turn, over their mean
  double slope_p = 1;  // probability of such a slope in a steady signal

  std::ptrdiff_t begin() const { return static_cast<std::ptrdiff_t>(first) * phases; }  // in values of a signal
  std::ptrdiff_t end() const { return begin() + static_cast<std::ptrdiff_t>(count) * phases; }
  double turns_left_out() const { return first * turns; }
  double turns_kept() const { return count * turns; }
};

struct RunQuality {
  double dt_over_tc = 0, overlap_mean = 0, overlap_max = 0;
  double lost_grains = 0;
  double mass = 0, mass_target = 0;  // kg
  double intervals_per_turn = 0;
  std::optional<MeanUncertainty> torque_balance;  // rotor + drum + gravity, N m of the simulated domain
  double torque_balance_relative = 0;             // over the rotor torque
  std::optional<double> energy_gap;               // (work - dissipation - change of energy) / work
  std::vector<std::string> warnings;              // limits violated
  std::vector<std::string> notes;                 // what else a reader should know
  bool ok() const { return warnings.empty(); }
};

struct MixingPower {
  TorqueRecordHeader header;
  double turns_total = 0;
  double turn_first = 0;  // turns since the start of the rotation when the average begins
  AveragedTurns averaged;
  MeanUncertainty torque;                       // whole drum, N m
  MeanUncertainty power;                        // W
  std::optional<MeanUncertainty> loaded, idle;  // W
  std::vector<RecordedPart> part_names;
  std::vector<MeanUncertainty> parts;                        // torque of each, whole drum, N m
  std::optional<std::array<double, kLosses.size()>> losses;  // dissipated power of the whole drum, W; if recorded
  // Each if the record states what it needs: lever; bulk density; bulk cohesion.
  std::optional<double> n_p, n_pc, n_c, fr_m;
  // Of the mixer alone.
  std::optional<double> thesis_power;  // W
  bool in_thesis_range = false;
  std::optional<double> relative_gap;  // power over thesis_power, less 1
  ShaftCurves curves;
  RunQuality quality;
};

// The steady turns of a signal in blocks of `block` turns, `asked` turns at least and not below kLeastAveragedTurns
// blocks, of parts of a turn kLeastPartTurns turns; the record began at turn `first_turn`.
// Errors: BadInput naming `path` if there are not that many; it says how many more to run.
AveragedTurns steady_turns(const std::string& path, int first_turn, const std::vector<double>& signal, int asked,
                           double block = 1);

// Mean of a signal over these turns.
MeanUncertainty mean_over(const std::vector<double>& signal, const AveragedTurns& turns);

// `turns` asked for; 0: as many as steady_turns needs.
MixingPower mixing_power(const TorqueRecord& loaded, const TorqueRecord* idle, int turns);

}  // namespace vielto

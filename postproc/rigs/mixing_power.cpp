// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/mixing_power.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/bad_input.h"
#include "core/lone_value.h"
#include "core/mixing_numbers.h"
#include "core/steady_part.h"

namespace vielto {
namespace {

using Signal = std::vector<double>;

Signal sum(const Signal& a, double factor, const Signal& b) {
  Signal result = a;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] += factor * b[i];
  return result;
}

MeanUncertainty scaled(MeanUncertainty m, double factor) {
  m.mean *= factor;
  m.u *= std::fabs(factor);
  return m;
}

void check_idle(const TorqueRecord& record, const AveragedTurns& turns) {
  if (!(mean_over(record.idle, turns).mean > 0))
    throw BadInput(record.path, 0, "idle_Nm", "has no positive mean, so there is no idling to subtract",
                   "run the case with its idling model, or leave --idle out");
}

// The interval of a turn that moves the mean of the rotor's torque most, as a warning where it moves it by too much.
std::string lone_interval(const TorqueRecord& r, const Signal& rotor, const AveragedTurns& turns) {
  const std::vector<double> averaged(rotor.begin() + turns.begin(), rotor.begin() + turns.end());
  const std::optional<LoneValue> lone = lone_value(averaged);
  if (!lone) return "";
  const double turn = r.first_turn + (turns.first + static_cast<double>(lone->index) / turns.phases) * turns.turns;
  return fmt::format(
      "the torque near turn {:.2f} (step {:.0f}), {:.4g} N m, alone moves the mean torque from {:.4g} to {:.4g} N m: "
      "look at these rows",
      turn, r.start_step + turn * r.header.steps_per_turn, averaged[lone->index], lone->without, lone->mean);
}

// What the fill, density and drum of a mixer's header make.
double mass_of_the_fill(const TorqueRecordHeader& h) {
  if (h.rig != "mixer" || !h.fill || !h.bulk_density || !(h.drum_volume > 0)) return h.mass_target;
  return *h.fill * *h.bulk_density * h.drum_volume / h.whole_drum();
}

RunQuality run_quality(const TorqueRecord& r, const AveragedTurns& turns, const MeanUncertainty& torque,
                       const ShaftCurves& curves) {
  RunQuality q;
  q.dt_over_tc = r.header.dt_over_tc;
  q.overlap_mean = mean_over(r.overlap_mean, turns).mean;
  q.overlap_max =
      *std::max_element(r.overlap_max.begin() + turns.first, r.overlap_max.begin() + turns.first + turns.count);
  q.lost_grains = r.first_grains - r.last_grains;
  q.mass = r.header.mass;
  q.mass_target = r.header.mass_target;
  q.intervals_per_turn = r.intervals_per_turn;
  const auto warn = [&](bool violated, const std::string& text) {
    if (violated) q.warnings.push_back(text);
  };
  warn(q.dt_over_tc > kMostDtOverTc, fmt::format("time step is {:.3g} t_c, over {} t_c", q.dt_over_tc, kMostDtOverTc));
  warn(q.overlap_mean >= kMostOverlapMean, fmt::format("mean overlap is {:.3g} % of the diameter, the limit is {} %",
                                                       100 * q.overlap_mean, 100 * kMostOverlapMean));
  warn(q.overlap_max >= kMostOverlapMax, fmt::format("greatest overlap is {:.3g} % of the diameter, the limit is {} %",
                                                     100 * q.overlap_max, 100 * kMostOverlapMax));
  warn(q.lost_grains != 0, fmt::format("{} grains were lost", q.lost_grains));
  warn(!(std::fabs(q.mass - q.mass_target) <= kMostMassDifference * q.mass_target),
       fmt::format("the grains weigh {:.4g} kg where the fill asks for {:.4g} kg, the limit is {} %", q.mass,
                   q.mass_target, 100 * kMostMassDifference));
  const double stated = mass_of_the_fill(r.header);
  warn(!(std::fabs(q.mass_target - stated) <= kMostMassDifference * stated),
       fmt::format("mass_target_kg is {:.4g}, but fill, bulk_density and drum_volume make {:.4g} kg, the limit is {} %",
                   q.mass_target, stated, 100 * kMostMassDifference));

  const Signal rotor = r.rotor();
  const std::string lone = lone_interval(r, rotor, turns);
  warn(!lone.empty(), lone);
  if (!r.gravity.empty()) {
    q.torque_balance = mean_over(sum(sum(rotor, 1, r.standing()), 1, r.gravity), turns);
    q.torque_balance_relative = q.torque_balance->mean / mean_over(rotor, turns).mean;
    warn(std::fabs(q.torque_balance->mean) > 3 * q.torque_balance->u,
         fmt::format(
             "rotor, drum and gravity torque leave {:+.2g} % of the rotor torque, over three standard uncertainties",
             100 * q.torque_balance_relative));
  }
  if (!r.energy.empty()) {
    const EnergyAccounts &begin = r.energy[turns.first], &end = r.energy[turns.first + turns.count];
    const auto stored = [](const EnergyAccounts& e) { return e.kinetic + e.elastic + e.potential; };
    const double work = end.work - begin.work;
    q.energy_gap = (work - (end.dissipated() - begin.dissipated()) - (stored(end) - stored(begin))) / work;
    warn(!(std::fabs(*q.energy_gap) <= kMostEnergyGap),
         fmt::format("work exceeds dissipation and stored energy by {:+.2g} %, the limit is {} %", 100 * *q.energy_gap,
                     100 * kMostEnergyGap));
  }
  if (torque.effective_samples < kFewSamples)
    q.notes.push_back(
        fmt::format("only {:.1f} effective samples: the uncertainty is itself uncertain, average more turns",
                    torque.effective_samples));
  if (curves.ripple_noise > 0.5 * curves.ripple)
    q.notes.push_back(fmt::format("the torque ripple is mostly noise ({:.2g} of {:.2g}): average more turns",
                                  curves.ripple_noise, curves.ripple));
  if (r.intervals_per_turn < kPhases)
    q.notes.push_back(
        fmt::format("{:.3g} rows a turn for {} phases: the ripple is smoothed", r.intervals_per_turn, kPhases));
  return q;
}

void add_numbers(const TorqueRecordHeader& h, MixingPower& result) {
  const double power = result.power.mean;
  if (!h.power_lever) return;
  const double lever = *h.power_lever;
  result.fr_m = mixing_froude_number(lever, h.speed);
  if (h.bulk_density) result.n_p = power_number(power, lever, h.speed, *h.bulk_density);
  if (h.bulk_cohesion) result.n_pc = cohesive_power_number(power, lever, h.speed, *h.bulk_cohesion);
  if (!h.bulk_density || !h.bulk_cohesion) return;
  result.n_c = cohesion_number(lever, h.speed, *h.bulk_density, *h.bulk_cohesion);
  if (h.rig != "mixer") return;
  result.thesis_power = thesis_power(*h.fill, lever, h.speed, *h.bulk_density, *h.bulk_cohesion);
  result.in_thesis_range = *h.fill >= ThesisEquation::low_fill && *h.fill <= ThesisEquation::high_fill &&
                           h.speed >= ThesisEquation::low_speed && h.speed <= ThesisEquation::high_speed;
  result.relative_gap = power / *result.thesis_power - 1;
}

}  // namespace

MeanUncertainty mean_over(const std::vector<double>& signal, const AveragedTurns& turns) {
  return mean_uncertainty(std::vector<double>(signal.begin() + turns.begin(), signal.begin() + turns.end()),
                          turns.phases);
}

AveragedTurns steady_turns(const std::string& path, int first_turn, const std::vector<double>& signal, int asked,
                           double block) {
  AveragedTurns result;
  result.turns = block;
  if (block < 1) result.phases = static_cast<int>(std::lround(kPhases * block));
  const int least = block < 1 ? static_cast<int>(std::lround(kLeastPartTurns / block)) : kLeastAveragedTurns;
  const double turns = static_cast<double>(signal.size()) / result.phases * block;
  const int needed = std::max(least, static_cast<int>(std::ceil(asked / block - 1e-9)));
  const SteadyPart part = find_steady_part(signal, result.phases, needed);
  result.first = part.first, result.count = part.count, result.slope_p = part.slope_p;
  const double steady = asked > 0 ? asked : needed * block;
  const auto refuse = [&](const std::string& why, double more) {
    throw BadInput(path, 0,
                   fmt::format("has {:.4g} whole turn{}{}, and {:.4g} steady ones are asked for", turns,
                               turns == 1 ? "" : "s", why, steady),
                   fmt::format("run at least {:.4g} more", more));
  };
  double mean = 0;
  if (part.count > 0)
    mean = std::accumulate(signal.begin() + result.begin(), signal.begin() + result.end(), 0.0) /
           (static_cast<double>(part.count) * result.phases);
  switch (part.verdict) {
    case Steadiness::too_few_turns:
      refuse("", steady - turns);
      break;
    case Steadiness::start_up_reaches_limit:
      refuse(fmt::format(", the start-up still shows in turn {:.4g}", first_turn + part.first * block),
             (part.first + 1) * block);
      break;
    case Steadiness::trend:
      refuse(fmt::format(", the last {:.4g} still drift by {:+.2g} % a turn", part.count * block,
                         100 * part.slope / mean / block),
             steady);
      break;
    case Steadiness::steady:
      break;
  }
  result.slope = part.slope / mean / block;
  return result;
}

MixingPower mixing_power(const TorqueRecord& loaded, const TorqueRecord* idle, int turns) {
  const TorqueRecordHeader& h = loaded.header;
  if (h.idling())
    throw BadInput(loaded.path, 0, "is an idling record (fill 0)", "name a loaded record, and give this one to --idle");
  MixingPower result;
  result.header = h;
  const double block = loaded.turns_per_block;
  result.turns_total = loaded.blocks * block;
  const double scale = h.whole_drum();
  const Signal rotor = loaded.rotor();
  const AveragedTurns averaged = steady_turns(loaded.path, loaded.first_turn, rotor, turns, block);
  result.averaged = averaged;
  result.turn_first = loaded.first_turn + averaged.turns_left_out();

  result.torque = scaled(mean_over(rotor, averaged), scale);
  if (!(result.torque.mean > 0))
    throw BadInput(loaded.path, 0, fmt::format("the mean torque of the rotor is {:.4g} N m", result.torque.mean),
                   "check the direction of rotation");
  const double power_of_torque = shaft_power(1, h.speed);
  result.power = scaled(result.torque, power_of_torque);
  result.part_names = loaded.parts;
  for (const std::vector<double>& part : loaded.part) result.parts.push_back(scaled(mean_over(part, averaged), scale));

  if (idle) {
    if (!idle->header.idling())
      throw BadInput(
          idle->path, 0,
          fmt::format("is not an idling record ({})", idle->header.fill ? fmt::format("fill {}", *idle->header.fill)
                                                                        : fmt::format("{} kg", idle->header.mass)),
          "give --idle the record of the empty machine");
    if (std::fabs(idle->header.speed / h.speed - 1) > kMostSpeedDifference)
      throw BadInput(idle->path, 0,
                     fmt::format("idles at {} 1/s, the loaded record ran at {} 1/s", idle->header.speed, h.speed),
                     "give an idling record of the same speed");
    const AveragedTurns idling = steady_turns(idle->path, idle->first_turn, idle->idle, turns, idle->turns_per_block);
    check_idle(*idle, idling);
    check_idle(loaded, averaged);
    // The idling torque is the whole machine's, whatever slice of the grains was simulated.
    Signal whole = loaded.idle;
    for (std::size_t i = 0; i < whole.size(); ++i) whole[i] += scale * rotor[i];
    result.loaded = scaled(mean_over(whole, averaged), power_of_torque);
    result.idle = scaled(mean_over(idle->idle, idling), power_of_torque);
  }

  add_numbers(h, result);
  if (!loaded.energy.empty()) {
    // As parts of the work: the accounts are taken where rows end, which is not quite where turns meet.
    const EnergyAccounts &begin = loaded.energy[averaged.first], &end = loaded.energy[averaged.first + averaged.count];
    result.losses.emplace();
    for (std::size_t k = 0; k < kLosses.size(); ++k)
      (*result.losses)[k] = result.power.mean * (end.losses[k] - begin.losses[k]) / (end.work - begin.work);
  }
  // The last whole turns, or blocks of turns, of what is averaged.
  const int turning = averaged.count * averaged.phases / kPhases;
  result.curves = shaft_curves(loaded, static_cast<int>(averaged.end()) - turning * kPhases, turning);
  result.quality = run_quality(loaded, averaged, result.torque, result.curves);
  return result;
}

}  // namespace vielto

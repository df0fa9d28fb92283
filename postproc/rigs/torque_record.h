// SPDX-License-Identifier: GPL-2.0-or-later
// Torque record `torque.csv` of a rotor with parts by any name, schema 1: lines `# key=value`, a header, then rows of
// means over equal intervals of steps. `step`, `time_s` and `turn` are the end of the interval; turns count from the
// start of the rotation. Torque: what the part exerts on the grains about the axis in the direction of rotation, N m
// (positive: the drive supplies). Force: what the part exerts on the grains, N. Which parts turn and which stand is
// stated by the keys `turning` and `standing`; of the mixer, whose older records lack them, paddles, stems and shaft
// turn and the drum stands. overlap_mean and overlap_max: fractions of the grain diameter.
//
// Read as a stream and kept as means over phases of the turn: 72 values a whole turn and signal. An interval that
// reaches over several phases counts in each by its share of time. Turns that the record does not cover whole, at its
// start and end, are left out; no row inside is ever dropped.
//
// Memory is bounded (about 10 MB of signals), whatever the length: at kMostBlocks turns, pairs of neighbours become one
// block, their mean, and so on. All that is done with turns then holds for blocks of turns_per_block turns: batch means
// are what the steadiness test and the autocorrelation of a mean are made for. The turns of a last block that is not
// full are left out.
//
// A rotor that looks the same after a part of a turn says so by `turn_parts`: its blocks are these parts, so that a
// short record need not end with a turn. At kMostBlocks they become turns.
//
// Errors: BadInput with file, line and column for a missing key or column, a cut-off line, a value that is not a finite
// number, steps that do not follow each other by interval_steps, times or turns that do not follow the steps, no rows.
#pragma once

#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/steady_part.h"

namespace vielto {

constexpr int kMostBlocks = 1024;  // even
constexpr std::array<const char*, 5> kLosses = {"normal", "tangential", "sliding", "rolling", "twisting"};

struct TorqueRecordHeader {
  std::string rig = "mixer";
  double speed = 0;            // 1/s
  std::optional<double> fill;  // 1, drum loading factor; 0: idling record; a machine's may state its mass only
  // The mixer's own; a machine is whole.
  int slice = 0;                      // paddles in the periodic slice; 0: whole drum
  int paddles = 0;                    // in the whole drum
  std::vector<double> paddle_angles;  // rad, of the slice's paddles
  double paddle_angle_step = 0;       // rad, from one paddle of the drum to the next
  std::string paddle_handing;
  std::string seed;
  std::string material;
  bool provisional = false;
  double dt = 0;          // s
  double dt_over_tc = 0;  // 1, of the stiffest mode
  double steps_per_turn = 0;
  double interval_steps = 0;
  int turn_parts = 1;  // after which the machine looks the same; divides kPhases
  // Of a machine, each only if its record states it.
  std::optional<double> bulk_density;   // kg/m3
  std::optional<double> bulk_cohesion;  // Pa
  std::optional<double> power_lever;    // m
  double drum_volume = 0;               // m3
  double mass = 0;                      // kg, of the simulated grains
  double mass_target = 0;               // kg
  double clearance = 0;                 // m
  std::array<double, 3> axis = {1, 0, 0};

  bool idling() const { return fill ? *fill == 0 : mass == 0; }
  std::string what_ran() const;  // "hulled_millet (provisional), fill 0.15, 1 1/s, whole drum"
  // What is simulated, times this, is the whole drum.
  double whole_drum() const { return slice == 0 ? 1 : static_cast<double>(paddles) / slice; }
};

// Energy accounts of the grains, J; work and dissipation since the start of the rotation.
struct EnergyAccounts {
  double work = 0, kinetic = 0, elastic = 0, potential = 0;
  std::array<double, kLosses.size()> losses{};  // dissipated, in the order of kLosses
  double dissipated() const { return std::accumulate(losses.begin(), losses.end(), 0.0); }
};

struct RecordedPart {
  std::string name;
  bool turns = true;
};

struct TorqueRecord {
  std::string path;
  TorqueRecordHeader header;
  int first_turn = 0;  // turns since the start of the rotation when the first whole turn begins
  int blocks = 0;      // whole turns; of a long record several each, of a rotor that repeats in a turn parts of it
  double turns_per_block = 1;
  double start_step = 0;  // at which the rotation began
  double intervals_per_turn = 0;

  // Signals of the simulated domain, N m, kPhases values a turn.
  std::vector<RecordedPart> parts = {{"paddles"}, {"stems"}, {"shaft"}, {"drum", false}};
  std::vector<std::vector<double>> part = std::vector<std::vector<double>>(4);  // in the order of `parts`
  std::vector<double> idle;
  std::vector<double> gravity;              // torque of gravity on the grains; empty if not recorded
  std::vector<std::vector<double>> paddle;  // each paddle of a slice; empty for the whole drum

  std::vector<double> overlap_mean;  // 1, kPhases values a turn
  std::vector<double> overlap_max;   // 1, one value a block
  // At the first row that ends at or after the start of each block and the end of the last one; empty if not recorded.
  std::vector<EnergyAccounts> energy;

  double first_grains = 0, last_grains = 0;  // number of grains in the first and the last row

  // Values of a block.
  int block_phases() const {
    return turns_per_block < 1 ? static_cast<int>(std::lround(kPhases * turns_per_block)) : kPhases;
  }
  // Sum of the parts that turn; of those that stand.
  std::vector<double> rotor() const { return sum_of(true); }
  std::vector<double> standing() const { return sum_of(false); }

 private:
  std::vector<double> sum_of(bool turning) const;
};

TorqueRecord read_torque_record(const std::string& path);

}  // namespace vielto

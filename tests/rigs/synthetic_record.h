// SPDX-License-Identifier: GPL-2.0-or-later
// Torque records with a known answer, the same on every run: each paddle feels mean + swing * cos(its angle), stems and
// shaft a constant, all of it plus AR(1) noise and an exponential start-up on the rotor. Rows are exact means over
// their interval.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

struct SyntheticRecord {
  double speed = 1.21, fill = 0.15;  // 1/s, 1
  int slice = 4, paddles = 22;
  std::vector<double> angles = {0, 90, 180, 270};  // deg
  double angle_step = 90;                          // deg
  double rows_per_turn = 72;
  int turn_parts = 1;
  int steps_per_row = 50;
  double turns = 10;
  double start = 0;  // turns of rotation before the first row

  double paddle_mean = 0.15, paddle_swing = 0.02;  // N m, each paddle
  double stems = 0.1, shaft = 0.05;                // N m, of the simulated domain
  double noise = 0;                                // standard deviation of a row's rotor torque, N m
  double rho = 0;                                  // of the noise, from row to row
  double start_up = 0, start_up_turns = 1;         // N m and e-folding time of what the rotor feels too much at first
  double drift = 0;                                // N m a turn
  double idle = 0.6, idle_noise = 0.02;            // N m, and relative standard deviation
  unsigned seed = 1;

  bool energy = false, gravity = false;
  double energy_gap = 0;   // share of the work that is lost from the accounts
  double gravity_gap = 0;  // N m that the torques do not balance by
  double overlap_mean = 0.001, overlap_max = 0.01, dt_over_tc = 0.04;
  int lost_grains = 0;                      // missing in the last row
  std::map<std::string, std::string> keys;  // replaced, or left out if empty
  // Last change to a row before it is written: number from 0, values by column.
  std::function<void(int, std::map<std::string, double>&)> change;

  double rotor_mean() const { return slice_paddles() * paddle_mean + stems + shaft; }  // of the simulated domain, N m
  int slice_paddles() const { return slice > 0 ? slice : paddles; }
  double mass() const { return fill * 825 * 0.0474 * slice_paddles() / paddles; }  // kg

  std::string text() const;
  // Writes FOLDER/torque.csv.
  void write(const std::filesystem::path& folder) const {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "torque.csv", std::ios::binary) << text();
  }
};

// Mean over [from, to], in turns, of cos(2 pi turn + angle).
inline double mean_cosine(double from, double to, double angle) {
  const double pi = std::acos(-1.0);
  return (std::sin(2 * pi * to + angle) - std::sin(2 * pi * from + angle)) / (2 * pi * (to - from));
}

inline std::string SyntheticRecord::text() const {
  const double pi = std::acos(-1.0);
  const double dt = 1 / (speed * rows_per_turn * steps_per_row);
  const auto number = [](double value) {
    std::ostringstream out;
    out << std::setprecision(10) << value;
    return out.str();
  };
  std::string degrees;
  for (const double a : angles) degrees += (degrees.empty() ? "" : " ") + number(a);
  std::vector<std::pair<std::string, std::string>> header = {
      {"schema", "1"},
      {"rig", "mixer"},
      {"speed", number(speed)},
      {"fill", number(fill)},
      {"slice", number(slice)},
      {"paddles", number(paddles)},
      {"paddle_angles_deg", slice > 0 ? degrees : ""},
      {"seed", number(seed)},
      {"dt", number(dt)},
      {"dt_over_tc", number(dt_over_tc)},
      {"steps_per_turn", number(rows_per_turn * steps_per_row)},
      {"interval_steps", number(steps_per_row)},
      {"material", "hulled_millet"},
      {"provisional", "1"},
      {"bulk_density", "825"},
      {"bulk_cohesion", "6175"},
      {"power_lever", "0.114"},
      {"drum_volume", "0.0474"},
      {"mass_kg", number(std::floor(1000 * mass()) / 1000)},
      {"mass_target_kg", number(mass())},
      {"clearance", "0.001"},
      {"paddle_handing", "uniform"},
      {"paddle_angle_step_deg", number(angle_step)},
  };
  if (turn_parts > 1) header.emplace_back("turn_parts", number(turn_parts));
  std::string out;
  for (auto& [key, value] : header) {
    const auto other = keys.find(key);
    if (other != keys.end() && other->second.empty()) continue;
    out += "# " + key + "=" + (other != keys.end() ? other->second : value) + "\n";
  }

  std::vector<std::string> columns = {"step", "time_s", "turn", "idle_Nm"};
  const std::vector<std::string> parts = {"paddles", "stems", "shaft", "drum"};
  for (const auto& part : parts) columns.push_back(part + "_Nm");
  for (const auto& part : parts)
    for (const char* axis : {"x", "y", "z"}) columns.push_back(part + "_F" + axis + "_N");
  for (int k = 1; k <= slice; ++k) columns.push_back("paddle" + std::to_string(k) + "_Nm");
  if (gravity) columns.push_back("gravity_Nm");
  for (const char* c : {"overlap_mean", "overlap_max", "contacts", "grains", "kinetic_J"}) columns.push_back(c);
  if (energy)
    for (const char* c : {"work_J", "elastic_J", "potential_J", "diss_normal_J", "diss_tangential_J", "diss_sliding_J",
                          "diss_rolling_J", "diss_twisting_J"})
      columns.push_back(c);
  for (std::size_t i = 0; i < columns.size(); ++i) out += (i ? "," : "") + columns[i];
  out += "\n";

  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  double wander = noise * normal(random);
  double work = 0;
  const int rows = static_cast<int>(std::lround(turns * rows_per_turn));
  for (int i = 0; i < rows; ++i) {
    const double from = start + i / rows_per_turn, to = start + (i + 1) / rows_per_turn;
    if (i > 0) wander = rho * wander + std::sqrt(1 - rho * rho) * noise * normal(random);
    const double begin =
        start_up * start_up_turns * rows_per_turn * (std::exp(-from / start_up_turns) - std::exp(-to / start_up_turns));
    const double extra = (wander + begin + drift * 0.5 * (from + to)) / slice_paddles();
    std::map<std::string, double> row;
    row["step"] = (start * rows_per_turn + i + 1) * steps_per_row;
    row["time_s"] = to / speed;
    row["turn"] = to;
    row["idle_Nm"] = idle * (1 + idle_noise * normal(random));
    for (int k = 0; k < slice_paddles(); ++k) {
      const double angle = (slice > 0 ? angles.at(k) : k * angle_step) * pi / 180;
      const double torque = paddle_mean + paddle_swing * mean_cosine(from, to, angle) + extra;
      if (fill > 0) row["paddles_Nm"] += torque;
      if (slice > 0) row["paddle" + std::to_string(k + 1) + "_Nm"] = fill > 0 ? torque : 0;
    }
    row["stems_Nm"] = fill > 0 ? stems : 0;
    row["shaft_Nm"] = fill > 0 ? shaft : 0;
    const double rotor = row["paddles_Nm"] + row["stems_Nm"] + row["shaft_Nm"];
    row["drum_Nm"] = -0.4 * rotor;
    if (gravity) row["gravity_Nm"] = -0.6 * rotor + gravity_gap;
    row["overlap_mean"] = overlap_mean;
    row["overlap_max"] = overlap_max;
    row["contacts"] = 5000;
    row["grains"] = 3000 - (i == rows - 1 ? lost_grains : 0);
    row["kinetic_J"] = 0.2;
    if (energy) {
      work += rotor * 2 * pi / rows_per_turn;
      row["work_J"] = work;
      row["elastic_J"] = 0.01;
      row["potential_J"] = 1.5;
      for (const char* c :
           {"diss_normal_J", "diss_tangential_J", "diss_sliding_J", "diss_rolling_J", "diss_twisting_J"})
        row[c] = 0.2 * (1 - energy_gap) * work;
    }
    if (change) change(i, row);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::ostringstream field;
      field << std::setprecision(columns[c] == "step" ? 15 : 9) << row[columns[c]];
      out += (c ? "," : "") + field.str();
    }
    out += "\n";
  }
  return out;
}

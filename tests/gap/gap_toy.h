// SPDX-License-Identifier: GPL-2.0-or-later
// A toy rig for the tests of the diagnosis: formulas instead of simulations, with seed noise. It stands for no machine.
// The library, the truths with another law, and tables with a known effect all come from `toy_value`.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/observation_table.h"

namespace toy {

namespace fs = std::filesystem;

struct State {
  double friction = 25, rolling = 0.1;    // calibrated parameters
  std::map<std::string, double> effects;  // name -> strength
  double law = 0;                         // another law: what it does differently, of order 1
};

inline double effect(const State& s, const char* name) {
  const auto found = s.effects.find(name);
  return found == s.effects.end() ? 0 : found->second;
}

struct Kind {
  const char* apparatus;
  const char* observable;
  const char* unit;
  double noise;  // relative, of one seed
};
constexpr Kind kKinds[] = {{"mixer", "power", "W", 0.02},
                           {"mixer", "torque_ripple", "1", 0.05},
                           {"shearbox", "shear_stress_steady", "Pa", 0.02},
                           {"repose", "angle", "deg", 0.02}};

// Noise-free value under the conditions of `row`.
inline double value(const vielto::Observation& row, const State& s) {
  const double n = row.speed.value_or(1), l = row.fill.value_or(0.15);
  const double f = s.friction / 25, r = s.rolling / 0.1;
  const double cohesion = effect(s, "cohesion") / 300, shape = effect(s, "shape") / 0.4;
  const double wall = effect(s, "wall_friction") / 12, dissipation = effect(s, "dissipation") / 0.33;
  if (row.observable == "power") {
    double p = 30 * std::pow(n, 1.1) * (l / 0.15) * std::pow(f, 0.5) * std::pow(r, 0.1);
    p *= 1 + 0.9 * cohesion * std::pow(n, -0.8) + 0.35 * shape * (l / 0.15) + 0.5 * wall +
         0.25 * dissipation * (n * n - 0.6);
    p *= 1 + 0.03 * s.law * std::pow(n, 0.4);
    p *= 1 + effect(s, "sensor_gain");
    return p;
  }
  if (row.observable == "torque_ripple")
    return 0.2 * std::pow(n, 0.3) * (1 + 0.9 * cohesion - 0.5 * shape * n - 0.2 * wall + 0.5 * dissipation) *
           std::pow(f, -0.2) * (1 - 0.04 * s.law);
  if (row.observable == "shear_stress_steady")
    return *row.normal_stress * 0.45 * std::pow(f, 0.8) * std::pow(r, 0.1) *
           (1 + 0.2 * cohesion + 0.6 * shape + 0.02 * std::log(*row.shear_velocity / 0.001) * dissipation) *
           (1 + 0.01 * s.law);
  return 26 * std::pow(f, 0.4) * std::pow(r, 0.25) * (1 + 0.5 * cohesion + 0.45 * shape) * (1 - 0.01 * s.law);
}

// The tests of the toy: rows with conditions, without values.
inline std::vector<vielto::Observation> rows(const std::vector<double>& speeds, const std::vector<double>& fills,
                                             const std::vector<double>& velocities) {
  std::vector<vielto::Observation> result;
  vielto::Observation row;
  row.role = vielto::Role::fit;
  row.material = "toy";
  for (const double l : fills)
    for (const double n : speeds)
      for (int k = 0; k < 2; ++k) {
        vielto::Observation m = row;
        m.test = fmt::format("mixer_l{}_n{}", l, n);
        m.apparatus = kKinds[k].apparatus;
        m.observable = kKinds[k].observable;
        m.unit = kKinds[k].unit;
        m.speed = n;
        m.fill = l;
        result.push_back(m);
      }
  for (const double v : velocities) {
    vielto::Observation s = row;
    s.test = fmt::format("shear_v{}", v);
    s.apparatus = "shearbox";
    s.observable = "shear_stress_steady";
    s.unit = "Pa";
    s.normal_stress = 19610;
    s.shear_velocity = v;
    result.push_back(s);
  }
  vielto::Observation r = row;
  r.test = "repose";
  r.apparatus = "repose";
  r.observable = "angle";
  r.unit = "deg";
  result.push_back(r);
  return result;
}

inline double seed_noise(const vielto::Observation& row) {
  for (const Kind& k : kKinds)
    if (row.observable == k.observable && row.apparatus == k.apparatus) return k.noise;
  return 0;
}

inline const std::vector<double> kSpeeds = {0.45, 0.8, 1.2, 1.7}, kFills = {0.08, 0.15, 0.28},
                                 kVelocities = {0.0001, 0.03};

// Writes a response library. Effects with runs: `effects`, at the given strengths, two seeds each.
inline void write_library(const fs::path& folder, const std::map<std::string, std::vector<double>>& effects, double law,
                          unsigned seed, bool with_family = true, int baseline_seeds = 6) {
  fs::create_directories(folder);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::string design = "test,effect,strength,seed,run_hash,frictionAngle,rollingResistance\n";
  std::vector<vielto::Observation> table;
  long run = 0;
  const auto add = [&](const std::string& name, double strength, int s, const State& state) {
    std::map<std::string, std::string> names;
    for (vielto::Observation row : rows(kSpeeds, kFills, kVelocities)) {
      if (names.count(row.test) == 0) {
        const std::string id = fmt::format("{}_{}_{}_s{}_r{}", row.test, name, strength, s, ++run);
        names[row.test] = id;
        design += fmt::format("{},{},{},{},{:064x},{},{}\n", id, name, strength, s, run + 1000000L * seed,
                              state.friction, state.rolling);
      }
      row.value = value(row, state) * (1 + seed_noise(row) * normal(random));
      row.u = 0.01 * row.value;
      row.test = names[row.test];
      table.push_back(row);
    }
  };
  State base;
  base.law = law;
  for (int s = 1; s <= baseline_seeds; ++s) add("none", 0, s, base);
  for (const auto& [name, strengths] : effects)
    for (const double strength : strengths)
      for (int s = 1; s <= 2; ++s) {
        State state = base;
        state.effects[name] = strength;
        add(name, strength, s, state);
      }
  if (with_family) {
    for (const auto& [friction, rolling] :
         std::vector<std::pair<double, double>>{{23, 0.1}, {27, 0.1}, {25, 0.08}, {25, 0.12}, {23, 0.12}, {27, 0.08}}) {
      State state = base;
      state.friction = friction;
      state.rolling = rolling;
      add("none", 0, 1, state);
    }
    // Repose and shear targets leave friction and rolling to trade off against each other.
    std::ofstream posterior(folder / "posterior.csv");
    posterior << "weight,frictionAngle,rollingResistance\n";
    for (int i = 0; i < 40; ++i) {
      const double z = normal(random), w = normal(random);
      posterior << fmt::format("1,{},{}\n", 25 + 1.0 * z, 0.1 * std::exp(-0.06 * z + 0.04 * w));
    }
  }
  std::ofstream(folder / "design.csv") << design;
  vielto::write_observations((folder / "observations.csv").string(), table);
}

inline void write_discrepancy(const fs::path& folder, double scale = 1) {
  std::ofstream(folder / "discrepancy.csv") << "apparatus,observable,sd,common,length,laws\n"
                                            << fmt::format("mixer,power,{},0.8,1,3\n", 0.03 * scale)
                                            << fmt::format("mixer,torque_ripple,{},0.9,1,3\n", 0.04 * scale)
                                            << fmt::format("shearbox,shear_stress_steady,{},0.9,1,3\n", 0.01 * scale)
                                            << fmt::format("repose,angle,{},0.9,1,3\n", 0.01 * scale);
}

// The runs of the toy's effects: what a small campaign would hold.
inline std::map<std::string, std::vector<double>> effects_with_runs() {
  return {{"cohesion", {100, 200, 300}},
          {"shape", {0.13, 0.27, 0.4}},
          {"wall_friction", {-8, 6, 12, 20}},
          {"dissipation", {-0.23, 0.17, 0.33}}};
}

// A measured table: truth with its own seeds, u of 2 %.
inline std::vector<vielto::Observation> measured(const State& state, std::mt19937_64& random,
                                                 double relative_u = 0.02) {
  std::normal_distribution<double> normal;
  std::vector<vielto::Observation> result = rows({0.5, 1.0, 1.5}, {0.1, 0.15, 0.25}, {0.001, 0.02});
  for (vielto::Observation& row : result) {
    const double truth = value(row, state);
    row.u = relative_u * truth;
    row.value = truth * (1 + seed_noise(row) * normal(random)) + row.u * normal(random);
    if (row.fill && *row.fill == 0.15) row.role = vielto::Role::check;
  }
  return result;
}

}  // namespace toy

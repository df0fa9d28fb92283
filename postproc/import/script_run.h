// SPDX-License-Identifier: GPL-2.0-or-later
// What a script of one's own, of Yade or another program, has saved of a run -> rows of an observation table.
//
// Torque over time (sampled_torque.h): P = 2 pi n T of the steady part's mean, with the empty machine's record the rows
// power_loaded and power_idle, without one the row power; torque_ripple if asked for. Positions (sphere_file.h), a file
// a look: the slope of the free surface (bed_shape.h) and the bulk density in a box, means over the looks with their
// autocorrelated scatter.
//
// Errors: BadInput with file, line and column; a torque whose mean is not above 0, a window or box beside the bed,
// looks that do not differ.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/observation_table.h"
#include "core/steady_part.h"
#include "import/sampled_torque.h"

namespace vielto {

struct ScriptTorque {
  std::string file, idle;  // idle: of the empty machine; may be empty
  TorqueColumns columns{"t", "", 1, 1, {}, false};
  int turns = kLeastAveragedTurns;
  bool ripple = false;
};

struct ScriptBed {
  std::vector<std::string> files;
  double length_factor = 1;                         // times the file's numbers is m
  std::string angle_of;                             // apparatus; empty: no angle
  std::array<int, 2> axes = {1, 2};                 // across, up
  std::optional<std::pair<double, double>> window;  // m, of the angle along `across`
  std::optional<std::array<double, 6>> box;         // m, of the density: x0 x1 y0 y1 z0 z1
  double grain_density = 0;                         // kg/m3
};

struct ScriptRows {
  std::vector<Observation> rows;
  std::vector<std::string> said;  // for people: what was averaged, and what to look at
};

// `common`: test, role and conditions; of a torque its speed.
ScriptRows torque_rows(const ScriptTorque& torque, const Observation& common);
ScriptRows bed_rows(const ScriptBed& bed, const Observation& common);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// What an equation of mixing power is asked for: the power of a setting, the largest fill for a motor, and a table of
// predictions with the covariance of their errors.
//
// Errors: BadInput that names the equation outside its fitted range, unless extrapolation is asked for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "equation/power_equation.h"

namespace vielto {

struct EquationUse {
  std::string source;  // the equation, for messages
  Equation equation;
  MixerDimensions mixer;
  BulkMaterial material;
  std::optional<BulkMaterial> wall;
  bool extrapolate = false;

  bool provisional() const { return equation.provisional || material.provisional; }
  Prediction at(double fill, double speed) const;       // inside the fitted range or not
  Prediction checked(double fill, double speed) const;  // Errors: BadInput outside it without `extrapolate`
};

// The fill at which the mixing power reaches a limit; the upper end of the fitted fills if it is not reached within
// them, nothing if it is exceeded in all of them.
struct LargestFill {
  std::optional<double> expected;
  std::optional<double> safe;  // of the upper 95 % limit of one new measurement
  FittedRange range;
};

// Errors: BadInput for an equation of one fill, or of a power that does not grow with the fill.
LargestFill largest_fill(const EquationUse& use, double speed, double power);

struct PredictedRows {
  std::vector<double> fills, speeds;
  std::function<Role(double fill)> role;
  std::optional<double> moisture;
};

// A row for each fill and speed, its value with six digits and its u with three.
std::vector<Observation> predicted_rows(const EquationUse& use, const PredictedRows& asked);

// The table beside them (TABLE.covariance.csv): errors of one equation hang together (equation_covariance.h).
// Errors: BadInput for rows that make no grid.
std::string predicted_covariances(const std::vector<Observation>& rows);

}  // namespace vielto

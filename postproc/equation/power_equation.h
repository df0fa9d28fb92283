// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: mixer power rows of observation tables with their groups, and equations of mixing power: made by a fit or
// the booklet's, kept as JSON, and evaluated with interval and range.
//
// Equation: P = N_PC C_h L^3 n, or N_P L^5 n^3 rho_h (numbers.h), with N from equation (1) of the booklet (groups.h).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/reduced_table.h"
#include "equation/dimensionless_groups.h"
#include "equation/power_law.h"

namespace vielto {

enum class PowerNumber { n_pc, n_p };
// "N_PC" or "N_P".
std::string number_name(PowerNumber number);

// P/N for a material with bulk_density and bulk_cohesion, W.
double power_scale(PowerNumber number, double speed, const MixerDimensions& mixer, const BulkMaterial& material);

struct PowerRow {
  std::string file;
  int line = 0;
  Observation observation;
  MixerDimensions mixer;
  BulkMaterial material;
  Groups groups;
};

struct PowerData {
  std::vector<PowerRow> fit, check;        // by role
  Eigen::SparseMatrix<double> covariance;  // of the power of the fit rows, W^2
  std::vector<std::string> covariance_paths;
  std::vector<std::string> notes;
};

// The `power` rows of the tables, table i in mixer i (or all in the one mixer). A row takes the material and the wall
// named in it; where only one grain is given, it stands for the one material of the rows under any name (with a note).
// Errors: BadInput for a row without speed, fill or a power above 0, or whose material is not among `materials` or does
// not state bulkDensity and bulkCohesion; a table without power rows.
PowerData power_data(const std::vector<ReducedTable>& tables, const std::vector<MixerDimensions>& mixers,
                     const std::vector<BulkMaterial>& materials);

struct FittedRange {
  double low = 0, high = 0;
};

struct Equation {
  PowerNumber number = PowerNumber::n_pc;
  std::vector<std::string> names;  // "B0", "B1" ...
  Eigen::VectorXd parameters;      // ln B0 and the exponents, 0 for aliases
  Eigen::MatrixXd covariance;      // of the parameters
  double quantile = 0;             // half width of a 95 % interval in standard errors
  double scatter = 0;              // relative standard deviation of one new measurement about the equation
  std::vector<Alias> aliases;
  // Where it was fitted; a group whose range is not known is not judged.
  std::array<std::optional<FittedRange>, kGroupCount> group_range;
  FittedRange lever;  // L_kl, m
  bool provisional = false;
};

// The booklet's equation (Thesis 3). Its 13.7 % is the maximum relative error over a grid whose number of points the
// booklet does not state. Taken as 16 independent normal errors (4 speeds, 4 fills), the expected largest magnitude is
// 2.1 standard deviations, so the relative standard uncertainty of a power is 6.6 % (8 points: 7.7 %, 100 points: 5.0
// %). It stands as the uncertainty of ln B0.
Equation thesis_equation();
double thesis_relative_u();

nlohmann::json to_json(const Equation& equation);
// Reads the file that `vielto fit` writes. Errors: BadInput.
Equation read_equation(const std::string& path);

struct Prediction {
  double number = 0;                        // N_PC or N_P
  double power = 0, low95 = 0, high95 = 0;  // W, of the equation
  double u = 0;                             // standard uncertainty of power, W
  double new_low95 = 0, new_high95 = 0;     // W, of one new measurement
  std::vector<std::string> outside;         // what lies outside the fitted range; empty: nothing
};

// The power at `groups` (of the same speed, mixer and material, see groups_of).
// Errors: BadInput (`source` names the equation) if a group of the equation is not known for this mixer and material,
// or if the prediction needs exponents apart that the fit did not tell apart.
Prediction predict(const Equation& equation, const std::string& source, const Groups& groups, double speed,
                   const MixerDimensions& mixer, const BulkMaterial& material);

}  // namespace vielto

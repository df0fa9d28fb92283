// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: what a measurement of the same machine in a reference state says about a changed one. Where calibration and
// contact law leave the simulation off, they leave it off in both states.
//
// Equation: of reference rows 0 and changed rows 1 together, all in logarithms where effects multiply, K = E + A + D
// what is uncertain about the simulation (emulator, calibrated family, contact law), U and S noise of the measurement
// and scatter of the runs (table_model.h). With W = (K_10 + U_10) (K_00 + U_00 + S_00)^-1 and the reference y0,
//   f + b  ->  f + b + W (y0 - f0 - b0),    K_11  ->  K_11 - W K_01 - K_10 W' + W K_00 W'   (each of E, A, D by itself)
// and `reference` = W (U_00 + S_00) W' + transfer K_11, where U_10 is 0; where rows of both states share errors, the
// measurement's part stands in the noise: U_11 - W U_01 - U_10 W' + W U_00 W'. The sum is the conditional covariance of
// y1 given y0. `transfer`: the part of K that the change itself may have moved (a machine that was rebuilt between).
// Effects are of the change: numerical ones cancel and are no candidates. A row of the bench that both states state (a
// gauge, a count of turns) shows what has changed since the reference's reading, whatever the card says: it may have
// been off in both by as much as any effect moves it.
//
// S must come from repeats of the measurement (question/repeats.h), never from the library: what hides it otherwise,
// calibration and law, cancels here.
#pragma once

#include <Eigen/Dense>
#include <string>

#include "gap/emulator/table_model.h"
#include "gap/library/settings.h"

namespace vielto::gap {

// `joint`: the reference's rows, then the changed ones. `reference`: the values y0 of the first rows, or what the model
// expects of them (expected_reference) before any data. Errors: BadInput for a value that is not above 0 where effects
// multiply.
TableModel given_reference(const TableModel& joint, const Eigen::VectorXd& reference, double transfer,
                           const Settings& settings);

// f0 + b0 of the first n rows, in their own units.
Eigen::VectorXd expected_reference(const TableModel& joint, Eigen::Index n);

// Chance of a chi^2 as large as that of the reference about the calibrated simulation.
double reference_probability(const TableModel& joint, const Eigen::VectorXd& reference);

}  // namespace vielto::gap

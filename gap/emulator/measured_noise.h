// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the covariance of the measured values of a table, as the likelihood can take it.
//
// Rows may share their errors wholly: one mean that is stated twice, replicates that differ by nothing. Such a
// covariance has no inverse, but it is no mistake. What is stated as shared is taken as shared but for a thousandth of
// u, the rounding of the stated numbers themselves: rows that agree count as one, and rows that contradict each other
// are explained by no model. The thousandth is there only where shared errors leave a row (or a combination of rows)
// less than that of its own.
//
// A covariance that no errors can have (correlations of -0.9 among three rows) is refused. Positive or not is judged on
// correlations, so that the units of the rows do not count.
//
// The emulator's own arithmetic resolves a hundred-thousandth of a value at best: a smaller u is raised to that.
//
// Errors: BadInput naming the covariance file.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "core/reduced_table.h"

namespace vielto::gap {

constexpr double kOwnPartOfSharedErrors = 1e-3;  // of u, a standard deviation
constexpr double kLeastRelativeU = 1e-5;         // of the value that the simulation has

Eigen::MatrixXd measured_noise(const ReducedTable& table);

// Rows of one test's conditions whose values differ by more than 5 standard deviations of what they do not share,
// `own` the further variance of each (seeds): no simulation explains that, whatever else is uncertain.
std::vector<std::string> contradictions(const std::vector<Observation>& rows, const Eigen::MatrixXd& noise,
                                        const Eigen::VectorXd& own);

// Raises variances to (kLeastRelativeU scale)^2, a row's correlations with them; tells each row in `notes`.
void raise_to_resolution(const std::vector<Observation>& rows, const Eigen::VectorXd& scale, Eigen::MatrixXd& noise,
                         std::vector<std::string>& notes);

}  // namespace vielto::gap

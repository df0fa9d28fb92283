// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: an observation table as fits and comparisons use it: one power for each mixer test, and the covariance of
// all rows.
//
// Equation: power = power_loaded - power_idle where a test states both (a `power` beside them is ignored); the
// covariance of the new rows is T V T', T the linear map from the rows that were read, V their covariance (u^2 on the
// diagonal, the rest from the covariance file). A power_idle without power_loaded is no power of grain and left out.
//
// The covariance file of TABLE.csv is TABLE.covariance.csv, or covariance.csv in the same folder; without either the
// rows are independent.
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "core/observation_table.h"

namespace vielto {

struct ReducedTable {
  std::string path;
  std::string covariance_path;  // empty: no file, rows are independent
  std::vector<Observation> rows;
  std::vector<int> lines;                  // line of each row in the file
  Eigen::SparseMatrix<double> covariance;  // both triangles
};

// The covariance file of a table; empty: there is none.
std::string covariance_file(const std::string& table);

// Errors: BadInput for a table or covariance file that is refused, and for power_loaded without power_idle or power.
ReducedTable read_reduced_table(const std::string& path);

}  // namespace vielto

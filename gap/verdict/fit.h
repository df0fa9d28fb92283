// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: whether a model explains a table: all of it, and each observable by itself. A name that explains the power
// and leaves the dead weight four standard deviations off is not the cause, though the rows that say nothing about it
// make the table's chi^2 look ordinary.
//
// Equation: at the most probable strengths s of the model and after one step of least squares from there,
// J = d mean/d s, d = y - mean(s), C = C(s). Residuals have the covariance R = C - J (J' C^-1 J)^-1 J' (strengths at an
// end of their range are not free and have no column in J).
//   all          chance of a chi^2 as large as d' C^-1 d with n - rank J degrees of freedom (at least 1)
//   observable   of the rows B of one observable of one apparatus: chance of d_B' R_BB^+ d_B with rank R_BB degrees,
//                times the number of observables (Bonferroni), at most 1; `worst` is the least of them
#pragma once

#include <string>

#include "gap/verdict/evidence.h"

namespace vielto::gap {

struct Fit {
  double all = 1;
  std::string apparatus, observable;  // the worst
  double worst = 1;
};

Fit fit_of(const TableModel& model, const ModelEvidence& m);

}  // namespace vielto::gap

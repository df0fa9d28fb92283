// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: how measured over simulated goes with a condition. Regions are judged one by one, with all in their u that
// the conditions share; a trend is free of that.
//
// For each observable, by generalised least squares over its n rows,
//   ln(y/f) = a + sum_c b_c ln(c) + error,   f the calibrated family's mean, c the conditions that are positive and
//   differ there; b = (X' V^-1 X)^-1 X' V^-1 ln(y/f),   cov b = (X' V^-1 X)^-1,   z = b_c/u_c,
// b_c the exponent by which the measurement departs from the simulation, V without any effect. q as for regions
// (Benjamini and Yekutieli). The model is one in logarithms; an observable with a row that is not has no trend, nor has
// one with as many unknowns as rows or with conditions that go together.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gap/emulator/table_model.h"

namespace vielto::gap {

struct Trend {
  std::string apparatus, observable, condition;
  double exponent = 0, u = 0, z = 0, p = 1, q = 1;
  std::vector<std::pair<std::string, double>> u_parts;  // source of uncertainty, its share of u (squares add up to u^2)
};

std::vector<Trend> trends_of(const TableModel& model);  // smallest q first

}  // namespace vielto::gap

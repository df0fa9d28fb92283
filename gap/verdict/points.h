// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: measured against simulated at every row of a table, before and after the effect, and what each effect alone
// would do: the numbers behind the pictures of a diagnosis.
//
// Equations (y, f, b, r, C as in table_model.h; rows in logarithms where effects multiply; D the fit rows, A the
// covariance of the calibrated family, V = C - noise what is uncertain about the simulation):
//   before         f + b,                                        covariance V(0)
//   recalibrated   f + b + K(0) (y_D - f_D - b_D),                the family moved as the fit rows ask, to first order
//   after          f + b + r(s) + K(s) (y_D - f_D - b_D - r_D(s)), covariance V(s) - K(s) A_Dx,   K(s) = A_xD
//   C_DD(s)^-1
// integrated over the posterior of the strengths s of the effects that the diagnosis applies (Diagnosis::applied).
// Bands: mean -/+ 1.96 standard deviations, on the scale of the row. The scatter of a single run is part of V.
// gap_left of an effect: root mean square over the fit rows of simulated over measured, less 1, recalibrated and with
// the effect at its median strength. The noise of the measurement is in it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gap/verdict/diagnosis.h"

namespace vielto::gap {

struct Band95 {
  double value = 0, low95 = 0, high95 = 0;
};

struct ComparedRow {
  Observation row;
  Band95 measured, before;
  std::optional<Band95> after;  // nothing if no effect is applied
};

struct EffectAlone {
  std::string name, unit;
  Interval strength;
  double gap_left = 0;
};

struct Points {
  std::vector<ComparedRow> points;
  double gap_before = 0, gap_recalibrated = 0;  // as gap_left
  std::vector<EffectAlone> effects;             // most probable first
};

// `model` holds all rows of the table, as for diagnose().
Points points_of(const TableModel& model, const Diagnosis& diagnosis);

// Adds `points`, `fit_gap`, and to each of `effects` its strength and gap_left.
void add_points(nlohmann::ordered_json& diagnosis, const Points& points);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the fit of equation (1) to mixer power: power_law.h applied to the rows of observation tables.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "equation/power_equation.h"
#include "equation/power_stream.h"

namespace vielto {

struct PowerFitRequest {
  PowerNumber number = PowerNumber::n_pc;
  std::vector<int> groups = {0, 1, 2};  // of kGroupNames
  std::map<std::string, double> fixed;  // "B3" -> -0.25; its group is added if it is not asked for
  Objective objective = Objective::absolute;
  bool weighted = true;  // by u and covariance
};

struct PowerFit {
  PowerFitRequest request;
  PowerData data;
  PowerLawFit law;
  Equation equation;
  std::vector<int> merged;           // groups asked for that are constant: in B0
  Eigen::VectorXd number, number_u;  // of the fit rows
  RelativeErrors check_errors;       // of the rows of role `check`
  Eigen::VectorXd check_power;       // W, predicted for them; empty for a stream
  RelativeErrors booklet_errors;     // of the booklet's equation against the fit rows
  std::vector<std::string> notes;    // what a reader must know, a line each
};

// Errors: BadInput (naming the first table) for rows that do not allow the fit or lack a group that is asked for.
PowerFit fit_power(const PowerFitRequest& request, PowerData data);

// The same of tables of any length. Coefficients, statistics and errors are of all rows; data.fit, number, and the
// residuals written out are of the stream's sample (a note says so if it is not all of them).
PowerFit fit_power(const PowerFitRequest& request, const PowerStream& stream);

// The booklet's value of a coefficient or combination of the fit; nothing where the booklet has none.
std::optional<double> booklet_value(const PowerFit& fit, const Coefficient& coefficient);

// "N_PC = 15.68 l^1.04 N_C^0.1 Fr_M^-0.25", without the groups that another one stands for.
std::string equation_text(const PowerFit& fit);

nlohmann::json power_fit_json(const PowerFit& fit);
std::string power_fit_text(const PowerFit& fit);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Power over speed and fill with an equation, parity and residuals: for simulated runs beside the booklet's equation,
// and for a fit of `vielto fit`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "equation/power_equation.h"
#include "report/page.h"

namespace vielto {

// One mixing power with what an equation needs to be drawn through it.
struct PowerPoint {
  std::string label, material;
  double speed = 0, fill = 0;          // 1/s, 1
  double power = 0, u95 = 0;           // W, half width of the 95 % interval
  double n_pc = 0, n_c = 0, fr_m = 0;  // of the point
  Groups groups;                       // as far as they are known
};

// From the numbers of post/power.json. Errors: BadInput naming `path`.
PowerPoint power_point(const nlohmann::json& power, const std::string& path, const std::string& label);

// Plots of simulated points and the booklet's equation.
std::vector<Plot> booklet_plots(const std::vector<PowerPoint>& points);

// Adds what a file of `vielto fit --out` says. Errors: BadInput.
void add_fit(const nlohmann::json& fit, const std::string& path, const std::string& name, Page& page);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The dimensionless numbers of mixing power and the equation fitted to the measurements.
//   N_P  = P / (L^5 n^3 rho_h)      power number
//   N_PC = P / (C_h L^3 n)          cohesive power number, = N_C N_P
//   N_C  = L^2 n^2 rho_h / C_h      cohesion number
//   Fr_M = L n^2 / g                mixing Froude number
//   N_PC = 15.68 l^1.04 N_C^0.1 Fr_M^(-1/4)   air-dry hulled millet, maximum relative error 13.7 %
// P mixing power of the whole drum, W; L power lever of a paddle, m; n rotational speed, 1/s; rho_h bulk density, kg/m3
// (the print calls it "bulk cohesion" once, a slip); C_h bulk cohesion, Pa; l drum loading factor, 1; g gravity, m/s2.
// Source: D. Horvath, thesis booklet, BME Budapest 2024, Theses 3 and 4, equations (2) and (3).
// Limits: the equation was fitted for l = 0.10 to 0.25 and n = 0.48 to 1.58 1/s, L = 0.114 m.
#pragma once

#include <cmath>

#include "core/pi.h"

namespace vielto {

constexpr double kGravity = 9.81;  // m/s2

// The fitted equation; every use takes its numbers from here.
struct ThesisEquation {
  static constexpr double factor = 15.68;           // B0
  static constexpr double fill_exponent = 1.04;     // B1
  static constexpr double cohesion_exponent = 0.1;  // B2
  static constexpr double froude_exponent = -0.25;  // B3
  static constexpr double max_relative_error = 0.137;
  static constexpr double low_fill = 0.10, high_fill = 0.25;    // 1
  static constexpr double low_speed = 0.48, high_speed = 1.58;  // 1/s
};

// Thesis 2: the largest relative error of mixing powers simulated with ViElTo, against measurements.
constexpr double kThesisModelLimit = 0.145;

// Power from the torque of the drive, N m, at `speed`, 1/s.
inline double shaft_power(double torque, double speed) { return 2 * kPi * speed * torque; }

inline double power_number(double power, double lever, double speed, double bulk_density) {
  return power / (std::pow(lever, 5) * std::pow(speed, 3) * bulk_density);
}

inline double cohesive_power_number(double power, double lever, double speed, double bulk_cohesion) {
  return power / (bulk_cohesion * std::pow(lever, 3) * speed);
}

inline double cohesion_number(double lever, double speed, double bulk_density, double bulk_cohesion) {
  return lever * lever * speed * speed * bulk_density / bulk_cohesion;
}

inline double mixing_froude_number(double lever, double speed) { return lever * speed * speed / kGravity; }

inline double thesis_cohesive_power_number(double fill, double cohesion_number, double froude_number) {
  return ThesisEquation::factor * std::pow(fill, ThesisEquation::fill_exponent) *
         std::pow(cohesion_number, ThesisEquation::cohesion_exponent) *
         std::pow(froude_number, ThesisEquation::froude_exponent);
}

// Power after the fitted equation, W.
inline double thesis_power(double fill, double lever, double speed, double bulk_density, double bulk_cohesion) {
  const double n_pc = thesis_cohesive_power_number(fill, cohesion_number(lever, speed, bulk_density, bulk_cohesion),
                                                   mixing_froude_number(lever, speed));
  return n_pc * bulk_cohesion * std::pow(lever, 3) * speed;
}

}  // namespace vielto

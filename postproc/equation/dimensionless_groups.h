// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the dimensionless groups of the general equation of mixing power, from mixer, material and setting.
//
// Equation (1) of the booklet, with N_PC or N_P on the left and constants merged into B0:
//   N = B0 l^B1 N_C^B2 Fr_M^B3 (L_d/W_kl)^B4 (D_d/d_sz)^B5 (H_d/H_kl)^B6 (alpha_kl/alpha_AoR)^B7 (mu_d/mu_sz)^B8
// The paddle number N_kl stands under l in print; B1 is on l and N_kl^-B1 is merged into B0, so that an equation holds
// for mixers of its own paddle number.
//
//   symbol     here                                   parameter files
//   L_d        drum length (along the axis)           drumLength of the mixer
//   D_d        drum width                             drumWidth
//   H_d        drum height                            drumHeight
//   W_kl       paddle width, its edge along the axis  paddleLength (figure 5; the edge is an assumption)
//   H_kl       paddle height, its radial edge         paddleWidth
//   alpha_kl   paddle inclination                     paddleInclination
//   d_sz       typical grain diameter                 diameter of the material
//   alpha_AoR  static angle of repose                 reposeAngle
//   mu_sz      friction coefficient of the bulk       tan(frictionAngle) of the material
//   mu_d       friction coefficient of the mixer      tan(frictionAngle) of the wall's material
//
// Source: D. Horvath, thesis booklet, BME Budapest 2024, equations (1) to (3), figure 5.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace vielto {

constexpr int kGroupCount = 8;
// The group of coefficient B(i+1).
extern const std::array<std::string, kGroupCount> kGroupNames;
// "B1" -> 0 ... "B8" -> 7; -1 for other text.
int group_of_coefficient(const std::string& coefficient);

struct MixerDimensions {
  double lever = 0.114;  // L_kl, m; the booklet's mixer (T3) if no file is read
  // Known if a file is read.
  std::optional<double> drum_length, drum_width, drum_height, paddle_width, paddle_height, inclination, paddle_count;

  // Errors: BadInput as of ParFile, or a number that is not above 0.
  static MixerDimensions read(const std::string& path);
};

struct BulkMaterial {
  std::string name;  // file name of the card without `.par`; empty if only the bulk numbers are stated
  bool provisional = false;
  // Whatever the card states; kg/m3, Pa, m, deg.
  std::optional<double> bulk_density, bulk_cohesion, diameter, repose_angle, friction_angle;
  // Relative standard uncertainty of bulk_density/bulk_cohesion, if the card states both.
  std::optional<double> ratio_u;

  static BulkMaterial read(const std::string& path);
};

// Values of the eight groups; empty where mixer, material or wall do not state what is needed.
using Groups = std::array<std::optional<double>, kGroupCount>;
Groups groups_of(double fill, double speed, const MixerDimensions& mixer, const BulkMaterial& material,
                 const BulkMaterial* wall);

}  // namespace vielto

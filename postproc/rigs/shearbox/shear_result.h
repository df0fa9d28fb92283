// SPDX-License-Identifier: GPL-2.0-or-later
// From the record of a direct shear test to shear stress, friction and the load plate's fluctuation.
//
//   shear stress     tau = lower_Fx / A, A the box's area (not reduced by the displacement, as a laboratory reports it)
//   blocks           the record is cut into kShearBlocks equal parts of displacement; a block is the mean of its rows
//   peak             the greatest block mean; u: standard deviation of a block mean in the steady part
//   steady part      steady_part.h on the block means (marginal standard error rule, at most the first half left out),
//                    with its test for a trend; a record that fails it is marked, since a small box need not become
//                    steady
//   steady           mean over that part, with the uncertainty of an autocorrelated mean (mean_uncertainty.h)
//   friction         tau_steady over the nominal normal stress (the plate's weight over A), and over the normal stress
//                    measured on the shear plane in the same part, which holds what the walls carry
//   plate force      fluctuation: standard deviation over mean of the rows of the steady part; departure: the greatest
//                    difference of a row, and of a block mean, from the weight, over the weight, in the whole record
//   inertial number  I = gamma' d sqrt(rho/sigma) with gamma' = V / (kShearBand d): the shear band is taken as
//                    kShearBand diameters thick, so I = V/kShearBand sqrt(rho/sigma). Quasi-static: I < 0.001 (GDR
//                    MiDi)
//
// u is the uncertainty within one run; seeds differ by more. Sources: GDR MiDi 2004, Eur. Phys. J. E 14:341 (inertial
// number and its quasi-static range).
// Errors: BadInput for a record with fewer rows than blocks.
#pragma once

#include <string>
#include <vector>

#include "core/mean_uncertainty.h"
#include "rigs/shearbox/shear_record.h"

namespace vielto {

constexpr int kShearBlocks = 40;
constexpr double kShearBand = 10;             // diameters
constexpr double kQuasiStatic = 1e-3;         // inertial number
constexpr double kMostForceImbalance = 0.02;  // of the shear force

struct ShearResult {
  ShearRecordHeader header;
  std::vector<double> displacement, shear_stress, plate_force;  // block means: m, Pa, N
  double peak = 0, peak_u = 0, peak_displacement = 0;           // Pa, m
  MeanUncertainty steady;                                       // Pa
  double steady_from = 0;                                       // m
  bool is_steady = false;
  double drift = 0;  // of the shear stress in the steady part, part of the mean per mm
  double friction = 0, friction_u = 0, plane_friction = 0, plane_stress = 0;  // 1, 1, 1, Pa
  double plate_mean = 0, plate_fluctuation = 0, plate_fluctuation_u = 0;      // N, 1, 1
  double plate_departure_row = 0, plate_departure_block = 0;                  // 1
  double dilation_end = 0, dilation_most = 0;                                 // m
  double porosity_start = 0, porosity_end = 0;
  double inertial_number = 0;
  double overlap_mean = 0, overlap_max = 0, lost_grains = 0, force_imbalance = 0;
  std::vector<std::string> warnings;
};

ShearResult shear_result(const ShearRecord& record);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// A silo with a flat bottom that empties through a round orifice: the rate at which it does, and the drained angle of
// what stays.
//
// Record: silo.csv, schema 1: lines `# key=value`, then the grains that stay (grain.h); z counts from the bottom, the
// orifice's axis is x = y = 0. Beside it flow.csv: time_s,mass_kg, the mass above the orifice since it was opened.
//
// Rate: while the mass that has left grows from kFlowFrom to kFlowTo of all that leaves, the head does not matter; mean
// of the rows' rates, with the uncertainty that their autocorrelation leaves (mean_uncertainty.h). Compared with
// Beverloo, Leniger and van de Velde 1961, Chem. Eng. Sci. 15:260:
//   W = C rho_b sqrt(g) (D - k d)^(5/2)    C 0.58, k 1.4; others find C 0.55 to 0.65 and k 1.2 to 1.6 for spheres
//   rho_b  bulk density, kg/m3   D, d  diameter of orifice and grain, m   g  gravity, m/s2   W  mass flow, kg/s
// Drained angle: slope of the crater's surface between orifice and wall, a diameter off both, as a line through the
// surface of each of kSiloStrips azimuths (round_surface.h), whose scatter gives u. Grains of the last diameter before
// the wall do not count: they stand on each other along it as a ring, which holds itself up.
//
// Errors: BadInput as record_file.h, for a silo that did not run (it arches), too few rows, too few grains that stay.
#pragma once

#include <string>
#include <vector>

#include "core/mean_uncertainty.h"
#include "rigs/round_surface.h"
#include "rigs/run_result.h"

namespace vielto {

constexpr double kFlowFrom = 0.1, kFlowTo = 0.5;
constexpr int kLeastFlowRows = 8;
constexpr int kSiloStrips = 12;
constexpr int kLeastCraterCells = 3;
constexpr double kLeastCraterHeight =
    3;                               // grain diameters: grains of a lower crater rest on the bottom, not on each other
constexpr double kLeastOrifice = 5;  // grain diameters: narrower ones arch

struct SiloHeader : RunHeader {
  double silo_diameter = 0, orifice_diameter = 0;  // m
  double bulk_density = 0;                         // kg/m3, before the outflow
  double mass_filled = 0;                          // kg
  double gravity = 0;                              // m/s2
};

struct SiloFlow {
  std::vector<double> time, mass;  // s, kg
};

struct SiloDischarge {
  SiloHeader header;
  SiloFlow flow;
  std::size_t grains = 0;             // that stay
  MeanUncertainty rate;               // kg/s
  double rate_from = 0, rate_to = 0;  // s, the part that is averaged
  double drift = 0;                   // rate of its second half over that of its first, less 1
  double beverloo = 0;                // kg/s
  AzimuthMean angle;                  // deg
  std::vector<SurfacePoint> profile;  // mean over the strips
  std::vector<std::string> warnings;
};

// kg/s; 0 where D <= k d.
double beverloo_rate(double bulk_density, double gravity, double orifice, double grain, double c = 0.58,
                     double k = 1.4);

SiloDischarge read_silo_discharge(const std::string& path);

}  // namespace vielto

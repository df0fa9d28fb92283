// SPDX-License-Identifier: GPL-2.0-or-later
// The torque of the whole shaft over the phase of a turn, from a periodic slice of k of its N paddles.
// With the slice's paddle j at angle a(j) and the torque c(j, phi) on it when the shaft has turned by phi, one paddle
// feels
//   t(theta) = mean_j c(j, theta - a(j))        at its own angle theta = phi + a(j),
// and the whole shaft, whose paddles stand at 0, step, 2 step, ...
//   T(phi) = sum_{i<N} t(phi + i step) + (N/k) (stems + shaft of the slice)(phi).
// For the whole drum, and for a machine, T is the recorded rotor torque. Curves hold kPhases means; between them,
// linear in the angle.
//
// Ripple: standard deviation over mean of the turn-averaged T within a turn. Its standard uncertainty is the
// jackknife's, one turn left out at a time (Efron and Tibshirani 1993, chapter 11). The noise that few turns leave in T
// adds to it: without, it would be sqrt(ripple^2 - ripple_noise^2).
//
// Shares of a paddle's torque by its place (paddle_sectors.h): of t(theta), with the same jackknife.
#pragma once

#include <array>
#include <vector>

#include "core/paddle_sectors.h"
#include "rigs/torque_record.h"

namespace vielto {

struct ShaftCurves {
  std::vector<double> paddle;  // t(theta), N m; empty for the whole drum
  // Of the whole drum against phi, N m.
  std::vector<std::vector<double>> part;  // in the order of the record's parts
  std::vector<double> rotor;
  std::vector<double> rotor_u;      // standard uncertainty, from the spread between turns
  double ripple = 0, ripple_u = 0;  // 1
  std::array<double, kPaddleShares.size()> shares{},
      shares_u{};           // in the order of kPaddleShares, 1; none without a slice
  double ripple_noise = 0;  // root mean square of rotor_u over the mean of the rotor, 1
};

// Over `count` >= 2 turns of the record from its value `first` on, in turn-blocks where it has some.
ShaftCurves shaft_curves(const TorqueRecord& record, int first, int count);

// curve(theta + angle) for all theta; angle in rad.
std::vector<double> turned(const std::vector<double>& curve, double angle);

// Mean at each phase over `count` turns from value `first` on, which may lie inside a turn.
std::vector<double> phase_mean(const std::vector<double>& signal, int first, int count);

}  // namespace vielto

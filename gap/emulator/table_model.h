// SPDX-License-Identifier: GPL-2.0-or-later
// Everything the one likelihood needs for the n rows of a table, in the rows' own units: what the baseline, the
// calibrated family and every effect say there, and what is uncertain about each. Made by the emulator.
//
//   y = f + b + r(s) + errors,   covariance of y at strengths s:
//   C(s) = noise + seed + emulator + family + discrepancy + reference + sum_e [emulator_e(s) + eta_e^2 R_e(s) G R_e(s)]
// f baseline, b the family's mean less f, r the effects' responses, R = diag(r), G the shape correlation: an effect's
// response may be off by eta of itself, half of that variance common to an observable, half of each condition's own.
// Two effects have one term more, r the product of their responses over the scale and eta that of their shape errors
// times `interaction`: together they may do more or less than each by itself.
//
// A known effect is no rival but part of the baseline (an end wall the machine has): f + r(s) takes the place of f, all
// that is relative to f is scaled with it, its emulator's error joins that of the baseline, and what it and a rival do
// together is uncertain as for any two effects. No shape error of its own: a baseline simulated with it has none
// either. Library runs of the effect hold the seeds' scatter of the plain baseline too, so that the sum counts that
// twice, a little too much.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "gap/library/effect.h"

namespace vielto::gap {

struct EffectResponse {
  std::string name, unit;
  EffectKind kind = EffectKind::dem;
  double low = 0, high = 0;  // prior range
  double shape_error = 0;
  Eigen::VectorXd strengths;                // k, ascending, 0 among them, closer together near 0
  Eigen::MatrixXd mean;                     // n x k
  std::vector<Eigen::MatrixXd> covariance;  // k of n x n, of the emulator

  // At any strength in the range, linear between the strengths above.
  Eigen::VectorXd response(double strength) const;
  Eigen::MatrixXd emulator(double strength) const;
};

// A gap that nobody named: covariance of its size and correlation. Weight among the shapes it may have.
struct UnknownShape {
  double weight = 1;
  Eigen::MatrixXd correlation;
  Eigen::VectorXd size;
  bool kin = false;  // of the measurement chain, a kind of which the library has members (unknown_gap.h)

  Eigen::MatrixXd covariance(double amplitude = 1) const;
};

// The likelihood is of logarithms where effects multiply (in_logarithms): what is uncertain about a simulation is a
// factor, and a gap by a third below is as large as one by a half above.
struct TableModel {
  std::string source;  // the table's path, for messages
  std::vector<Observation> rows;
  Eigen::VectorXd observed, baseline, family_shift;
  Eigen::VectorXd relative;     // 1 where effects multiply, 0 where they add up
  Eigen::VectorXd scale;        // what a relative gap is relative to: the baseline, or the observable's usual size
  Eigen::VectorXd logarithmic;  // 1 where the row is in logarithms
  Eigen::MatrixXd noise, seed, emulator, family, discrepancy;
  Eigen::MatrixXd reference;       // what a reference state leaves open (reference.h); 0 without one
  Eigen::MatrixXd family_members;  // n x m: each member less f; m = 0 without a family
  Eigen::VectorXd family_weights;
  Eigen::MatrixXd family_parameters;  // m x p
  Eigen::MatrixXd shape_correlation;
  double interaction = 0;        // of two effects: interaction eta_a eta_b r_a r_b/scale, a standard deviation
  Eigen::VectorXd known_change;  // root of the sum of (eta r / scale)^2 over the known effects; empty: there is none
  std::vector<UnknownShape> unknown;
  std::vector<EffectResponse> effects;
  std::vector<std::string> notes;    // what a reader must know
  std::vector<std::string> outside;  // rows outside the library's conditions, where that is allowed
  std::vector<std::string> silent;   // conditions of rows that no run of the library states

  Eigen::Index size() const { return observed.size(); }
  // C(0): all that is uncertain without an effect.
  Eigen::MatrixXd null_covariance() const { return noise + seed + emulator + family + discrepancy + reference; }
  Eigen::VectorXd gap() const { return observed - baseline - family_shift; }
  const EffectResponse* effect(const std::string& name) const;
  // x over the scale; 0 where an observable has no size of its own (the zero of an idle run), so that effects add up
  // there.
  Eigen::VectorXd over_scale(const Eigen::VectorXd& x) const;
  // The same with logarithms in the rows that are relative, covariances to first order: of what is simulated over f, of
  // u over the measured value. Errors that rows share tie measured values to each other, and over f the tie would be
  // broken. Values::measured: rows with a value above 0 only; placeholders: no value counts yet, all is over f.
  enum class Values { measured, placeholders };
  TableModel in_logarithms(Values values) const;
  // Only the rows with `keep`.
  TableModel part(const std::vector<Eigen::Index>& keep) const;
  // Covariance that an effect at this strength brings: its emulator's and shape error, what it does with known effects.
  Eigen::MatrixXd uncertain(const EffectResponse& effect, double strength) const;
  // With an effect as part of the baseline; the effect must be among `effects`.
  TableModel with_known(const std::string& name, double strength) const;
  // Effects not in `names` only.
  TableModel without(const std::vector<std::string>& names) const;
};

// What null_covariance() is the sum of, by the names a reader is told.
struct UncertaintySource {
  const char* name;
  Eigen::MatrixXd TableModel::*part;
};
constexpr std::array<UncertaintySource, 6> kUncertaintySources = {{{"measurement", &TableModel::noise},
                                                                   {"seeds", &TableModel::seed},
                                                                   {"emulator", &TableModel::emulator},
                                                                   {"calibration", &TableModel::family},
                                                                   {"contact law", &TableModel::discrepancy},
                                                                   {"reference", &TableModel::reference}}};

}  // namespace vielto::gap

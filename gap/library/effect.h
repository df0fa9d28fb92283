// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: an effect, a named mechanism the baseline leaves out, as the data file libraries/effects/NAME.toml states
// it.
//
// One strength s with a unit and a prior range (uniform); s = 0 is the baseline. What it acts on (`apply`):
//   apply.var        a `-var` of the rigs' input scripts, from its baseline value b in the parameter files:
//                      value   factor s            offset  b + factor s         scale  b (1 + factor s)
//                      power10 b 10^(factor s)     divide  b / (1 + factor s)   (with whole = true, rounded)
//                      word    a word              switch  a word, the whole change; s is the share of it
//   apply.transform  the measurement chain, on an observable y at condition c (speed or fill ...), with
//                    g = factor s h(c) sum_t coefficient_t prod_k (c_k/reference_k)^power_of_tk:
//                      scale  y (1 + g)    add  y + g    exponential  y exp(g)    shift  y at c (1 + factor s)
//                      efficiency  y / (1 - g): what a drive takes in that loses the share g of it
//                    One term is written power_of = {...}; several are terms = [{coefficient, power_of}, ...]. Among
//                    the c_k may be `value`, y itself: a motor's copper loss goes with the torque squared,
//                    power_of = {value = 1, speed = -2} on a power. h is 1, or between the points of
//                      curve = {condition, at, value}        value, straight lines
//                      efficiency = {condition, at, value}   1 - value, the loss of a drive of this efficiency
//                    and a condition outside its points is refused.
// At s = 0 no `-var` is written and no transform acts: the baseline bit for bit.
//
// Errors: BadInput with file, line and key.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "gap/library/settings.h"

namespace vielto::gap {

enum class VarRule { value, offset, scale, power10, divide, word, switched };

struct VarChange {
  std::vector<std::string> rigs;
  std::string name;
  VarRule rule = VarRule::value;
  double factor = 0;
  bool whole = false;
  std::string word;

  // Without `rigs` on every one. Also on a rig whose effects_of (cases/rigs.toml) is one of them.
  bool acts_on(const std::string& rig) const;
  // The text after `-var name`, for the baseline value `base` (not used by value, word, switch).
  std::string text(double base, double strength) const;
  bool needs_base() const;
};

enum class Operation { scale, add, exponential, shift, efficiency };

struct Term {
  double coefficient = 1;
  std::map<std::string, double> power_of;
};

// Straight lines between points, over a condition; empty: 1 everywhere.
struct Curve {
  std::string condition;
  std::vector<double> at, value;
};

// What an instrument reads for y, and by how much the reading moves with y.
struct Reading {
  double value = 0, slope = 1;
};

struct Transform {
  std::string apparatus, observable;  // observable "*": all of the apparatus
  Operation operation = Operation::scale;
  double factor = 0;
  std::string condition;  // of shift
  std::vector<Term> terms{Term{}};
  std::map<std::string, double> reference;
  Curve curve;

  // Also on a rig that takes the effects of `apparatus` (cases/rigs.toml, effects_of).
  bool acts_on(const std::string& on_apparatus, const std::string& on_observable) const;
  // Of y at the conditions of `row`; not for shift. Errors: BadInput if the row lacks a condition that is asked for or
  // lies outside the curve, or if nothing would be left of y (efficiency).
  Reading reading(const Observation& row, double y, double strength) const;
};

// What it is of: the simulated physics, the machine's geometry, what an instrument reads, the model itself.
enum class EffectKind { dem, geometry, measurement, numerical };

struct Effect {
  std::string path, name, unit, source;
  EffectKind kind = EffectKind::dem;
  double prior_low = 0, prior_high = 0;
  double shape_error = 0;
  std::vector<VarChange> vars;
  std::vector<Transform> transforms;

  bool acts_on_rig(const std::string& rig) const;
  // What it changes in a rig, one line without commas: runs made when it changed something else are of another effect.
  std::string changes(const std::string& rig) const;
  const Transform* transform_of(const std::string& apparatus, const std::string& observable) const;
};

Effect read_effect(const std::string& path, const Settings& settings);

// Every *.toml of a folder, sorted by name. Errors: BadInput also if there is none.
std::vector<Effect> read_effects(const std::string& folder, const Settings& settings);

}  // namespace vielto::gap

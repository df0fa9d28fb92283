// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the scatter of measured values from repeats of the measurement. Tests of one condition that were made more
// than once become one row, their mean (of logarithms, for values above 0); how they differ says how far a run
// scatters.
//
// Equation: over all groups g of k_g repeats of an observable, s^2 = sum (y - mean_g)^2 / v with v = sum (k_g - 1)
// degrees of freedom, in logarithms for values above 0. Of it the stated noise U explains w^2 = sum_g (tr U_g - 1' U_g
// 1 / k_g) / v, errors that repeats share not at all. The variance of a run is S = t^2/z^2 s^2 - w^2, where t and z are
// the 99.5 % quantiles of Student's t with v + 3 degrees of freedom and of the normal distribution: few repeats may
// have scattered little by chance. Runs have heavy tails, single hard nips, which few repeats need not show at all: S
// is at least 3/(3 + v) (3 s_0)^2, s_0 the scatter of the library's seeds. Runs of another law and grain scattered by
// 0.9 to 5 times as much, 3 in the root of the mean square; that counts as three degrees of freedom. Where it stands
// for S, it is told with what it costs.
#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/reduced_table.h"
#include "gap/emulator/table_model.h"

namespace vielto::gap {

// Rows of equal role, conditions, wall and material as one; `count` of each.
struct Averaged {
  ReducedTable table;
  std::vector<int> count;
};
Averaged averaged(const ReducedTable& table);

struct Repeats {
  double squares = 0, stated = 0;  // sums, of values' logarithms where they are above 0
  int degrees_of_freedom = 0;
};
using RepeatsOfObservable = std::map<std::pair<std::string, std::string>, Repeats>;  // apparatus, observable

void add_repeats(const ReducedTable& table, RepeatsOfObservable& repeats);

struct Scatter {
  std::string apparatus, observable;
  double sd = 0, library = 0;  // of one run, relative where effects multiply
  int degrees_of_freedom = 0;
  bool assumed = false;
};

// Puts S/count in place of the seeds' scatter of each row (bench rows have none). What was taken, by observable.
std::vector<Scatter> set_scatter(TableModel& model, const std::vector<int>& count, const RepeatsOfObservable& repeats);

// Without a reference calibration and law hide some of it, so that the library's scatter stands unless repeats show
// more (rows are single runs). What was raised.
std::vector<Scatter> raise_scatter(TableModel& model, const RepeatsOfObservable& repeats);

std::string text_of(const Scatter& scatter);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// When the steady mean of a signal that repeats with the turn is known well enough to end the run.
//
// Looked at after each whole turn; of a machine that looks the same after a part of a turn, after each part, which then
// is the turn of all that follows. The mean is known when it is steady in the last two looks and precise in those of
// the last quarter of the turns (two at least).
//   steady    the turns kept show no start-up and no trend (steady_part.h), and the straight line through their means
//             moves by at most target |mean| from their middle to their end, so that a trend too small to show cannot
//             carry the mean away
//   precise   u_90 <= target |mean|, where u is the standard uncertainty (k = 1) of their mean and u_90 its upper 90 %
//             limit, u_90 = u sqrt(dof / chi^2(0.1, dof)), chi^2(p, n) = n (1 - 2/(9n) + z(p) sqrt(2/(9n)))^3; and
//             there are kLeastEffective effective samples, below which an uncertainty is a guess (mean_uncertainty.h)
// A rule that looks again and again ends sooner when u happens to come out small, and with bursts their mean with it;
// the upper limit and the repeated looks keep that in bounds. Measured on synthetic records that needed 4 to 60 turns,
// at a target of 0.02 (tests/core/stopping_rule_test.cpp):
//   noise, white or correlated over up to a turn   root mean square error 0.6 to 0.85 targets; mean +- t(0.975, dof) u
//                                                  holds the true mean in 88 to 94 % of the records
//   the same after a start-up of 30 %              0.8 targets, 87 %
//   stick-slip bursts                              1.3 targets, 79 %: rare long ramps that have not come yet
//   a drift of one target a turn, no mean at all   ended within 40 turns in at most 9 % of the records
//
// Sources: Chow and Robbins 1965, Ann. Math. Statist. 36:457 (sequential intervals of fixed width); Wilson and Hilferty
// 1931, Proc. Natl. Acad. Sci. 17:684 (chi^2).
#pragma once

#include <vector>

#include "core/mean_uncertainty.h"
#include "core/steady_part.h"

namespace vielto {

constexpr double kLeastEffective = 30;
constexpr int kShareOfLooks = 4;  // a quarter of the turns

struct Look {
  SteadyPart part;
  MeanUncertainty mean;  // of the turns kept; zeros while there are too few
  double relative = 0;   // u_90 / |mean|
  bool steady = false, precise = false;
  double turns_needed = 0;  // in all, if u goes on as 1/sqrt(turns kept); 0 while it cannot be told
};

// `signal` holds whole turns of `period` values. Errors: as find_steady_part.
Look look(const std::vector<double>& signal, int period, double target, int least = kLeastAveragedTurns);

class StoppingRule {
 public:
  // target > 0: relative standard uncertainty; of `least` >= 3 turns.
  StoppingRule(int period, double target, int least = kLeastAveragedTurns)
      : period_(period), target_(target), least_(least) {}

  void add(double value);  // the next of the signal
  bool known() const { return known_; }
  int turns() const { return static_cast<int>(signal_.size()) / period_; }  // whole ones
  double target() const { return target_; }
  const Look& last() const { return last_; }  // after the last whole turn

 private:
  int period_;
  double target_;
  int least_;
  std::vector<double> signal_;
  Look last_;
  int steady_ = 0, precise_ = 0;  // looks in a row
  bool known_ = false;
};

}  // namespace vielto

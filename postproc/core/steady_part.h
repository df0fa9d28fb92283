// SPDX-License-Identifier: GPL-2.0-or-later
// The steady part of a signal: which whole turns may be averaged.
//
// 1. Marginal standard error rule on the turn means Y(1) ... Y(n): leave out the first d turns, where d minimises
//      MSER(d) = sum_{i>d} (Y(i) - mean_d)^2 / (n - d)^2,   0 <= d <= min(n/2, n - minimum).
//    It trades the bias of the start against the spread of a shorter mean. Nothing is ever left out at the end or
//    inside.
// 2. Two tests at the level of 5 % each, with the spread of a turn mean taken from the autocorrelation of what is kept,
//    phase means and trend taken out (mean_uncertainty.h), Student's t:
//      - limit:  if d is at its upper limit, the last turn left out must not differ from the mean of those kept
//                (otherwise the start may well reach into what is kept);
//      - trend:  the slope of the kept turn means must not differ from 0.
// A record that fails a test is not steady; it has to be run longer. Steady AR(1) noise fails in at most 6 % of records
// (tests/core/steady_part_test.cpp: measured for 5 to 20 turns, correlated over up to a turn; also the detection
// rates). Limit: a start-up that lasts as long as the record itself, seen over a handful of turns, can pass for a
// steady signal.
//
// Sources: White 1997, Simulation 69:323; White, Cobb and Spratt 2000, Proc. Winter Simul. Conf., p. 755 (d <= n/2).
#pragma once

#include <vector>

namespace vielto {

enum class Steadiness { steady, too_few_turns, start_up_reaches_limit, trend };

struct SteadyPart {
  Steadiness verdict = Steadiness::too_few_turns;
  int first = 0;       // turns left out at the start
  int count = 0;       // turns kept
  double slope = 0;    // of the kept turn means, per turn, unit of the signal
  double slope_p = 1;  // probability of such a slope in a steady signal
};

constexpr int kPhases = 72;  // of 5 degrees: a torque over the turn is kept as means over these
constexpr double kSteadyTestLevel = 0.05;
constexpr int kLeastAveragedTurns = 3;
constexpr int kLeastPartTurns = 2;  // where a part of a turn is what repeats, and is the turn of this file

// d that minimises MSER(d), 0 <= d <= most.
int mser_truncation(const std::vector<double>& turn_means, int most);

// `signal` holds whole turns of `period` values; `minimum` turns, at least 3, must be left.
// Errors: std::invalid_argument if the signal does not hold whole turns or `minimum` is below 3.
SteadyPart find_steady_part(const std::vector<double>& signal, int period, int minimum = kLeastAveragedTurns);

// Means over whole turns.
std::vector<double> turn_means(const std::vector<double>& signal, int period);

}  // namespace vielto

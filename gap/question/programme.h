// SPDX-License-Identifier: GPL-2.0-or-later
/* Purpose: before any data, which candidate tests to make, best first for an hour of work.

   Measure: what a set of tests tells apart, counted over effects a: a from nothing (its greatest distance over 4), and
   a from each other effect b (its greatest distance from every strength of b over 3), see isolability.h; n^2 for n
   effects. The programme grows by the candidate that adds most of these an hour, all that was chosen before it being
   made, until none adds anything. */
#pragma once

#include <string>
#include <vector>

#include "gap/question/question.h"
#include "gap/verdict/isolability.h"

namespace vielto::gap {

struct ProgrammeStep {
  std::string test, how;                // of the first step: the table's own tests, which cost no more
  double hours = 0, all_hours = 0;      // of this test; of all so far
  int told = 0, possible = 0;           // by all tests so far
  std::vector<std::string> detectable;  // effects that are so from this test on
};

// What is told apart of the effects that `all` names; an effect that `tests` cannot simulate is told from none.
int told_apart(const Isolability& tests, const std::vector<std::string>& all);

// Candidates that the library does not reach, and those that add nothing, are told in `notes`.
std::vector<ProgrammeStep> programme(const Question& question, const std::string& candidates,
                                     std::vector<std::string>& notes);

// order,test,hours,all_hours,told,possible,detectable,how
std::string programme_csv(const std::vector<ProgrammeStep>& steps);

}  // namespace vielto::gap

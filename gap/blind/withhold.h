// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: withheld cases. Observation tables with a known effect, made from something the diagnoser does not hold:
// response libraries of other contact laws (one a base truth), with their own seeds. The truth files are sealed;
// `vielto` neither links nor reads any of this.
//
// A case: noise-free values of the truth (its baseline, and its effect at a strength) on the rows of a table of tests,
// plus one draw of its seed noise and of the rows' errors (u); those of powers from a transmitter's record in time
// ([power_signal] in the plan, power_signal.h). u stands in the table of tests, fixed before
// any case. FOLDER/cases/N/observations.csv and case.json ({"without": [...]}) are for the diagnoser;
// FOLDER/truth/N.json and FOLDER/seals.sha256 for the score; FOLDER/unreachable.csv lists strengths beyond the
// reachable part of the prior. The true strength is the library's strength closest to the noise-free truth, in units of
// u over the fit rows.
//
// With a reference (draw_reference: the base truth as it was measured before it changed) cases are of the change: rows
// that repeat a test are drawn as runs of their own, groups are those sealed for the pair, the true strength is the one
// whose relative change is closest, and check gaps are those of the simulation as the reference corrects it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gap/question/inputs.h"

namespace vielto::gap {

struct WithholdRequest {
  InputFiles library;               // the diagnoser's
  std::vector<std::string> truths;  // response libraries of other laws
  std::string truth_effects;        // effects of the truths; without it the diagnoser's
  std::string tests, plan, isolability, out;
  std::string reference;  // observation table of the base truth's reference state; empty: none
  std::vector<std::string> ignored;
  std::uint64_t seed = 1;
};

struct WithholdResult {
  int cases = 0, unreachable = 0;
};

// Errors: BadInput; refuses a folder that is there already.
WithholdResult withhold(const WithholdRequest& request);

// One draw of the (only) base truth without an effect on the rows of `tests`, written to `out`. Errors: BadInput;
// refuses a file that is there already.
void draw_reference(const WithholdRequest& request);

}  // namespace vielto::gap

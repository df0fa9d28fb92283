// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the test that would separate effects that the data leave open best, per hour of work.
//
// Candidate tests stand in a data file (libraries/next_tests.toml): rows they would add, their u, hours of work. For
// two effects a, b at their most probable strengths given the data, D the difference of what they predict for present
// and added rows together and C its covariance (both models' mean, strengths' uncertainty to first order included): the
// expected separation is sqrt(D' C^-1 D). Its gain over the present rows alone, weighed over the pairs by the product
// of their probabilities, is divided by the hours.
//
// For a gap that nothing in the library explains there are no two effects to separate. What a test can do then is to
// narrow what the simulation leaves open (calibration, law), so that the gap stands out, or to show it again: with g
// the gap of the present rows, Z the covariance of an unknown gap (its shapes' mean; nothing across apparatuses) and G
// = [g, Z_cf (C_ff + Z_ff)^-1 g] the gap to be expected, from sqrt(g' C_ff^-1 g) to sqrt(G' C^-1 G).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/reduced_table.h"
#include "gap/verdict/evidence.h"

namespace vielto::gap {

struct CandidateTest {
  std::string name, apparatus, how;
  double hours = 0;
  std::vector<Observation> rows;  // value: not known; u in the observable's unit, or relative
  std::vector<bool> relative_u;
};

struct NextTest {
  std::string name, apparatus, how, separates;  // "a from b"
  double hours = 0, separation_now = 0, separation = 0, gain_per_hour = 0;
};

std::vector<CandidateTest> read_candidate_tests(const std::string& path);

// "reference" or "repeat" of the file: the table's own tests once more, in the reference state or as they are.
struct StateTest {
  std::string name, how;
  double hours_each = 0;  // a test
};
std::optional<StateTest> read_state_test(const std::string& path, const std::string& name);

// The candidates' rows as one table (for the emulator): values and u are set from the baseline by the caller.
ReducedTable candidate_table(const std::string& path, const CandidateTest& test, const std::string& wall,
                             const std::string& material);

// `joint`: the fit rows followed by the candidate's rows.
NextTest judge_candidate(const TableModel& joint, Eigen::Index present, const CandidateTest& test,
                         const std::vector<const ModelEvidence*>& open);

// The same for an unknown gap: how far the gap stands from none, now and with the test.
NextTest judge_for_unknown(const TableModel& joint, Eigen::Index present, const CandidateTest& test);

// The same rows under another model (`then`: with a reference state). Effects that `then` lacks change nothing there.
NextTest judge_state(const TableModel& now, const TableModel& then, const CandidateTest& test,
                     const std::vector<const ModelEvidence*>& open, bool unknown);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/next_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/bad_input.h"

namespace vielto::gap {
namespace {

using Eigen::Index;

using Open = std::vector<const ModelEvidence*>;

Open open_models(const Diagnosis& diagnosis) {
  Open open;
  for (const ModelEvidence& m : diagnosis.models) {
    if (m.effects.empty() || open.size() == 4) continue;
    if (diagnosis.verdict == Verdict::ambiguous &&
        (m.effects.size() != 1 ||
         std::find(diagnosis.group.begin(), diagnosis.group.end(), m.effects[0]) == diagnosis.group.end()))
      continue;
    open.push_back(&m);
  }
  return open;
}

bool knows_all(const TableModel& model, const Open& open) {
  return std::all_of(open.begin(), open.end(), [&](const ModelEvidence* m) {
    return std::all_of(m->effects.begin(), m->effects.end(), [&](const std::string& e) { return model.effect(e); });
  });
}

CandidateTest own_tests(const StateTest& state, const Question& question) {
  std::set<std::string> tests;
  for (const Observation& row : question.fit.rows) tests.insert(row.test);
  CandidateTest test;
  test.name = state.name;
  test.apparatus = question.fit.rows.front().apparatus;
  test.how = state.how;
  test.hours = state.hours_each * static_cast<double>(tests.size());
  return test;
}

// The question's own tests: against a reference, or once more.
void add_state_tests(const Question& question, const Open& open, bool unknown, const std::string& candidates,
                     std::vector<NextTest>& tests) {
  if (const auto state = read_state_test(candidates, "reference"); state && !question.reference) {
    const TableModel now = question.fit.in_logarithms(TableModel::Values::measured);
    tests.push_back(judge_state(now, question.with_such_a_reference().in_logarithms(TableModel::Values::placeholders),
                                own_tests(*state, question), open, unknown));
  }
  if (const auto state = read_state_test(candidates, "repeat")) {
    const TableModel joint = question.extended(question.fit_table());
    const auto present = static_cast<Index>(question.fit.rows.size());
    const CandidateTest test = own_tests(*state, question);
    tests.push_back(unknown
                        ? judge_for_unknown(joint.in_logarithms(TableModel::Values::measured), present, test)
                        : judge_candidate(joint.in_logarithms(TableModel::Values::placeholders), present, test, open));
  }
}

}  // namespace

ReducedTable added_rows(const Question& question, const CandidateTest& test, const std::string& candidates) {
  const Observation& like = question.fit.rows.front();
  ReducedTable added = candidate_table(candidates, test, like.wall, like.material);
  const TableModel alone = question.inputs.emulator.model(added, question.options.emulator, question.inputs.settings);
  for (std::size_t i = 0; i < test.rows.size(); ++i) {
    const Index k = static_cast<Index>(i);
    added.rows[i].value = alone.baseline[k];
    if (test.relative_u[i]) added.rows[i].u *= std::fabs(alone.baseline[k]);
    added.covariance.coeffRef(k, k) = added.rows[i].u * added.rows[i].u;
  }
  return added;
}

std::vector<NextTest> next_tests(const Question& question, const Diagnosis& diagnosis, const std::string& candidates,
                                 std::vector<std::string>& notes) {
  const Open open = open_models(diagnosis);
  const bool unknown = diagnosis.verdict == Verdict::unknown;
  std::vector<NextTest> tests;
  if (open.size() < 2 && !unknown) return tests;
  const auto present = static_cast<Index>(question.fit.rows.size());
  std::vector<std::string> left_out;
  std::string reason;
  for (const CandidateTest& test : read_candidate_tests(candidates)) {
    try {
      const TableModel joint = question.extended(added_rows(question, test, candidates));
      if (unknown)
        tests.push_back(judge_for_unknown(joint.in_logarithms(TableModel::Values::measured), present, test));
      else if (knows_all(joint, open))  // the added row may need runs that the library lacks
        tests.push_back(judge_candidate(joint.in_logarithms(TableModel::Values::placeholders), present, test, open));
      else
        notes.push_back(fmt::format("next test {}: the library lacks runs for it", test.name));
    } catch (const BadInput& error) {
      if (left_out.empty()) reason = error.what();
      left_out.push_back(test.name);
    }
  }
  add_state_tests(question, open, unknown, candidates, tests);
  if (!left_out.empty())
    notes.push_back(fmt::format("next tests left out: {}; the first because {}", fmt::join(left_out, ", "), reason));
  std::sort(tests.begin(), tests.end(),
            [](const NextTest& a, const NextTest& b) { return a.gain_per_hour > b.gain_per_hour; });
  return tests;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/programme.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/bad_input.h"
#include "gap/question/next_question.h"

namespace vielto::gap {
namespace {

std::set<std::string> detectable_of(const Isolability& i) {
  std::set<std::string> found;
  for (const std::string& e : i.effects)
    if (i.detectable(e, i.farthest(e))) found.insert(e);
  return found;
}

// A candidate and what it shows beside the tests that were chosen before.
struct Trial {
  CandidateTest test;
  ReducedTable rows;
  Isolability shown;
  int gain = 0;
};

Isolability with(const Question& question, const ReducedTable& added) {
  return isolability(question.extended(added).in_logarithms(TableModel::Values::placeholders),
                     question.inputs.settings);
}

ProgrammeStep step_of(const Trial& chosen, const ProgrammeStep& before, const std::set<std::string>& seen) {
  ProgrammeStep step;
  step.test = chosen.test.name;
  step.how = chosen.test.how;
  step.hours = chosen.test.hours;
  step.all_hours = before.all_hours + chosen.test.hours;
  step.told = before.told + chosen.gain;
  step.possible = before.possible;
  for (const std::string& e : detectable_of(chosen.shown))
    if (!seen.count(e)) step.detectable.push_back(e);
  return step;
}

std::vector<Trial> read_trials(const Question& question, const std::string& candidates,
                               std::vector<std::string>& notes) {
  std::vector<Trial> trials;
  std::vector<std::string> out_of_reach;
  std::string reason;
  for (const CandidateTest& test : read_candidate_tests(candidates)) {
    try {
      trials.push_back({test, added_rows(question, test, candidates), {}, 0});
    } catch (const BadInput& error) {
      if (out_of_reach.empty()) reason = error.what();
      out_of_reach.push_back(test.name);
    }
  }
  if (!out_of_reach.empty())
    notes.push_back(fmt::format("left out: {}; the first because {}", fmt::join(out_of_reach, ", "), reason));
  return trials;
}

}  // namespace

int told_apart(const Isolability& tests, const std::vector<std::string>& all) {
  int told = 0;
  for (std::size_t a = 0; a < tests.effects.size(); ++a) {
    const std::string& effect = tests.effects[a];
    if (std::find(all.begin(), all.end(), effect) == all.end()) continue;
    told += tests.detectable(effect, tests.farthest(effect));
    for (std::size_t b = 0; b < tests.effects.size(); ++b)
      told += b != a && std::find(all.begin(), all.end(), tests.effects[b]) != all.end() &&
              tests.separation(a, b) > tests.group_distance;
  }
  return told;
}

std::vector<ProgrammeStep> programme(const Question& question, const std::string& candidates,
                                     std::vector<std::string>& notes) {
  const Isolability own = isolability(question.before_data(), question.inputs.settings);
  const std::vector<std::string>& all = own.effects;
  std::vector<ProgrammeStep> steps(1);
  steps[0].test = "tests of the table";
  steps[0].told = told_apart(own, all);
  steps[0].possible = static_cast<int>(all.size() * all.size());
  std::set<std::string> seen = detectable_of(own);
  steps[0].detectable.assign(seen.begin(), seen.end());

  std::vector<Trial> left = read_trials(question, candidates, notes);
  std::optional<ReducedTable> chosen;
  while (!left.empty()) {
    for (Trial& trial : left) {
      trial.shown = with(question, chosen ? joined(*chosen, trial.rows) : trial.rows);
      trial.gain = told_apart(trial.shown, all) - steps.back().told;
    }
    const auto best = std::max_element(left.begin(), left.end(), [](const Trial& a, const Trial& b) {
      return a.gain / a.test.hours < b.gain / b.test.hours;
    });
    if (best->gain <= 0) break;
    steps.push_back(step_of(*best, steps.back(), seen));
    seen.insert(steps.back().detectable.begin(), steps.back().detectable.end());
    chosen = chosen ? joined(*chosen, best->rows) : best->rows;
    left.erase(best);
  }
  std::vector<std::string> rest;
  for (const Trial& trial : left) rest.push_back(trial.test.name);
  if (!rest.empty()) notes.push_back(fmt::format("add nothing more: {}", fmt::join(rest, ", ")));
  return steps;
}

std::string programme_csv(const std::vector<ProgrammeStep>& steps) {
  std::string text = "order,test,hours,all_hours,told,possible,detectable,how\n";
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const ProgrammeStep& s = steps[k];
    std::string how = s.how;
    std::replace(how.begin(), how.end(), ',', ';');
    text += fmt::format("{},{},{},{},{},{},{},{}\n", k, s.test, s.hours, s.all_hours, s.told, s.possible,
                        fmt::join(s.detectable, " "), how);
  }
  return text;
}

}  // namespace vielto::gap

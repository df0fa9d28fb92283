// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the proof. The check tests are simulated again with the effect at its estimated strength; beside it, on the
// same tests, the baseline, recalibration alone, and a placebo (the best effect from outside the group).
//
// A plan holds one `liggghts -in ... -var ...` for every check test, variant and seed (cases/rigs.toml says how a
// test becomes a run). Effects on the measurement chain need no run of their own: they transform what the recalibrated
// baseline shows; a shift of a condition is a run at the shifted condition. Runs that are complete (run.json there) are
// not made again; one that was made by another command or from other files is refused, complete or not. `effects` are
// simulated at their median strengths together with the parameters of the family that fit best with them. Check tests
// under equal conditions share their runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gap/answer/variant.h"
#include "gap/question/question.h"
#include "gap/verdict/diagnosis.h"

namespace vielto::gap {

struct PlannedRun {
  Variant variant = Variant::before;
  std::string apparatus;
  std::vector<std::string> tests;  // the check tests whose conditions it has
  int seed = 1;
  std::string folder;  // where it is started
  std::string run;     // run folder
  std::vector<std::string> command;
  std::vector<std::string> files;  // it is made from, besides
  std::vector<std::string> post;   // command after it; empty: none
  bool resumes = false;            // the rig takes up a run that was broken off; others begin anew
  double share = 1;                // of a switched effect: part of the way from the recalibrated run to this one
};

struct VariantSettings {
  Variant variant = Variant::before;
  std::vector<std::string> effects;
  std::vector<double> strengths;
  Eigen::VectorXd parameters;  // empty: the baseline's own
};

struct Plan {
  std::vector<VariantSettings> variants;
  std::vector<PlannedRun> runs;
  std::string placebo;
};

struct ConfirmationRequest {
  std::string root;                   // folder that holds cases/ and materials/
  std::string runs;                   // where the run folders go
  int seeds = 1;                      // of each run
  std::vector<std::string> settings;  // further NAME=VALUE, for all rigs that have such a -var
};

// Runs have the settings that the library's own runs of the rig have (plan.toml in the library's folder; `notes` says
// so if there is none), so that what is confirmed is the baseline that was diagnosed; the question's known effects are
// in every run. Errors: BadInput for a rig that there is not, a script that is not there, a setting that no rig has or
// whose value is no number where the rig states one, and a blank in the path of the runs, at which LIGGGHTS would split
// it.
Plan plan_confirmation(const ConfirmationRequest& request, const Question& question, const Diagnosis& diagnosis,
                       const Isolability& isolability, std::vector<std::string>& notes);

// A test's name as a file's: letters, digits, '.', '_' and '-' as they are, else '_' and a hash of the name.
std::string file_name_of(const std::string& test);

// A command line for a shell, every word quoted that needs it.
std::string command_line(const PlannedRun& run);
// The commands as an answer states them: folders as seen from the rig's, so that it speaks of no machine.
std::vector<std::string> stated_commands(const Plan& plan);
// As the first run states it; empty if it does not.
std::string liggghts_version(const Plan& plan);

// Errors: BadInput naming a run folder that is there and was made by another command or from other files.
void refuse_other_runs(const Plan& plan);

// Runs what is missing, `jobs` at a time. Waits for runs that another process has begun and that are still at work,
// takes up those that were broken off, from their newest restart or anew. Errors: std::runtime_error naming the command
// that failed; what has begun ends first.
void run_plan(const Plan& plan, int jobs);

// The measured shrink. With a reference state of the change: what the simulation shows is corrected by what it is off
// in the reference, as the question's model has it. Errors: BadInput naming a run whose observations are missing.
Shrink measured_shrink(const Plan& plan, const Question& question);

}  // namespace vielto::gap

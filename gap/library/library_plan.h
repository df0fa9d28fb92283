// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the plan of a response library (libraries/millet/plan.toml): which runs it needs, as a study for
// scripts/campaign, and the library made of those that are done.
//
//   seeds = 6                                  of the baseline under every condition
//   [family]                                   optional
//   file = "PATH"                              weight,PARAMETER...; the library's posterior
//   members = [9, 25]                          rows of it that are run, from 1
//   members_from = "PATH"                      optional, same columns: `members` are rows of this file. A new posterior
//                                              within their range then needs no new runs
//   [[rig]]
//   name = "mixer"                             of cases/rigs.toml
//   settings = {grainDiameter = "0.012"}       -var of all its runs
//   conditions = [{speed = 0.48, fill = 0.1}]  each with its baseline; seeds = 8 in one: its own number of seeds
//   members_at = [1]                           numbers of the conditions at which the members are run, one seed each
//   [[rig.effect]]                             may come several times for one effect
//   name = "cohesion"
//   strengths = [30000, 60000]
//   at = [1]
//   seeds = 1                                  optional
//   [[rig.design]]                             effects and calibrated parameters together
//   file = "together.csv"                      a row a run, a column each for effects (strength; 0 or empty: not there)
//                                              and for the family's parameters (all or none; empty: the baseline's own)
//   at = [1, 2]                                every row is run at each of these conditions, one seed
//   [[bench]]                                  what the cards say, not simulated
//   observable = "shaft_speed"
//   rows = [{speed = 0.48, value = 0.48}]      slopes = {PARAMETER = d value/d PARAMETER}: how it goes with calibrated
//   ones
//
// Errors: BadInput with file, line and key.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "gap/library/effect.h"
#include "gap/library/rig.h"

namespace vielto::gap {

struct LibraryRun {
  std::string name, rig;
  std::map<std::string, double> effects;  // name -> strength
  int seed = 0;
  std::map<std::string, double> parameters;     // of the family, all of them
  std::map<std::string, std::string> settings;  // -var, without seed and run
  std::map<std::string, std::string> changes;   // of each effect in the rig (Effect::changes)
};

struct LibraryPlan {
  std::vector<std::string> parameter_names;  // of the family; empty: none
  std::string posterior_file, family_file;   // what is integrated over; where the members that are run stand
  std::map<std::string, double> baseline;    // the family's parameters as the cards state them
  std::vector<LibraryRun> runs;
  std::vector<Observation> bench;  // of the baseline, and of each member for rows with slopes
  std::vector<std::map<std::string, double>> bench_parameters;
  std::vector<Rig> rigs;

  static LibraryPlan read(const std::string& path, const std::vector<Effect>& effects, const std::string& root);
};

// The study table: run,rig,seed and one column for each -var.
void write_study(const LibraryPlan& plan, const std::string& path);

struct Collected {
  int runs = 0;
  std::vector<std::string> missing;  // runs of the plan without a result
};

// Writes design.csv, observations.csv, sources.csv (sources.h), bench.csv, posterior.csv, inputs.csv and effects.csv to
// `folder` from the campaign's folder `results` (runs/NAME/run.json, post/NAME.csv). Errors: BadInput also for a run
// that was made from other files than those that are there now, or with other settings than the plan's.
Collected collect_library(const LibraryPlan& plan, const std::string& results, const std::string& folder);

}  // namespace vielto::gap

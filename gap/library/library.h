// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the response library, simulated observations over a design of tests, effects, strengths and seeds.
//
// A folder with these files (all but design.csv and the tables are optional):
//
// - design.csv: test,effect,strength,seed,run_hash,PARAMETER... One row a run; `test` is its name in the tables, one
//   for each run; `effect` none and strength 0: the baseline; several at once as cohesion+shape, 150+0.2; PARAMETER:
//   the calibrated parameters of the run, on top of which its effects act. The baseline's own are those of most of its
//   runs; baseline runs at other values show what recalibration can do.
// - together*.csv: designs of the plan (library_plan.h), not read here
// - other *.csv: observation tables, their rows under the tests of the design; u and role are not used
// - posterior.csv: weight,PARAMETER... The calibrated family
// - discrepancy.csv: what other contact laws do differently (discrepancy.h)
// - sources.csv: test,kind,source,torque_Nm (sources.h); paddle_share_* of runs whose tables do not state them
// - inputs.csv: file,sha256. What the runs were made from, and posterior.csv; paths from the folder: if one has
//   changed, the library is stale
// - effects.csv: effect,rig,changes. What the effects changed in each rig when their runs were made (Effect::changes);
// if one
//   changes something else now, the library is stale
//
// Errors: BadInput with file and line. At least 6 seeds of the baseline under every condition (but for `bench`, which
// is not simulated); no run twice (run_hash); strengths inside the effect's prior range; nothing stale.
#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "gap/library/effect.h"

namespace vielto::gap {

constexpr int kLeastSeeds = 6;

struct Run {
  std::string test, run_hash;
  std::map<std::string, double> effects;  // name -> strength
  int seed = 0;
  Eigen::VectorXd parameters;
  bool nominal = false;  // the baseline's own parameters
  int line = 0;

  bool baseline() const { return effects.empty() && nominal; }
  // Not one effect alone nor other parameters alone.
  bool varies_several() const { return effects.size() + !nominal > 1; }
};

struct LibraryValue {
  int run = 0;  // index
  Observation row;
};

struct Family {
  Eigen::VectorXd weights;     // m, sum 1
  Eigen::MatrixXd parameters;  // m x p
};

struct Library {
  std::string folder;
  std::vector<std::string> parameter_names;
  Eigen::VectorXd nominal;  // p, the baseline's own parameters
  std::vector<Run> runs;
  std::vector<LibraryValue> values;
  Family family;                   // 0 members: not given
  std::vector<std::string> files;  // everything read, for provenance
  std::vector<std::string> notes;  // what cannot be checked

  static Library read(const std::string& folder, const std::vector<Effect>& effects);
};

}  // namespace vielto::gap

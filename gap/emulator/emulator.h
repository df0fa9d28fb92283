// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: what the simulation would say under any conditions inside the library's range, for any strength of any
// effect, and how sure that is.
//
// Each observable of an apparatus is smoothed by itself (gaussian_process.h): the baseline's mean over its seeds, the
// response to each effect, the response to the calibrated parameters, and the logarithm of the seed variance. An
// observable whose every run is above 0 is smoothed in its logarithm, so that effects multiply; others as they are.
// Conditions are the numeric ones that vary in the library, as logarithms where all are above 0, in units of their
// range. Where an effect file has a transform for the observable, the transform is used instead of runs.
//
// A table row is matched by apparatus, observable, conditions, wall and material (those that library states), not by
// the name of its test. Errors: BadInput (file and line of the row) if the library lacks the observable, for another
// wall or material or a fixed condition that differs, or for conditions outside the range, unless told to extrapolate.
// A condition that no run of the library states cannot be compared: it is told, not refused.
#pragma once

#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/reduced_table.h"
#include "gap/emulator/discrepancy.h"
#include "gap/emulator/gaussian_process.h"
#include "gap/emulator/table_model.h"
#include "gap/library/condition.h"
#include "gap/library/effect.h"
#include "gap/library/library.h"

namespace vielto::gap {

struct EmulatorOptions {
  std::set<std::string> ignored;  // conditions that need not agree: moisture, wall, material ...
  bool extrapolate = false;       // outside the range: flagged instead of refused
  double runs_per_observation =
      1;  // the observed mean is one of so many independent runs; 0: u holds their scatter already
  bool use_discrepancy = true;
  bool candidates = true;               // false: only effects that are known count, as for a prediction
  std::map<std::string, double> known;  // effects that are part of the baseline, with their strengths (table_model.h)
};

class Emulator {
 public:
  Emulator(const Library& library, const std::vector<Effect>& effects, std::vector<DiscrepancyEntry> discrepancies);

  // All rows of the table. `settings`: shape and unknown of the likelihood.
  TableModel model(const ReducedTable& table, const EmulatorOptions& options, const Settings& settings) const;
  // The emulator a fresh campaign over the same design would have given: values redrawn with the seed noise.
  Emulator redrawn(std::mt19937_64& random) const;

  // What another law's runs differ by from the baseline, by observable: the material of a discrepancy.
  std::map<std::pair<std::string, std::string>, LawDifference> differences(const ReducedTable& law,
                                                                           const EmulatorOptions& options) const;
  const std::vector<std::string>& parameter_names() const { return parameter_names_; }
  const Eigen::VectorXd& nominal() const { return nominal_; }

 private:
  struct Smooth {
    GaussianProcess process;
    std::vector<Point> points;
    Eigen::MatrixXd noise;
  };
  struct Channel {
    std::string apparatus, observable;
    bool relative = false;
    double size = 0;  // root mean square of the baseline
    std::vector<NamedCondition> varying;
    std::vector<double> low, high;
    std::vector<bool> logarithmic;
    Observation sample;  // the conditions that do not vary
    std::set<std::string> walls, materials;
    Smooth level;
    std::optional<Smooth> log_seed_variance;  // none: no noise (bench)
    std::map<std::string, Smooth> responses;
    std::optional<Smooth> parameters;

    double coordinate(std::size_t k, double value) const;
    Point point(const Observation& row) const;
    double value(double smoothed) const;
  };

  Channel make_channel(const Library& library, const std::vector<const LibraryValue*>& values) const;
  const Channel& channel_of(const ReducedTable& table, std::size_t row) const;
  // `outside`, `silent`: as in TableModel; silent ones once an observable.
  void check_row(const Channel& channel, const ReducedTable& table, std::size_t row, const EmulatorOptions& options,
                 std::vector<std::string>& outside, std::vector<std::string>& silent) const;
  void fill_effect(const Channel& channel, const Effect& effect, const std::vector<Eigen::Index>& rows,
                   TableModel& model, EffectResponse& response) const;

  std::string folder_;
  std::vector<Effect> effects_;
  std::vector<DiscrepancyEntry> discrepancies_;
  std::vector<std::string> parameter_names_;
  Eigen::VectorXd nominal_, spread_;
  Family family_;
  std::vector<Channel> channels_;
};

}  // namespace vielto::gap

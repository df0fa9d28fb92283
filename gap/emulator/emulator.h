// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: what the simulation would say under any conditions inside the library's range, for any strength of any
// effect, and how sure that is.
//
// Each observable of an apparatus is smoothed by itself (channel.h). Where an effect file has a transform for the
// observable, the transform is used instead of runs.
//
// A table row is matched by apparatus, observable, conditions, wall and material (those that library states), not by
// the name of its test. Errors: BadInput (file and line of the row) if the library lacks the observable, for another
// wall or material or a fixed condition that differs, or for conditions outside the range, unless told to extrapolate.
// A condition that no run of the library states cannot be compared: it is told, not refused.
#pragma once

#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/reduced_table.h"
#include "gap/emulator/channel.h"
#include "gap/emulator/discrepancy.h"
#include "gap/emulator/table_model.h"

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
  const Eigen::VectorXd& nominal() const { return scale_.nominal; }

 private:
  using RowsOfChannel = std::map<const Channel*, std::vector<Eigen::Index>>;

  const Channel& channel_of(const ReducedTable& table, std::size_t row) const;
  // `outside`, `silent`: as in TableModel; silent ones once an observable.
  void check_row(const Channel& channel, const ReducedTable& table, std::size_t row, const EmulatorOptions& options,
                 std::vector<std::string>& outside, std::vector<std::string>& silent) const;
  TableModel empty_model(const ReducedTable& table) const;
  RowsOfChannel matched(const ReducedTable& table, const EmulatorOptions& options, TableModel& model) const;
  // Null: none is to be counted. Errors: BadInput if the library states some, but none of this observable.
  const Discrepancy* discrepancy_of(const Channel& channel, const EmulatorOptions& options) const;
  void fill_baseline(const Channel& channel, const std::vector<Eigen::Index>& rows, const EmulatorOptions& options,
                     TableModel& model) const;
  void fill_family(const Channel& channel, const std::vector<Eigen::Index>& rows, TableModel& model) const;
  void integrate_family(TableModel& model) const;
  void check_known(const EmulatorOptions& options) const;
  void add_effect(const Effect& effect, const RowsOfChannel& rows, const EmulatorOptions& options,
                  TableModel& model) const;

  std::string folder_;
  std::vector<Effect> effects_;
  std::vector<DiscrepancyEntry> discrepancies_;
  std::vector<std::string> parameter_names_;
  ParameterScale scale_;
  Family family_;
  std::vector<Channel> channels_;
};

}  // namespace vielto::gap

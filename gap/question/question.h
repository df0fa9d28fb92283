// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: one question about one table: what was asked, the model of the table's rows, and what a seal depends on.
// The programs have options only.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gap/question/inputs.h"
#include "gap/question/repeats.h"
#include "gap/verdict/threshold.h"

namespace vielto::gap {

struct QuestionOptions {
  InputFiles files;
  std::string table;
  std::vector<std::string> only, without;
  std::string reference;                    // table of the same machine in the reference state; empty: none
  std::vector<std::string> reference_only;  // its rows, as `only`
  double transfer = 0;                      // reference.h
  EmulatorOptions emulator;
  std::uint64_t seed = 1;
  int draws = 0;  // of the bootstrap; 0: those of the settings
};

// "EFFECT=STRENGTH" each. Errors: BadInput for one without a strength, stated twice, or among `without` too.
std::map<std::string, double> known_effects(const std::vector<std::string>& texts,
                                            const std::vector<std::string>& without);

// What a reference state adds to a question.
struct ReferenceState {
  Averaged rows;
  Eigen::VectorXd values, expected;  // measured; what the calibrated simulation expects
  double probability = 1;            // of a chi^2 as large as the reference's
  std::vector<Scatter> scatter;
};

class Question {
 public:
  // Errors: BadInput also for a table without fit rows, for a name in `without` that is no effect, and for a reference
  // that measures nothing of what the table does or is not the machine that the model is validated for.
  explicit Question(QuestionOptions options);

  QuestionOptions options;
  Inputs inputs;
  ReducedTable table;
  std::optional<ReferenceState> reference;
  TableModel model, fit;  // all rows; the fit rows. With a reference of the change

  // The fit rows as thresholds and isolability take them: the values do not count.
  TableModel before_data() const;
  Threshold threshold() const;
  ReducedTable fit_table() const;
  // The fit rows and then those of a candidate test, of one run each.
  TableModel extended(const ReducedTable& added) const;
  // The fit rows as they would stand against a reference under the same conditions, of single runs.
  TableModel with_such_a_reference() const;
  // All rows as the simulation by itself shows them: without the reference, one run each.
  TableModel simulated() const;
  // The reference for a reader; null without one.
  nlohmann::ordered_json reference_json() const;

  // SHA-256 of the rows before any data (rows_fingerprint), and of all that groups and threshold depend on: rows,
  // library, settings, rivals, options.
  std::string fingerprint_of_rows() const;
  std::string fingerprint() const;

  // Versions, hashes, seeds and options behind an answer; `commands` is empty.
  nlohmann::ordered_json provenance() const;

 private:
  void read_tables();
  // Reference and changed rows together; `count` repeats behind each.
  TableModel joint_model(const Emulator& emulator, const ReducedTable& joint, const std::vector<int>& count,
                         const RepeatsOfObservable& repeats, std::vector<Scatter>* taken = nullptr) const;
  // Rows without a reference, of single runs.
  TableModel by_itself(const Emulator& emulator, const ReducedTable& rows, const RepeatsOfObservable& repeats) const;
  // `reference`: the reference's values or expected ones.
  TableModel model_of(const Emulator& emulator, const Eigen::VectorXd& reference,
                      const RepeatsOfObservable& repeats) const;
  void check_reference();

  std::vector<int> count_, joint_count_;       // repeats behind each row of the table; of both
  ReducedTable joint_;                         // reference rows, then the table's
  RepeatsOfObservable repeats_, its_repeats_;  // of both states; of the reference alone, known before the data
};

// Indices of the rows of a role. Errors: BadInput if it is fit and there is none.
std::vector<Eigen::Index> rows_of(const ReducedTable& table, Role role);

}  // namespace vielto::gap

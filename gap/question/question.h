// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: one question about one table: what was asked, the model of the table's rows, and what a seal depends on.
// The programs have options only.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gap/question/inputs.h"
#include "gap/verdict/threshold.h"

namespace vielto::gap {

struct QuestionOptions {
  InputFiles files;
  std::string table;
  std::vector<std::string> only, without;
  EmulatorOptions emulator;
  std::uint64_t seed = 1;
  int draws = 0;  // of the bootstrap; 0: those of the settings
};

// "EFFECT=STRENGTH" each. Errors: BadInput for one without a strength, stated twice, or among `without` too.
std::map<std::string, double> known_effects(const std::vector<std::string>& texts,
                                            const std::vector<std::string>& without);

class Question {
 public:
  // Errors: BadInput also for a table without fit rows and for a name in `without` that is no effect.
  explicit Question(QuestionOptions options);

  QuestionOptions options;
  Inputs inputs;
  ReducedTable table;
  TableModel model, fit;  // all rows; the fit rows

  // The fit rows as thresholds and isolability take them: the values do not count.
  TableModel before_data() const;
  Threshold threshold() const;
  ReducedTable fit_table() const;

  // SHA-256 of the rows before any data (rows_fingerprint), and of all that groups and threshold depend on: rows,
  // library, settings, rivals, options.
  std::string fingerprint_of_rows() const;
  std::string fingerprint() const;

  // Versions, hashes, seeds and options behind an answer; `commands` is empty.
  nlohmann::ordered_json provenance() const;
};

// Indices of the rows of a role. Errors: BadInput if it is fit and there is none.
std::vector<Eigen::Index> rows_of(const ReducedTable& table, const std::string& role);

}  // namespace vielto::gap

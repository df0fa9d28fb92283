// SPDX-License-Identifier: GPL-2.0-or-later
// What every question about a gap starts from: settings, effects, response library and its emulator.
// Effects and settings lie beside the library's folder (effects/, diagnosis.toml) unless told otherwise.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gap/emulator/emulator.h"

namespace vielto::gap {

struct InputFiles {
  std::string library, effects, settings;
  // Empty ones filled in.
  InputFiles completed() const;
};

class Inputs {
 public:
  explicit Inputs(const InputFiles& files);

  InputFiles files;
  Settings settings;
  std::vector<Effect> effects;
  Library library;
  std::vector<DiscrepancyEntry> discrepancies;
  Emulator emulator;

  // File names (without folders) and their SHA-256, the versions of the libraries used. Of effect files those in
  // `effects`, or all of them.
  nlohmann::ordered_json provenance(const std::vector<std::string>* only_effects = nullptr) const;
};

// Of rows before any data: SHA-256 of conditions, u and covariance, not of values. What isolability.json was sealed
// for.
std::string rows_fingerprint(const std::vector<Observation>& rows, const Eigen::MatrixXd& noise);

// Rows of a table that satisfy every CONDITION=VALUE of `only` (wall=B, apparatus=mixer, speed=1.21 ...), covariance
// included. Errors: BadInput for a condition that is none, and if no row is left.
ReducedTable only_rows(ReducedTable table, const std::vector<std::string>& only);

// The rows of a, then those of b; errors are shared within each only.
ReducedTable joined(const ReducedTable& a, const ReducedTable& b);

}  // namespace vielto::gap

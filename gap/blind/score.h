// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the marks of a blind check, from sealed truths and the answers given to the cases.
//
// Proportions with 95 % intervals by Wilson's score; pooled closures, Brier score and F1 by bootstrap over base truths
// and cases (50th and 1950th of 2000 draws). Group and detectable: of the true effect at its own strength
// (isolability.h), from the sealed tables. A case counts as
//   right          known, strong, detectable, its group itself alone: exactly its effect is named
//   in_group       known, strong, detectable: named an effect of its group, or ambiguous with the truth and no name
//                  outside the group
//   wrong_name     known, sham, pair, prior: a name that is no true one
//   false_alarm    none: any verdict but no_gap
//   unknown_found  removed, strong: unknown
//   removed_named  removed, strong: named
//   coverage90     prior: the true strength lies in the interval given for its effect (where one is given)
//   closure        known, strong, pooled over cases: what `after` closes beyond recalibration over what the true effect
//                  closes, each 1 - sqrt(sum after^2 / sum recalibrated^2); a verdict without an effect closes nothing.
//                  null where the true effect itself closes nothing
//   closure_true_effect   what the true effect at its true strength, without recalibration, closes of what
//                  recalibration leaves
//   placebo        the same for the placebo
//   closure_resimulated, placebo_resimulated   of those cases alone whose tests were simulated again, if not all were
//   brier          mean over all cases of sum_k (p_k - [k is true])^2
//   where_f1       regions with q <= 0.05 against those the noise-free effect moves by more than 2 u
// Errors: BadInput for a truth that is not what its seal says, or a case without an answer.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vielto::gap {

// Cases, their answers, and the isolability.json that was sealed before them. With references there is a set for each.
struct AnsweredCases {
  std::string folder, answers, isolability;
};

// Of all sets together. `shuffle`: truths of a set handed to the wrong cases (a score must then be that of chance).
nlohmann::ordered_json score(const std::vector<AnsweredCases>& sets, std::optional<std::uint64_t> shuffle);

struct Wilson {
  double value = 0, low95 = 0, high95 = 0;
};
Wilson wilson(int successes, int trials);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: isolability.json, what is sealed before the data: which effects the tests can tell apart, the threshold, and
// the fingerprint of what both depend on.
//
// Errors: BadInput naming the file for a broken seal, a file that is none, a threshold that is no number, and another
// fingerprint than the question's.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gap/question/question.h"
#include "gap/verdict/isolability.h"
#include "gap/verdict/threshold.h"

namespace vielto::gap {

nlohmann::ordered_json isolability_json(const Question& question, const Isolability& isolability,
                                        const Threshold& threshold);

// The file's content, its seal checked.
nlohmann::ordered_json read_sealed(const std::string& path);

// The threshold that was sealed for this question.
Threshold sealed_threshold(const std::string& path, const Question& question);

}  // namespace vielto::gap

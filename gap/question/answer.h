// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the answer to a question, diagnosis.json: the verdict with what stands beside it, the next tests, what the
// library's runs say of the named effects, and for a change why the simulation is off by itself.
//
// Errors: BadInput as of a question and of a sealed threshold; std::runtime_error for a number that is not finite,
// which JSON would write as null and a reader take for "not known".
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gap/question/question.h"
#include "gap/verdict/diagnosis.h"

namespace vielto::gap {

struct AnswerOptions {
  QuestionOptions question;
  std::string sealed;        // isolability.json whose threshold is taken; empty: it is drawn anew
  std::string candidates;    // file of candidate tests
  bool change_only = false;  // with a reference: leave out why the simulation is off
};

Threshold threshold_of(const AnswerOptions& options, const Question& question);

// The verdict, its next tests where it leaves something open, and the predicted shrink.
Diagnosis answer(const AnswerOptions& options, const Question& question, const Isolability& isolability);

nlohmann::ordered_json answer_json(const AnswerOptions& options, const Question& question, const Diagnosis& diagnosis,
                                   const nlohmann::ordered_json& provenance);

void write_answer_file(const std::string& path, const nlohmann::ordered_json& answer);

}  // namespace vielto::gap

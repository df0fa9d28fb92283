// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: judge every candidate test for what the data leave open, best gain per hour first.
#pragma once

#include "gap/question/question.h"
#include "gap/verdict/diagnosis.h"

namespace vielto::gap {

// Open: the members of an ambiguous group, else the four most probable named models; where the gap is unknown, the gap
// itself. Beside the candidates of the file: the question's own tests once more, or in a reference state if there is
// none yet. Candidates that the library does not reach (observable, conditions) are told in `notes` and left out.
std::vector<NextTest> next_tests(const Question& question, const Diagnosis& diagnosis, const std::string& candidates,
                                 std::vector<std::string>& notes);

// The candidate's rows with what the simulation expects for values, and u. Errors: BadInput for rows or conditions that
// the library does not reach; `candidates` is the file, for the message.
ReducedTable added_rows(const Question& question, const CandidateTest& test, const std::string& candidates);

}  // namespace vielto::gap

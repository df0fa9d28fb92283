// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/csv.h"
#include "gap/library/sources.h"
#include "gap/question/next_question.h"
#include "gap/question/sealed.h"
#include "gap/verdict/points.h"

namespace vielto::gap {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t kShownOfGroup = 2;  // a long group would bury the page: its likeliest members

void require_finite_numbers(const json& j, const std::string& path, const std::string& place = "") {
  if (j.is_number_float() && !std::isfinite(j.get<double>()))
    throw std::runtime_error(fmt::format("{} is not written: its {} is not finite", path, place));
  if (j.is_structured())
    for (const auto& [key, value] : j.items()) require_finite_numbers(value, path, place + "/" + key);
}

// The other answer: not what has changed, but why the simulation is off.
json without_reference(QuestionOptions options) {
  options.reference.clear();
  options.reference_only.clear();
  const Question q(std::move(options));
  const Diagnosis d = diagnose(q.model, q.threshold(), q.inputs.settings);
  json j = {{"verdict", text_of(d.verdict)}, {"named", d.named}, {"group", d.group}};
  j["probabilities"] = json::object();
  for (const ModelEvidence& m : d.models) j["probabilities"][m.name()] = m.probability;
  j["sentence"] = verdict_sentence(d);
  return j;
}

}  // namespace

Threshold threshold_of(const AnswerOptions& options, const Question& question) {
  return options.sealed.empty() ? question.threshold() : sealed_threshold(options.sealed, question);
}

Diagnosis answer(const AnswerOptions& options, const Question& q, const Isolability& isolability) {
  Diagnosis d = diagnose(q.model, threshold_of(options, q), q.inputs.settings);
  d.of_a_change = q.reference.has_value();
  if (d.threshold.draws < q.inputs.settings.draws)
    d.notes.push_back(fmt::format("the threshold rests on {} draws, not on the settings' {}", d.threshold.draws,
                                  q.inputs.settings.draws));
  if (d.check_rows == 0) d.notes.push_back("the table has no check rows: how far the gap shrinks cannot be proved");
  d.predicted = predicted_shrink(q.model, d, isolability);
  if (d.verdict == Verdict::ambiguous || d.verdict == Verdict::unknown)
    d.next_tests = next_tests(q, d, options.candidates, d.notes);
  return d;
}

json answer_json(const AnswerOptions& options, const Question& q, const Diagnosis& d, const json& provenance) {
  json j = diagnosis_json(d, provenance);
  std::vector<std::string> shown = d.verdict == Verdict::ambiguous ? d.group : d.named;
  shown.resize(std::min(shown.size(), kShownOfGroup));
  j["sources"] = sources_json(q.inputs.library, shown);
  add_points(j, points_of(q.model, d));
  if (q.reference) {
    j["reference"] = q.reference_json();
    if (!options.change_only) j["why_it_is_off"] = without_reference(options.question);
  }
  return j;
}

void write_answer_file(const std::string& path, const json& answer) {
  require_finite_numbers(answer, path);
  write_whole_file(path, answer.dump(2) + "\n");
}

}  // namespace vielto::gap

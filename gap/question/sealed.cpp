// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/sealed.h"

#include <fmt/format.h>

#include <cmath>

#include "core/bad_input.h"
#include "core/json_file.h"
#include "core/seal.h"

namespace vielto::gap {

using json = nlohmann::ordered_json;

namespace {

json threshold_json(const Threshold& t) {
  return {{"log_odds", t.log_odds}, {"low95", t.low95},         {"high95", t.high95},
          {"draws", t.draws},       {"libraries", t.libraries}, {"seed", t.seed}};
}

}  // namespace

json isolability_json(const Question& question, const Isolability& i, const Threshold& threshold) {
  json j = {{"schema", 2}};
  j.update(to_json(i));
  // for a reader: what these tests can show of each effect at best
  j["summary"] = json::object();
  for (const std::string& e : i.effects) {
    const double s = i.farthest(e), detectable = i.detectable_from(e), isolable = i.isolable_from(e);
    json& own =
        j["summary"][e] = {{"farthest", s}, {"from_nothing", i.from_nothing(e, s)}, {"group", i.group_of(e, s)}};
    if (!std::isnan(detectable)) own["detectable_from"] = detectable;  // absent: never
    if (!std::isnan(isolable)) own["isolable_from"] = isolable;
  }
  j["threshold"] = threshold_json(threshold);
  j["fingerprint"] = question.fingerprint();
  j["rows"] = question.fingerprint_of_rows();
  j["provenance"] = question.inputs.provenance();
  return j;
}

json read_sealed(const std::string& path) {
  if (!seal_holds(path)) throw BadInput(path, 0, "is not what its seal says", "bring the sealed file back");
  json j = read_json_file<json>(path, "make it with vielto gap isolability");
  if (!j.is_object() || !j.contains("threshold") || !j["threshold"].is_object())
    throw BadInput(path, 0, "is no isolability.json", "make it with vielto gap isolability");
  return j;
}

Threshold sealed_threshold(const std::string& path, const Question& question) {
  const json j = read_sealed(path);
  if (j.value("fingerprint", json()) != question.fingerprint())
    throw BadInput(path, 0, "was sealed for other rows, u, correlations, effects or another library",
                   "seal it again before the data");
  const json& t = j["threshold"];
  for (const char* key : {"log_odds", "low95", "high95", "draws", "libraries", "seed"})
    if (!t.contains(key) || !t[key].is_number())
      throw BadInput(path, 0, fmt::format("holds a threshold whose {} is no number", key),
                     "seal it again: no verdict can rest on it");
  return {t["log_odds"], t["low95"], t["high95"], t["draws"], t["libraries"], t["seed"]};
}

}  // namespace vielto::gap

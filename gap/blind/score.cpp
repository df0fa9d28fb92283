// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/blind/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "core/bad_input.h"
#include "core/seal.h"
#include "core/sha256.h"
#include "gap/answer/verdict.h"
#include "gap/blind/case_kind.h"
#include "gap/question/sealed.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

json read_json(const fs::path& path, const char* mend) {
  std::ifstream in(path);
  const json j = in ? json::parse(in, nullptr, false) : json(json::value_t::discarded);
  if (j.is_discarded()) throw BadInput(path.string(), 0, "is no JSON file", mend);
  return j;
}

struct Scored {
  json truth, answer;
  CaseKind kind = CaseKind::none;
  Verdict verdict = Verdict::no_gap;
  Names effects;            // true ones, sorted
  Names group;              // what can stand in for the one true effect at its strength
  bool detectable = false;  // at its strength
  bool strong() const { return truth["level"] == "strong"; }
  Names named() const { return answer["named"]; }
  // The name of the true model among the probabilities.
  std::string true_model() const {
    if (kind == CaseKind::none) return text_of(Verdict::no_gap);
    if (kind == CaseKind::removed) return text_of(Verdict::unknown);
    return effects.size() == 2 ? effects[0] + "+" + effects[1] : effects[0];
  }
};

template <class Word>
Word word_of(const json& j, const char* key, std::optional<Word> (*read)(std::string_view), const std::string& path,
             const char* mend) {
  const std::string text = j.value(key, "");
  const std::optional<Word> word = read(text);
  if (!word) throw BadInput(path, 0, fmt::format("states the {} '{}'", key, text), mend);
  return *word;
}

// The sealed truths, each checked against its seal.
std::vector<json> read_truths(const fs::path& folder) {
  std::ifstream seals(folder / "seals.sha256");
  if (!seals)
    throw BadInput((folder / "seals.sha256").string(), 0, "cannot be read", "name a folder made by gap-withhold");
  std::vector<json> truths;
  std::string hash, file;
  for (int line = 1; seals >> hash >> file; ++line) {
    if (!fs::exists(folder / file) || sha256_of_file((folder / file).string()) != hash)
      throw BadInput((folder / "seals.sha256").string(), line, file + " is not what its seal says",
                     "bring the sealed truth back");
    truths.push_back(read_json(folder / file, "bring the sealed truth back"));
  }
  if (truths.empty())
    throw BadInput((folder / "seals.sha256").string(), 0, "seals nothing", "make cases with gap-withhold");
  return truths;
}

// An answer without a removed effect was judged by the sealed threshold, and by
// no other.
void check_fingerprint(const json& answer, const std::string& path, const std::string& fingerprint) {
  const json& made = answer["provenance"];
  if (made.is_object() && made.value("without", json::array()).empty() &&
      made.value("fingerprint", fingerprint) != fingerprint)
    throw BadInput(path, 0, "was made for other rows or another library than were sealed",
                   "diagnose the case with --sealed, or name the isolability.json that it "
                   "was made with");
}

std::vector<Scored> read_cases(const fs::path& folder, const fs::path& answers, const json& sealed,
                               const Isolability& isolability, std::optional<std::uint64_t> shuffle) {
  std::vector<json> truths = read_truths(folder);
  std::vector<std::string> ids;
  for (const json& truth : truths) ids.push_back(truth["case"]);
  if (shuffle) {
    std::mt19937_64 random(*shuffle);
    std::shuffle(truths.begin(), truths.end(), random);
  }
  std::vector<Scored> cases;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    Scored c;
    c.truth = truths[i];
    c.answer = read_json(answers / ids[i] / "diagnosis.json", "diagnose every case into ANSWERS/CASE");
    for (const auto& entry : c.truth["effects"].items()) c.effects.push_back(entry.key());
    std::sort(c.effects.begin(), c.effects.end());
    const std::string answer = (answers / ids[i] / "diagnosis.json").string();
    c.kind = word_of(c.truth, "kind", case_kind_of, folder.string(), "bring the sealed truth back");
    c.verdict = word_of(c.answer, "verdict", verdict_of, answer, "diagnose the case again");
    check_fingerprint(c.answer, answer, sealed.value("fingerprint", ""));
    if (c.effects.size() == 1) {
      const double strength = c.truth["effects"][c.effects[0]]["strength"];
      c.group = isolability.group_of(c.effects[0], strength);
      c.detectable = isolability.detectable(c.effects[0], strength);
    }
    cases.push_back(c);
  }
  return cases;
}

bool holds(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

using Pick = std::vector<const Scored*>;

// Bootstrap over base truths, then over the cases of each.
std::pair<double, double> interval(const Pick& cases, const std::function<double(const Pick&)>& statistic) {
  std::map<std::string, Pick> by_truth;
  for (const Scored* c : cases) by_truth[c->truth["base_truth"].get<std::string>()].push_back(c);
  std::vector<const Pick*> truths;
  for (const auto& entry : by_truth) truths.push_back(&entry.second);
  std::mt19937_64 random(1);
  std::vector<double> draws;
  for (int b = 0; b < 2000 && !truths.empty(); ++b) {
    Pick drawn;
    for (std::size_t t = 0; t < truths.size(); ++t) {
      const Pick& pool = *truths[std::uniform_int_distribution<std::size_t>(0, truths.size() - 1)(random)];
      for (std::size_t i = 0; i < pool.size(); ++i)
        drawn.push_back(pool[std::uniform_int_distribution<std::size_t>(0, pool.size() - 1)(random)]);
    }
    if (const double drawn_value = statistic(drawn); std::isfinite(drawn_value)) draws.push_back(drawn_value);
  }
  if (draws.empty()) return {0, 0};
  std::sort(draws.begin(), draws.end());
  return {draws[draws.size() / 40], draws[draws.size() - 1 - draws.size() / 40]};
}

}  // namespace

Wilson wilson(int successes, int trials) {
  if (trials == 0) return {0, 0, 1};
  const double z = 1.959963984540054, n = trials, p = successes / n, z2 = z * z / n;
  const double centre = (p + z2 / 2) / (1 + z2), half = z / (1 + z2) * std::sqrt(p * (1 - p) / n + z2 / (4 * n));
  return {p, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

namespace {

using Counts = std::function<bool(const Scored&)>;

Pick pick(const std::vector<Scored>& cases, const Counts& counts) {
  Pick picked;
  for (const Scored& c : cases)
    if (counts(c)) picked.push_back(&c);
  return picked;
}

Counts of_kind(CaseKind kind) {
  return [kind](const Scored& c) { return c.kind == kind; };
}

void add_proportion(json& into, const std::string& key, const Pick& picked, const Counts& success) {
  int n = 0;
  for (const Scored* c : picked) n += success(*c);
  const Wilson w = wilson(n, static_cast<int>(picked.size()));
  into[key] = picked.empty() ? json() : json(w.value);
  into[key + "_low95"] = w.low95;
  into[key + "_high95"] = w.high95;
  into[key + "_n"] = picked.size();
}

void add_pooled(json& into, const std::string& key, const Pick& picked,
                const std::function<double(const Pick&)>& statistic) {
  const double value = picked.empty() ? std::nan("") : statistic(picked);
  const auto [low, high] = std::isfinite(value) ? interval(picked, statistic) : std::pair<double, double>{0, 0};
  into[key] = std::isfinite(value) ? json(value) : json();
  into[key + "_low95"] = low;
  into[key + "_high95"] = high;
  into[key + "_n"] = picked.size();
}

bool is_right(const Scored& c) { return c.verdict == Verdict::named && c.named() == c.effects; }

bool is_in_group(const Scored& c) {
  if (c.verdict == Verdict::named) return c.named().size() == 1 && holds(c.group, c.named()[0]);
  if (c.verdict != Verdict::ambiguous) return false;
  const Names stated = c.answer["group"];
  return holds(stated, c.effects[0]) &&
         std::all_of(stated.begin(), stated.end(), [&](const std::string& s) { return holds(c.group, s); });
}

bool is_wrong(const Scored& c) {
  const Names names = c.named();
  return std::any_of(names.begin(), names.end(), [&](const std::string& s) { return !holds(c.effects, s); });
}

bool is_covered(const Scored& c) {
  const json& s = c.answer["strength"][c.effects[0]];
  const double truth = c.truth["effects"][c.effects[0]]["strength"];
  return s["low90"].get<double>() <= truth && truth <= s["high90"].get<double>();
}

void add_rates(json& result, const std::vector<Scored>& cases) {
  const auto strong = [](const Scored& c) { return c.kind == CaseKind::known && c.strong(); };
  add_proportion(result, "right",
                 pick(cases, [&](const Scored& c) { return strong(c) && c.detectable && c.group.size() == 1; }),
                 is_right);
  add_proportion(result, "in_group", pick(cases, [&](const Scored& c) { return strong(c) && c.detectable; }),
                 is_in_group);
  add_proportion(result, "wrong_name",
                 pick(cases, [](const Scored& c) { return c.kind != CaseKind::none && c.kind != CaseKind::removed; }),
                 is_wrong);
  add_proportion(result, "false_alarm", pick(cases, of_kind(CaseKind::none)),
                 [](const Scored& c) { return c.verdict != Verdict::no_gap; });
  const Pick removed = pick(cases, of_kind(CaseKind::removed));
  add_proportion(result, "unknown_found", removed, [](const Scored& c) { return c.verdict == Verdict::unknown; });
  add_proportion(result, "removed_named", removed, [](const Scored& c) { return c.verdict == Verdict::named; });
  add_proportion(
      result, "coverage90",
      pick(cases,
           [](const Scored& c) { return c.kind == CaseKind::prior && c.answer["strength"].contains(c.effects[0]); }),
      is_covered);
}

double square(double x) { return x * x; }

// Measured by re-simulation where that was done, else what the emulator predicts.
const json& shrink(const Scored& c) {
  return c.answer["shrink"].is_null() ? c.answer["shrink_predicted"] : c.answer["shrink"];
}

// A mean square with the noise taken out. A case that was said to have no gap adds nothing to the simulation: what its
// gap was before stands on both sides.
double mean_square(const Scored& c, const char* key) {
  const json& s = shrink(c);
  if (s.is_null()) return square(c.truth["check_before"].get<double>());
  return s.contains("mean_squares") ? s["mean_squares"][key].get<double>() : square(s[key].get<double>());
}

// Sums of squares; a sum below 0 is 0.
double closes(const Pick& picked, const std::function<double(const Scored&)>& what) {
  double after = 0, recalibrated = 0;
  for (const Scored* c : picked) {
    recalibrated += mean_square(*c, "recalibrated");
    after += what(*c);
  }
  return recalibrated > 0 ? 1 - std::sqrt(std::max(0.0, after) / recalibrated) : 0.0;
}

double true_effect_closes(const Pick& p) {
  return closes(p, [](const Scored& c) { return square(c.truth["check_true_effect"].get<double>()); });
}

// No number where the true effect at its true strength closes nothing itself: the rest of the gap is larger then.
double closure(const Pick& p) {
  const double best = true_effect_closes(p);
  return best > 0 ? closes(p, [](const Scored& c) { return mean_square(c, "after"); }) / best : std::nan("");
}

void add_closures(json& result, const std::vector<Scored>& cases) {
  const Pick strong = pick(cases, [](const Scored& c) { return c.kind == CaseKind::known && c.strong(); });
  // without a gap there is nothing to simulate again
  const auto wanted =
      std::count_if(strong.begin(), strong.end(), [](const Scored* c) { return c->verdict != Verdict::no_gap; });
  Pick simulated;
  for (const Scored* c : strong)
    if (c->verdict != Verdict::no_gap && !c->answer["shrink"].is_null()) simulated.push_back(c);
  const auto measured = static_cast<std::ptrdiff_t>(simulated.size());
  const auto placebo = [](const Pick& p) {
    return closes(p, [](const Scored& c) { return mean_square(c, "placebo"); });
  };
  add_pooled(result, "closure", strong, closure);
  add_pooled(result, "closure_true_effect", strong, true_effect_closes);
  add_pooled(result, "placebo", strong, placebo);
  if (measured > 0 && measured < wanted) {
    add_pooled(result, "closure_resimulated", simulated, closure);
    add_pooled(result, "placebo_resimulated", simulated, placebo);
  }
  result["closure_basis"] = wanted == 0          ? "no case was said to have a gap"
                            : measured == wanted ? "re-simulated"
                                                 : "predicted by the emulator where no re-simulation was made";
}

double brier(const Pick& p) {
  double sum = 0;
  for (const Scored* c : p) {
    double one = 0;
    bool seen = false;
    for (const auto& [name, value] : c->answer["probabilities"].items()) {
      const bool is_true = name == c->true_model();
      seen = seen || is_true;
      one += std::pow(value.get<double>() - is_true, 2);
    }
    sum += seen ? one : one + 1;
  }
  return p.empty() ? 0.0 : sum / static_cast<double>(p.size());
}

double f1_of_regions(const Pick& p) {
  int both = 0, found = 0, there = 0;
  for (const Scored* c : p) {
    std::set<std::string> truth;
    for (const auto& r : c->truth["regions"]) truth.insert(r.get<std::string>());
    there += static_cast<int>(truth.size());
    for (const auto& r : c->answer["where"]) {
      if (r["q_value"].get<double>() > 0.05) continue;
      ++found;
      both += static_cast<int>(truth.count(r["apparatus"].get<std::string>() + " " +
                                           r["observable"].get<std::string>() + " " + r["region"].get<std::string>()));
    }
  }
  return found + there > 0 ? 2.0 * both / (found + there) : 1.0;
}

void add_by_strength(json& result, const std::vector<Scored>& cases, const Names& effects) {
  const auto add = [](json& at, const Pick& own) {
    add_proportion(at, "right", own, is_right);
    add_proportion(at, "in_group", own, is_in_group);
    add_proportion(at, "wrong_name", own, is_wrong);
  };
  result["by_effect"] = json::object();
  for (const char* level : {"weak", "middle", "strong"}) {
    const auto known = [level](const Scored& c) { return c.kind == CaseKind::known && c.truth["level"] == level; };
    for (const std::string& name : effects)
      if (const Pick own = pick(cases, [&](const Scored& c) { return known(c) && c.effects[0] == name; }); !own.empty())
        add(result["by_effect"][name][level], own);
    add(result["by_strength"][level], pick(cases, known));
  }
}

}  // namespace

json score(const std::vector<AnsweredCases>& sets, std::optional<std::uint64_t> shuffle) {
  std::vector<Scored> cases;
  std::set<std::string> names;
  for (const AnsweredCases& set : sets) {
    const json sealed = read_sealed(set.isolability);
    const Isolability isolability = isolability_of_json(sealed, set.isolability);
    for (Scored& c : read_cases(set.folder, set.answers, sealed, isolability, shuffle)) cases.push_back(std::move(c));
    names.insert(isolability.effects.begin(), isolability.effects.end());
  }
  json result = {{"schema", 2}, {"cases", cases.size()}};
  add_rates(result, cases);
  add_closures(result, cases);
  add_pooled(result, "brier", pick(cases, [](const Scored&) { return true; }), brier);
  add_pooled(result, "where_f1",
             pick(cases,
                  [](const Scored& c) {
                    return c.kind == CaseKind::known || c.kind == CaseKind::prior || c.kind == CaseKind::pair;
                  }),
             f1_of_regions);
  add_by_strength(result, cases, {names.begin(), names.end()});
  return result;
}

}  // namespace vielto::gap

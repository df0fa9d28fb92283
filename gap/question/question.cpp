// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/question.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/sha256.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

std::vector<std::string> sorted(const std::set<std::string>& names) { return {names.begin(), names.end()}; }

}  // namespace

std::map<std::string, double> known_effects(const std::vector<std::string>& texts,
                                            const std::vector<std::string>& without) {
  std::map<std::string, double> effects;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const auto strength = equals == std::string::npos ? std::nullopt : finite_number(text.substr(equals + 1));
    if (!strength)
      throw BadInput("--known " + text, 0, "states no strength", "write EFFECT=STRENGTH, such as slice_ends=1");
    const std::string name = text.substr(0, equals);
    if (std::find(without.begin(), without.end(), name) != without.end())
      throw BadInput("--known " + text, 0, "is named by --without too", "a known effect is no candidate anyway");
    if (!effects.emplace(name, *strength).second)
      throw BadInput("--known " + text, 0, "is stated twice", "state it once");
  }
  return effects;
}

std::vector<Eigen::Index> rows_of(const ReducedTable& table, const std::string& role) {
  std::vector<Eigen::Index> keep;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i].role == role) keep.push_back(static_cast<Eigen::Index>(i));
  if (keep.empty() && role == "fit")
    throw BadInput(table.path, 0, "holds no row of role fit", "a diagnosis rests on fit rows; mark some");
  return keep;
}

Question::Question(QuestionOptions asked)
    : options(std::move(asked)),
      inputs(options.files),
      table(only_rows(read_reduced_table(options.table), options.only)),
      model(inputs.emulator.model(table, options.emulator, inputs.settings).without(options.without)),
      fit(model.part(rows_of(table, "fit"))) {
  for (const std::string& name : options.without)
    if (std::none_of(inputs.effects.begin(), inputs.effects.end(), [&](const Effect& e) { return e.name == name; }))
      throw BadInput("--without " + name, 0, "is no effect", "name one of the effects' folder");
  if (options.draws > 0) inputs.settings.draws = options.draws;
  for (const auto* notes : {&inputs.library.notes, &model.silent})
    model.notes.insert(model.notes.end(), notes->begin(), notes->end());
}

TableModel Question::before_data() const { return fit.in_logarithms(TableModel::NoiseOver::baseline); }

Threshold Question::threshold() const {
  const auto keep = rows_of(table, "fit");
  return bootstrap_threshold(inputs.emulator, before_data(), inputs.settings, options.seed, [&](const Emulator& e) {
    return e.model(table, options.emulator, inputs.settings)
        .without(options.without)
        .part(keep)
        .in_logarithms(TableModel::NoiseOver::baseline);
  });
}

ReducedTable Question::fit_table() const {
  ReducedTable part = table;
  part.rows.clear();
  part.lines.clear();
  const auto keep = rows_of(table, "fit");
  for (const Eigen::Index i : keep) {
    part.rows.push_back(table.rows[static_cast<std::size_t>(i)]);
    part.lines.push_back(table.lines[static_cast<std::size_t>(i)]);
  }
  part.covariance = Eigen::MatrixXd(Eigen::MatrixXd(table.covariance)(keep, keep)).sparseView();
  return part;
}

std::string Question::fingerprint_of_rows() const { return rows_fingerprint(fit.rows, fit.noise); }

std::string Question::fingerprint() const {
  std::vector<std::string> candidates;
  for (const EffectResponse& e : model.effects) candidates.push_back(e.name);
  for (const auto& [name, strength] : options.emulator.known) candidates.push_back(name);
  json hashes = inputs.provenance(&candidates)["hashes"];
  hashes.erase("inputs.csv");  // what the runs were made from is checked by itself; the runs' numbers are what counts
  std::string text = hashes.dump() + fingerprint_of_rows();
  text += fmt::format("{}|{}|{}|{}|{}", fmt::join(options.without, ","), fmt::join(options.emulator.ignored, ","),
                      options.emulator.runs_per_observation, !options.emulator.use_discrepancy,
                      options.emulator.extrapolate);
  for (const auto& [name, strength] : options.emulator.known) text += fmt::format("|{}={}", name, strength);
  return sha256_of_text(text);
}

json Question::provenance() const {
  json p = inputs.provenance();
  const auto add_hash = [&](const std::string& path) {
    if (!path.empty()) p["hashes"][fs::path(path).filename().string()] = sha256_of_file(path);
  };
  add_hash(options.table);
  add_hash(table.covariance_path);
  p["seeds"] = {options.seed};
  p["options"] = {{"only", options.only},
                  {"ignore", sorted(options.emulator.ignored)},
                  {"runs_per_observation", options.emulator.runs_per_observation},
                  {"extrapolate", options.emulator.extrapolate},
                  {"no_discrepancy", !options.emulator.use_discrepancy}};
  p["without"] = options.without;
  p["known"] = json::object();
  for (const auto& [name, strength] : options.emulator.known) p["known"][name] = strength;
  p["fingerprint"] = fingerprint();
  p["commands"] = json::array();
  return p;
}

}  // namespace vielto::gap

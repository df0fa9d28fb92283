// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/question.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/sha256.h"
#include "gap/emulator/reference.h"

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

std::vector<Eigen::Index> rows_of(const ReducedTable& table, Role role) {
  std::vector<Eigen::Index> keep;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i].role == role) keep.push_back(static_cast<Eigen::Index>(i));
  if (keep.empty() && role == Role::fit)
    throw BadInput(table.path, 0, "holds no row of role fit", "a diagnosis rests on fit rows; mark some");
  return keep;
}

namespace {

constexpr double kNotTheMachine = 1e-6, kDoubtful = 1e-3;  // chances of the reference's chi^2

// Both tables as one; rows of one file keep the errors that they share.
ReducedTable rows_of_both(const ReducedTable& whole, const std::vector<std::string>& first,
                          const std::vector<std::string>& second, std::size_t& n) {
  ReducedTable a = only_rows(whole, first), b = only_rows(whole, second);
  std::vector<int> keep;
  for (const ReducedTable* part : {&a, &b})
    for (const int line : part->lines)
      keep.push_back(static_cast<int>(std::find(whole.lines.begin(), whole.lines.end(), line) - whole.lines.begin()));
  n = a.rows.size();
  for (std::size_t i = 0; i < n; ++i)
    if (std::find(keep.begin() + static_cast<std::ptrdiff_t>(n), keep.end(), keep[i]) != keep.end())
      throw BadInput(whole.path, whole.lines[static_cast<std::size_t>(keep[i])],
                     "belongs to the reference and to what has changed", "state --only and --reference-only apart");
  ReducedTable joint = whole;
  joint.rows = a.rows;
  joint.lines = a.lines;
  joint.rows.insert(joint.rows.end(), b.rows.begin(), b.rows.end());
  joint.lines.insert(joint.lines.end(), b.lines.begin(), b.lines.end());
  joint.covariance = Eigen::MatrixXd(Eigen::MatrixXd(whole.covariance)(keep, keep)).sparseView();
  return joint;
}

// One mean stated for both states would be a change of nothing, known exactly.
void refuse_one_measurement_twice(const ReducedTable& both, std::size_t n) {
  const Eigen::MatrixXd u(both.covariance);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = n; j < both.rows.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      const double own = u(a, a) + u(b, b);
      if (both.rows[i].value == both.rows[j].value && own - 2 * u(a, b) < 1e-6 * own)
        throw BadInput(both.path, both.lines[j],
                       fmt::format("shares value and error with {}: one measurement stated for both states shows no "
                                   "change",
                                   both.rows[i].test),
                       "leave it out with --only, or measure each state");
    }
}

// Rows of a table from `begin` on, `count` of them.
ReducedTable section(const ReducedTable& table, std::size_t begin, std::size_t count) {
  ReducedTable part = table;
  const auto at = static_cast<std::ptrdiff_t>(begin), n = static_cast<std::ptrdiff_t>(count);
  part.rows = {table.rows.begin() + at, table.rows.begin() + at + n};
  part.lines = {table.lines.begin() + at, table.lines.begin() + at + n};
  part.covariance = Eigen::MatrixXd(Eigen::MatrixXd(table.covariance).block(at, at, n, n)).sparseView();
  return part;
}

}  // namespace

Question::Question(QuestionOptions asked) : options(std::move(asked)), inputs(options.files) {
  read_tables();
  if (reference) {
    const TableModel joint = joint_model(inputs.emulator, joint_, joint_count_, repeats_, &reference->scatter);
    const auto n = static_cast<Eigen::Index>(reference->rows.table.rows.size());
    reference->expected = expected_reference(joint, n);
    reference->probability = reference_probability(joint, reference->values);
    check_reference();
  }
  model = model_of(inputs.emulator, reference ? reference->values : Eigen::VectorXd(), repeats_);
  fit = model.part(rows_of(table, Role::fit));
  for (const std::string& name : options.without)
    if (std::none_of(inputs.effects.begin(), inputs.effects.end(), [&](const Effect& e) { return e.name == name; }))
      throw BadInput("--without " + name, 0, "is no effect", "name one of the effects' folder");
  if (options.draws > 0) inputs.settings.draws = options.draws;
  for (const auto* notes : {&inputs.library.notes, &model.silent})
    model.notes.insert(model.notes.end(), notes->begin(), notes->end());
  if (reference)
    for (const Scatter& s : reference->scatter) model.notes.push_back(text_of(s));
  if (reference && reference->probability < kDoubtful)
    model.notes.push_back(fmt::format(
        "the reference itself departs from the calibrated simulation by more than chance (chi2 probability {:.1g}): is "
        "the model validated in that state?",
        reference->probability));
}

void Question::read_tables() {
  if (options.reference.empty()) {
    table = only_rows(read_reduced_table(options.table), options.only);
    add_repeats(table, repeats_);
    return;
  }
  std::size_t n = 0;
  ReducedTable both;
  if (options.reference == options.table) {
    both = rows_of_both(read_reduced_table(options.table), options.reference_only, options.only, n);
    refuse_one_measurement_twice(both, n);
  } else {
    const ReducedTable first = only_rows(read_reduced_table(options.reference), options.reference_only);
    // for messages that name the reference's own lines
    inputs.emulator.model(first, options.emulator, inputs.settings);
    both = joined(first, only_rows(read_reduced_table(options.table), options.only));
    n = first.rows.size();
    both.path = options.table;
  }
  const ReducedTable before = section(both, 0, n), after = section(both, n, both.rows.size() - n);
  add_repeats(before, its_repeats_);
  repeats_ = its_repeats_;
  add_repeats(after, repeats_);
  // the reference is measured, all of it: roles are of the changed rows
  ReducedTable without_roles = both;
  for (std::size_t i = 0; i < n; ++i) without_roles.rows[i].role = Role::reference;
  const Averaged all = averaged(without_roles);
  joint_ = all.table;
  joint_count_ = all.count;
  std::size_t first_changed = 0;
  while (first_changed < joint_.rows.size() && joint_.rows[first_changed].role == Role::reference) ++first_changed;
  reference.emplace();
  reference->rows = {section(joint_, 0, first_changed),
                     {all.count.begin(), all.count.begin() + static_cast<std::ptrdiff_t>(first_changed)}};
  table = section(joint_, first_changed, joint_.rows.size() - first_changed);
  count_ = {all.count.begin() + static_cast<std::ptrdiff_t>(first_changed), all.count.end()};
  reference->values.resize(static_cast<Eigen::Index>(first_changed));
  for (std::size_t i = 0; i < first_changed; ++i)
    reference->values[static_cast<Eigen::Index>(i)] = joint_.rows[i].value;
}

void Question::check_reference() {
  const auto measured = [&](const Observation& row) {
    return std::any_of(reference->rows.table.rows.begin(), reference->rows.table.rows.end(), [&](const Observation& r) {
      return r.apparatus == row.apparatus && r.observable == row.observable;
    });
  };
  if (std::none_of(table.rows.begin(), table.rows.end(), measured))
    throw BadInput(options.reference, 0, fmt::format("measures nothing that {} measures", options.table),
                   "a reference is the same machine in another state: state its own rows");
  if (options.emulator.ignored.count("material") == 0)
    for (const Observation& before : reference->rows.table.rows)
      for (const Observation& after : table.rows)
        if (!before.material.empty() && !after.material.empty() && before.material != after.material)
          throw BadInput(options.reference, 0,
                         fmt::format("is of '{}', the changed rows are of '{}'", before.material, after.material),
                         "measure the same grain in both states, or --ignore material");
  if (reference->probability < kNotTheMachine)
    throw BadInput(options.reference, 0,
                   fmt::format("is not of the machine that the model is validated for: its chi2 about the calibrated "
                               "simulation has a probability of {:.1g}",
                               reference->probability),
                   "state another reference, or diagnose this one by itself first");
}

TableModel Question::joint_model(const Emulator& emulator, const ReducedTable& both, const std::vector<int>& count,
                                 const RepeatsOfObservable& repeats, std::vector<Scatter>* taken) const {
  TableModel joint = emulator.model(both, options.emulator, inputs.settings);
  if (options.emulator.runs_per_observation > 0) {
    std::vector<Scatter> scatter = set_scatter(joint, count, repeats);
    if (taken) *taken = std::move(scatter);
  }
  return joint;
}

TableModel Question::by_itself(const Emulator& emulator, const ReducedTable& rows,
                               const RepeatsOfObservable& repeats) const {
  TableModel m = emulator.model(rows, options.emulator, inputs.settings);
  if (options.emulator.runs_per_observation > 0)
    for (const Scatter& s : raise_scatter(m, repeats)) m.notes.push_back(text_of(s));
  return m.without(options.without);
}

TableModel Question::model_of(const Emulator& emulator, const Eigen::VectorXd& values,
                              const RepeatsOfObservable& repeats) const {
  if (!reference) return by_itself(emulator, table, repeats);
  return given_reference(joint_model(emulator, joint_, joint_count_, repeats), values, options.transfer,
                         inputs.settings)
      .without(options.without);
}

TableModel Question::extended(const ReducedTable& added) const {
  const ReducedTable rows = joined(fit_table(), added);
  if (!reference) return by_itself(inputs.emulator, rows, repeats_);
  std::vector<int> count = reference->rows.count;
  for (const Eigen::Index i : rows_of(table, Role::fit)) count.push_back(count_[static_cast<std::size_t>(i)]);
  count.insert(count.end(), added.rows.size(), 1);
  return given_reference(joint_model(inputs.emulator, joined(reference->rows.table, rows), count, repeats_),
                         reference->values, options.transfer, inputs.settings)
      .without(options.without);
}

TableModel Question::with_such_a_reference() const {
  const ReducedTable rows = fit_table();
  const TableModel joint = inputs.emulator.model(joined(rows, rows), options.emulator, inputs.settings);
  const Eigen::VectorXd expected = expected_reference(joint, static_cast<Eigen::Index>(rows.rows.size()));
  return given_reference(joint, expected, 0, inputs.settings).without(options.without);
}

TableModel Question::before_data() const {
  const TableModel m =
      reference ? model_of(inputs.emulator, reference->expected, its_repeats_).part(rows_of(table, Role::fit)) : fit;
  return m.in_logarithms(TableModel::Values::placeholders);
}

Threshold Question::threshold() const {
  const auto keep = rows_of(table, Role::fit);
  return bootstrap_threshold(inputs.emulator, before_data(), inputs.settings, options.seed, [&](const Emulator& e) {
    return model_of(e, reference ? reference->expected : Eigen::VectorXd(), its_repeats_)
        .part(keep)
        .in_logarithms(TableModel::Values::placeholders);
  });
}

TableModel Question::simulated() const {
  EmulatorOptions single = options.emulator;
  single.runs_per_observation = 1;
  return inputs.emulator.model(table, single, inputs.settings);
}

json Question::reference_json() const {
  if (!reference) return json();
  json j = {{"table", fs::path(options.reference).filename().string()},
            {"rows", reference->rows.table.rows.size()},
            {"chi2_probability", reference->probability},
            {"transfer", options.transfer},
            {"scatter", json::array()}};
  for (const Scatter& s : reference->scatter)
    j["scatter"].push_back({{"apparatus", s.apparatus},
                            {"observable", s.observable},
                            {"sd", s.sd},
                            {"degrees_of_freedom", s.degrees_of_freedom},
                            {"assumed", s.assumed},
                            {"library", s.library}});
  return j;
}

ReducedTable Question::fit_table() const {
  ReducedTable part = table;
  part.rows.clear();
  part.lines.clear();
  const auto keep = rows_of(table, Role::fit);
  for (const Eigen::Index i : keep) {
    part.rows.push_back(table.rows[static_cast<std::size_t>(i)]);
    part.lines.push_back(table.lines[static_cast<std::size_t>(i)]);
  }
  part.covariance = Eigen::MatrixXd(Eigen::MatrixXd(table.covariance)(keep, keep)).sparseView();
  return part;
}

std::string Question::fingerprint_of_rows() const {
  // with a reference the noise of the change holds the reference's too
  return rows_fingerprint(fit.rows, reference ? Eigen::MatrixXd(fit_table().covariance) : fit.noise);
}

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
  if (reference) {
    // the reference comes before the change: its values count
    text += fmt::format("|{}|{}", options.transfer, rows_fingerprint(reference->rows.table.rows, {}));
    for (const double value : reference->values) text += fmt::format("|{:.9g}", value);
  }
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
  if (reference) {
    add_hash(options.reference);
    add_hash(covariance_file(options.reference));
    p["options"]["reference"] = fs::path(options.reference).filename().string();
    p["options"]["reference_only"] = options.reference_only;
    p["options"]["transfer"] = options.transfer;
  }
  p["without"] = options.without;
  p["known"] = json::object();
  for (const auto& [name, strength] : options.emulator.known) p["known"][name] = strength;
  p["fingerprint"] = fingerprint();
  p["commands"] = json::array();
  return p;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/csv.h"
#include "core/rig_table.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;

template <class Value>
Value chosen(const TomlTable& table, const char* key, const std::map<std::string, Value>& choices) {
  const auto found = choices.find(table.text(key));
  if (found != choices.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  table.refuse(key, fmt::format("'{}' is none of its values", table.text(key)),
               fmt::format("write {}", fmt::join(names, ", ")));
}

VarChange read_var(const TomlTable& t) {
  t.only({"rigs", "name", "rule", "factor", "whole", "word"});
  VarChange var;
  if (t.has("rigs") && t.texts("rigs").empty())
    t.refuse("rigs", "is empty", "write rigs = [\"mixer\"], or leave it out for every rig");
  for (const std::string& name : t.texts("rigs")) {
    if (!find_rig(name))
      t.refuse("rigs", fmt::format("'{}' is no rig", name), fmt::format("write one of {}", rig_names()));
    var.rigs.push_back(name);
  }
  var.name = t.text("name");
  var.rule = chosen<VarRule>(t, "rule",
                             {{"value", VarRule::value},
                              {"offset", VarRule::offset},
                              {"scale", VarRule::scale},
                              {"power10", VarRule::power10},
                              {"divide", VarRule::divide},
                              {"word", VarRule::word},
                              {"switch", VarRule::switched}});
  if (var.rule == VarRule::word || var.rule == VarRule::switched)
    var.word = t.text("word");
  else
    var.factor = t.number("factor", -1e12, 1e12);
  var.whole = t.raw()["whole"].value_or(false);
  return var;
}

// The observable itself, beside the conditions.
const std::string kValue = "value";

std::map<std::string, double> numbers_by_condition(const TomlTable& t, const char* key) {
  std::map<std::string, double> result;
  if (!t.has(key)) return result;
  const TomlTable inner = t.table(key);
  for (const auto& entry : inner.raw()) {
    const std::string name(entry.first.str());
    if (name != kValue && !condition_member(name))
      inner.refuse(name, "is no condition", "write value, speed, fill, moisture ...");
    result[name] = inner.number(name, -1e6, 1e6);
  }
  return result;
}

std::vector<double> numbers(const TomlTable& t, const char* key) {
  const toml::array* list = t.raw()[key].as_array();
  std::vector<double> result;
  if (list)
    for (const toml::node& node : *list)
      if (const auto number = node.value<double>()) result.push_back(*number);
  if (!list || result.size() != list->size() || result.size() < 2)
    t.refuse(key, "is no list of two numbers or more", fmt::format("write {} = [0.5, 1.0]", key));
  return result;
}

Curve read_curve(const TomlTable& t) {
  Curve curve;
  if (t.has("curve") && t.has("efficiency")) t.refuse("curve", "stands beside efficiency", "keep one of the two");
  if (!t.has("curve") && !t.has("efficiency")) return curve;
  const bool loss = t.has("efficiency");
  const TomlTable inner = t.table(loss ? "efficiency" : "curve");
  inner.only({"condition", "at", "value"});
  curve.condition = inner.text("condition");
  if (!condition_member(curve.condition)) inner.refuse("condition", "is no condition", "write speed, fill ...");
  curve.at = numbers(inner, "at");
  curve.value = numbers(inner, "value");
  if (curve.value.size() != curve.at.size())
    inner.refuse("value", fmt::format("has {} numbers for {} of at", curve.value.size(), curve.at.size()),
                 "give one for each");
  for (std::size_t i = 1; i < curve.at.size(); ++i)
    if (!(curve.at[i] > curve.at[i - 1]))
      inner.refuse("at", fmt::format("falls from {} to {}", curve.at[i - 1], curve.at[i]), "give rising numbers");
  if (!loss) return curve;
  for (double& value : curve.value) {
    if (!(value > 0 && value <= 1))
      inner.refuse("value", fmt::format("has the efficiency {}", value), "give efficiencies above 0 and up to 1");
    value = 1 - value;
  }
  return curve;
}

std::vector<Term> read_terms(const TomlTable& t) {
  if (!t.has("terms")) return {Term{1, numbers_by_condition(t, "power_of")}};
  if (t.has("power_of")) t.refuse("power_of", "stands beside terms", "write it into one of them");
  std::vector<Term> terms;
  const toml::array* list = t.raw()["terms"].as_array();
  if (list)
    for (const toml::node& node : *list) {
      if (!node.is_table()) break;
      const TomlTable inner(t.path(), *node.as_table());
      inner.only({"coefficient", "power_of"});
      terms.push_back({inner.number("coefficient", -1e12, 1e12), numbers_by_condition(inner, "power_of")});
    }
  if (!list || terms.empty() || terms.size() != list->size())
    t.refuse("terms", "is no list of terms", "write terms = [{coefficient = 1, power_of = {speed = 1}}]");
  return terms;
}

double at(const Curve& curve, const Observation& row) {
  if (curve.at.empty()) return 1;
  const auto& place = row.*condition_member(curve.condition);
  if (!place)
    throw BadInput("test " + row.test, 0,
                   fmt::format("{} of {} has no {}", row.observable, row.apparatus, curve.condition),
                   "state it: an effect on the measurement depends on it");
  if (*place < curve.at.front() || *place > curve.at.back())
    throw BadInput("test " + row.test, 0,
                   fmt::format("{} {} is outside the curve of an effect, {} to {}", curve.condition, *place,
                               curve.at.front(), curve.at.back()),
                   "extend the curve in the effect's file, from its source");
  std::size_t i = 1;
  while (i + 1 < curve.at.size() && curve.at[i] < *place) ++i;
  const double part = (*place - curve.at[i - 1]) / (curve.at[i] - curve.at[i - 1]);
  return (1 - part) * curve.value[i - 1] + part * curve.value[i];
}

Transform read_transform(const TomlTable& t) {
  t.only({"apparatus", "observable", "operation", "factor", "condition", "power_of", "terms", "reference", "curve",
          "efficiency"});
  Transform transform;
  transform.apparatus = t.text("apparatus");
  transform.observable = t.text("observable");
  if (transform.observable != "*" && !observable_unit(transform.apparatus, transform.observable))
    t.refuse("observable", fmt::format("'{}' is no observable of {}", transform.observable, transform.apparatus),
             "see vielto rigs");
  transform.operation = chosen<Operation>(t, "operation",
                                          {{"scale", Operation::scale},
                                           {"add", Operation::add},
                                           {"exponential", Operation::exponential},
                                           {"shift", Operation::shift},
                                           {"efficiency", Operation::efficiency}});
  transform.factor = t.number("factor", -1e12, 1e12);
  if (transform.operation == Operation::shift) {
    transform.condition = t.text("condition");
    if (!condition_member(transform.condition)) t.refuse("condition", "is no condition", "write speed, fill ...");
  }
  transform.terms = read_terms(t);
  transform.reference = numbers_by_condition(t, "reference");
  transform.curve = read_curve(t);
  for (const Term& term : transform.terms)
    for (const auto& [name, power] : term.power_of)
      if (transform.reference.count(name) == 0 || !(transform.reference[name] > 0))
        t.refuse("reference", fmt::format("lacks a value above 0 for {}", name), "state where the factor is 1");
  return transform;
}

}  // namespace

bool VarChange::acts_on(const std::string& rig) const {
  const auto named = [&](const std::string& one) { return std::find(rigs.begin(), rigs.end(), one) != rigs.end(); };
  const RigDescription* described = find_rig(rig);
  return described && (rigs.empty() || named(rig) || named(described->effects_of));
}

bool VarChange::needs_base() const {
  return rule == VarRule::offset || rule == VarRule::scale || rule == VarRule::power10 || rule == VarRule::divide;
}

std::string VarChange::text(double base, double strength) const {
  double value = 0;
  switch (rule) {
    case VarRule::value:
      value = factor * strength;
      break;
    case VarRule::offset:
      value = base + factor * strength;
      break;
    case VarRule::scale:
      value = base * (1 + factor * strength);
      break;
    case VarRule::power10:
      value = base * std::pow(10, factor * strength);
      break;
    case VarRule::divide:
      value = base / (1 + factor * strength);
      break;
    case VarRule::word:
    case VarRule::switched:
      return word;
  }
  if (whole) value = std::round(value);
  return fmt::format("{:.9g}", value);
}

std::string Effect::changes(const std::string& rig) const {
  static const std::map<VarRule, const char*> names = {{VarRule::value, "value"},    {VarRule::offset, "offset"},
                                                       {VarRule::scale, "scale"},    {VarRule::power10, "power10"},
                                                       {VarRule::divide, "divide"},  {VarRule::word, "word"},
                                                       {VarRule::switched, "switch"}};
  std::vector<std::string> texts;
  for (const VarChange& v : vars)
    if (v.acts_on(rig))
      texts.push_back(fmt::format("{} {} {}{}", v.name, names.at(v.rule),
                                  v.word.empty() ? fmt::format("{:.9g}", v.factor) : v.word, v.whole ? " whole" : ""));
  return fmt::format("{}", fmt::join(texts, "; "));
}

bool Transform::acts_on(const std::string& on_apparatus, const std::string& on_observable) const {
  const RigDescription* described = find_rig(on_apparatus);
  const bool named = apparatus == on_apparatus || (described && described->effects_of == apparatus);
  return named && (observable == "*" || observable == on_observable);
}

Reading Transform::reading(const Observation& row, double y, double strength) const {
  double g = 0, y_slope = 0;  // of g over y, times y
  for (const Term& term : terms) {
    double product = term.coefficient, power_of_y = 0;
    for (const auto& [name, power] : term.power_of) {
      std::optional<double> value = y;
      if (name == kValue)
        power_of_y = power;
      else
        value = row.*condition_member(name);
      if (!value)
        throw BadInput("test " + row.test, 0, fmt::format("{} of {} has no {}", row.observable, row.apparatus, name),
                       "state it: an effect on the measurement depends on it");
      product *= std::pow(*value / reference.at(name), power);
    }
    g += product;
    y_slope += power_of_y * product;
  }
  const double common = factor * strength * at(curve, row);
  g *= common;
  y_slope *= common;
  switch (operation) {
    case Operation::scale:
      return {y * (1 + g), 1 + g + y_slope};
    case Operation::add:
      return {y + g, y == 0 ? 1 : 1 + y_slope / y};
    case Operation::exponential:
      return {y * std::exp(g), std::exp(g) * (1 + y_slope)};
    case Operation::efficiency:
      if (!(g < 1))
        throw BadInput("test " + row.test, 0, fmt::format("{}: an effect loses {:.3g} of it", row.observable, g),
                       "keep the loss under 1: lower the effect's prior_high");
      return {y / (1 - g), (1 - g + y_slope) / ((1 - g) * (1 - g))};
    case Operation::shift:
      break;
  }
  return {y, 1};
}

bool Effect::acts_on_rig(const std::string& rig) const {
  return std::any_of(vars.begin(), vars.end(), [&](const VarChange& v) { return v.acts_on(rig); });
}

const Transform* Effect::transform_of(const std::string& apparatus, const std::string& observable) const {
  for (const Transform& t : transforms)
    if (t.acts_on(apparatus, observable)) return &t;
  return nullptr;
}

namespace {

EffectKind kind_of(const TomlTable& file) {
  const std::map<std::string, EffectKind> kinds = {{"dem", EffectKind::dem},
                                                   {"geometry", EffectKind::geometry},
                                                   {"measurement", EffectKind::measurement},
                                                   {"numerical", EffectKind::numerical}};
  const std::string text = file.text("kind");
  const auto found = kinds.find(text);
  if (found == kinds.end())
    file.refuse("kind", fmt::format("'{}' is no kind", text), "write dem, geometry, measurement or numerical");
  return found->second;
}

}  // namespace

Effect read_effect(const std::string& path, const Settings& settings) {
  const TomlTable file = TomlTable::read(path);
  file.only({"name", "kind", "unit", "prior_low", "prior_high", "source", "shape_error", "apply"});
  Effect effect;
  effect.path = path;
  effect.name = file.text("name");
  if (effect.name != fs::path(path).stem().string() || effect.name.find_first_of("+, ") != std::string::npos)
    file.refuse("name", fmt::format("'{}' is not the file's name", effect.name), "name the file NAME.toml, one word");
  effect.kind = kind_of(file);
  effect.unit = file.text("unit");
  effect.source = file.text("source");
  effect.prior_low = file.number("prior_low", -1e12, 0);
  effect.prior_high = file.number("prior_high", 0, 1e12);
  if (effect.prior_low == effect.prior_high)
    file.refuse("prior_high", "leaves no range of strengths", "state prior_low <= 0 <= prior_high, apart");
  effect.shape_error = file.number_or("shape_error", settings.shape_error, 0, 1);
  const TomlTable apply = file.table("apply");
  apply.only({"var", "transform"});
  const auto each = [&](const char* key, auto use) {
    if (!apply.has(key)) return;
    const toml::array* list = apply.raw()[key].as_array();
    if (!list) apply.refuse(key, "is no list of tables", fmt::format("write [[apply.{}]]", key));
    for (const toml::node& node : *list) {
      if (!node.is_table()) apply.refuse(key, "is no list of tables", fmt::format("write [[apply.{}]]", key));
      use(TomlTable(path, *node.as_table()));
    }
  };
  each("var", [&](const TomlTable& t) { effect.vars.push_back(read_var(t)); });
  each("transform", [&](const TomlTable& t) { effect.transforms.push_back(read_transform(t)); });
  if (effect.vars.empty() && effect.transforms.empty())
    file.refuse("apply", "changes nothing", "add [[apply.var]] or [[apply.transform]]");
  return effect;
}

std::vector<Effect> read_effects(const std::string& folder, const Settings& settings) {
  std::vector<std::string> paths;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  if (paths.empty()) throw BadInput(folder, 0, "holds no effect", "name a folder with NAME.toml files");
  std::sort(paths.begin(), paths.end());
  std::vector<Effect> effects;
  for (const std::string& path : paths) effects.push_back(read_effect(path, settings));
  return effects;
}

}  // namespace vielto::gap

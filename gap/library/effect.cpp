// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/bad_input.h"
#include "core/csv.h"
#include "gap/library/condition.h"

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
  const toml::array* rigs = t.raw()["rigs"].as_array();
  if (!rigs || rigs->empty()) t.refuse("rigs", "is no list", "write rigs = [\"mixer\"]");
  for (const toml::node& rig : *rigs) {
    const std::string name = rig.value_or<std::string>("");
    if (name != "mixer" && name != "shearbox" && name != "repose" && name != "drum")
      t.refuse("rigs", fmt::format("'{}' is no rig", name), "write mixer, shearbox, repose or drum");
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

std::map<std::string, double> numbers_by_condition(const TomlTable& t, const char* key) {
  std::map<std::string, double> result;
  if (!t.has(key)) return result;
  const TomlTable inner = t.table(key);
  for (const auto& entry : inner.raw()) {
    const std::string name(entry.first.str());
    if (!condition_member(name)) inner.refuse(name, "is no condition", "write speed, fill, moisture ...");
    result[name] = inner.number(name, -1e6, 1e6);
  }
  return result;
}

Transform read_transform(const TomlTable& t) {
  t.only({"apparatus", "observable", "operation", "factor", "condition", "power_of", "reference"});
  Transform transform;
  transform.apparatus = t.text("apparatus");
  transform.observable = t.text("observable");
  if (transform.observable != "*" && !observable_unit(transform.apparatus, transform.observable))
    t.refuse("observable", fmt::format("'{}' is no observable of {}", transform.observable, transform.apparatus),
             "see doc/formats.md");
  transform.operation = chosen<Operation>(t, "operation",
                                          {{"scale", Operation::scale},
                                           {"add", Operation::add},
                                           {"exponential", Operation::exponential},
                                           {"shift", Operation::shift}});
  transform.factor = t.number("factor", -1e12, 1e12);
  if (transform.operation == Operation::shift) {
    transform.condition = t.text("condition");
    if (!condition_member(transform.condition)) t.refuse("condition", "is no condition", "write speed, fill ...");
  }
  transform.power_of = numbers_by_condition(t, "power_of");
  transform.reference = numbers_by_condition(t, "reference");
  for (const auto& [name, power] : transform.power_of)
    if (transform.reference.count(name) == 0 || !(transform.reference[name] > 0))
      t.refuse("reference", fmt::format("lacks a value above 0 for {}", name), "state where the factor is 1");
  return transform;
}

}  // namespace

bool VarChange::acts_on(const std::string& rig) const { return std::find(rigs.begin(), rigs.end(), rig) != rigs.end(); }

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
  return apparatus == on_apparatus && (observable == "*" || observable == on_observable);
}

double Transform::amount(const Observation& row, double strength) const {
  double g = factor * strength;
  for (const auto& [name, power] : power_of) {
    const auto& value = row.*condition_member(name);
    if (!value)
      throw BadInput("test " + row.test, 0, fmt::format("{} of {} has no {}", row.observable, row.apparatus, name),
                     "state it: an effect on the measurement depends on it");
    g *= std::pow(*value / reference.at(name), power);
  }
  return g;
}

bool Effect::acts_on_rig(const std::string& rig) const {
  return std::any_of(vars.begin(), vars.end(), [&](const VarChange& v) { return v.acts_on(rig); });
}

const Transform* Effect::transform_of(const std::string& apparatus, const std::string& observable) const {
  for (const Transform& t : transforms)
    if (t.acts_on(apparatus, observable)) return &t;
  return nullptr;
}

Effect read_effect(const std::string& path, const Settings& settings) {
  const TomlTable file = TomlTable::read(path);
  file.only({"name", "kind", "unit", "prior_low", "prior_high", "source", "shape_error", "apply"});
  Effect effect;
  effect.path = path;
  effect.name = file.text("name");
  if (effect.name != fs::path(path).stem().string() || effect.name.find_first_of("+, ") != std::string::npos)
    file.refuse("name", fmt::format("'{}' is not the file's name", effect.name), "name the file NAME.toml, one word");
  effect.kind = file.text("kind");
  if (effect.kind != "dem" && effect.kind != "geometry" && effect.kind != "measurement" && effect.kind != "numerical")
    file.refuse("kind", fmt::format("'{}' is no kind", effect.kind), "write dem, geometry, measurement or numerical");
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/rig_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/condition.h"
#include "core/rig_file.h"
#include "core/toml_table.h"

namespace vielto {

extern const char* const kRigTable;  // cases/rigs.toml, by CMakeLists.txt

namespace {

namespace fs = std::filesystem;

struct Table {
  std::vector<RigDescription> apparatuses;
  std::vector<NamedObservable> of_all;
};

std::vector<NamedObservable> read_observables(const TomlTable& t) {
  std::vector<NamedObservable> result;
  for (const std::string& name : t.keys()) {
    const std::vector<std::string> texts = t.texts(name);
    const std::string mend =
        fmt::format("write {} = [\"UNIT\", \"MEANING\"], and after them \"any sign\" or \"fitful\"", name);
    if (texts.size() < 2) t.refuse(name, "states no unit and meaning", mend);
    NamedObservable observable{name, texts[0], texts[1]};
    for (std::size_t i = 2; i < texts.size(); ++i) {
      if (texts[i] == "any sign")
        observable.any_sign = true;
      else if (texts[i] == "fitful")
        observable.fitful = true;
      else
        t.refuse(name, fmt::format("'{}' says nothing of an observable", texts[i]), mend);
    }
    result.push_back(std::move(observable));
  }
  return result;
}

std::map<std::string, std::string> read_conditions(const TomlTable& t) {
  std::map<std::string, std::string> vars;
  for (const std::string& name : t.keys()) {
    if (!condition_member(name)) {
      std::vector<const char*> names;
      for (const NamedCondition& c : kConditions) names.push_back(c.name);
      t.refuse(name, "is no condition", fmt::format("use {}", fmt::join(names, ", ")));
    }
    vars[name] = t.text(name);
  }
  return vars;
}

RigPicture read_picture(const TomlTable& t) {
  t.only({"from", "without", "close_up"});
  RigPicture picture;
  const std::string from = t.has("from") ? t.text("from") : "end";
  if (from != "end" && from != "side") t.refuse("from", fmt::format("'{}' is no place", from), "write end or side");
  picture.from_side = from == "side";
  picture.without = t.texts("without");
  if (t.has("close_up") && !t.raw()["close_up"].is_boolean())
    t.refuse("close_up", "is neither true nor false", "write one of them");
  picture.close_up = t.raw()["close_up"].value_or(false);
  return picture;
}

RigDescription read_rig(const TomlTable& t, const std::string& name, const std::string& table) {
  t.only({"title", "script", "parameters", "wall", "includes", "record", "post", "result", "conditions", "observables",
          "work", "reference", "effects_of", "picture"});
  const auto or_empty = [&](const char* key) { return t.has(key) ? t.text(key) : std::string(); };
  RigDescription rig;
  rig.name = name;
  rig.table = table;
  rig.title = t.text("title");
  rig.observables = read_observables(t.table("observables"));
  if (rig.observables.empty()) t.refuse("observables", "are none", "state at least one");
  rig.script = or_empty("script");
  rig.parameters = t.texts("parameters");
  rig.includes = t.texts("includes");
  rig.wall = or_empty("wall");
  rig.record = or_empty("record");
  rig.post = or_empty("post");
  rig.result = or_empty("result");
  rig.work = or_empty("work");
  rig.effects_of = or_empty("effects_of");
  if (t.has("reference")) rig.reference = t.table("reference").texts("numbers");
  if (t.has("picture")) rig.picture = read_picture(t.table("picture"));
  if (t.has("conditions")) rig.vars = read_conditions(t.table("conditions"));
  return rig;
}

void add_tables(Table& table, const TomlTable& file, const std::string& path) {
  for (const std::string& name : file.keys()) {
    if (path.empty() && name == "observables") {
      table.of_all = read_observables(file.table(name));
      continue;
    }
    if (std::any_of(table.apparatuses.begin(), table.apparatuses.end(),
                    [&](const RigDescription& r) { return r.name == name; }))
      file.refuse(name, "is the name of a rig that there is", "name it otherwise");
    table.apparatuses.push_back(read_rig(file.table(name), name, path));
    const std::string& like = table.apparatuses.back().effects_of;
    if (!like.empty() && std::none_of(table.apparatuses.begin(), table.apparatuses.end() - 1,
                                      [&](const RigDescription& r) { return r.is_rig() && r.name == like; }))
      file.table(name).refuse("effects_of", fmt::format("'{}' is no rig above this one", like),
                              "name one that `vielto rigs` lists");
  }
}

Table& table() {
  static Table table = [] {
    Table t;
    add_tables(t, TomlTable::parse(kRigTable, "cases/rigs.toml"), "");
    return t;
  }();
  return table;
}

std::string joined(const std::string& (*text_of)(const RigDescription&)) {
  std::vector<std::string> texts;
  for (const RigDescription& r : apparatuses())
    if (const std::string& text = text_of(r); !text.empty()) texts.push_back(text);
  return fmt::format("{}", fmt::join(texts, ", "));
}

nlohmann::ordered_json observables_json(const std::vector<NamedObservable>& observables) {
  auto j = nlohmann::ordered_json::array();
  for (const NamedObservable& o : observables)
    j.push_back(
        {{"name", o.name}, {"unit", o.unit}, {"meaning", o.meaning}, {"any_sign", o.any_sign}, {"fitful", o.fitful}});
  return j;
}

}  // namespace

std::string RigDescription::path(const std::string& stated, const std::string& root) const {
  const fs::path folder = table.empty() ? fs::path(root) / "cases" : fs::path(table).parent_path();
  return (folder / stated).lexically_normal().string();
}

const std::vector<RigDescription>& apparatuses() { return table().apparatuses; }

std::vector<RigDescription> read_rigs(const std::string& path) {
  Table with = table();
  const auto before = static_cast<std::ptrdiff_t>(with.apparatuses.size());
  add_tables(with, TomlTable::read(path), path);
  return {with.apparatuses.begin() + before, with.apparatuses.end()};
}

void add_rigs(const std::string& path) {
  for (RigDescription& rig : read_rigs(path)) table().apparatuses.push_back(std::move(rig));
}

const RigDescription* find_apparatus(const std::string& name) {
  for (const RigDescription& r : apparatuses())
    if (r.name == name) return &r;
  return nullptr;
}

const RigDescription* find_rig(const std::string& name) {
  const RigDescription* found = find_apparatus(name);
  return found && found->is_rig() ? found : nullptr;
}

std::string rig_names() {
  static const std::string none;
  return joined([](const RigDescription& r) -> const std::string& { return r.is_rig() ? r.name : none; });
}

std::string apparatus_names() {
  return joined([](const RigDescription& r) -> const std::string& { return r.name; });
}

std::string record_names() {
  return joined([](const RigDescription& r) -> const std::string& { return r.record; });
}

std::vector<NamedObservable> observables_of(const std::string& apparatus) {
  const RigDescription* found = find_apparatus(apparatus);
  if (!found) return {};
  std::vector<NamedObservable> result = found->observables;
  result.insert(result.end(), table().of_all.begin(), table().of_all.end());
  return result;
}

const NamedObservable* find_observable(const std::string& apparatus, const std::string& observable) {
  const RigDescription* found = find_apparatus(apparatus);
  if (!found) return nullptr;
  for (const std::vector<NamedObservable>* list : {&found->observables, &std::as_const(table().of_all)})
    for (const NamedObservable& o : *list)
      if (o.name == observable) return &o;
  return nullptr;
}

nlohmann::ordered_json rig_table_json() {
  using json = nlohmann::ordered_json;
  json conditions = json::array(), list = json::array();
  for (const NamedCondition& c : kConditions)
    conditions.push_back(
        {{"name", c.name}, {"unit", c.unit}, {"low", c.low}, {"high", c.high}, {"meaning", c.meaning}});
  for (const RigDescription& r : apparatuses()) {
    json one = {{"name", r.name}, {"title", r.title}, {"observables", observables_json(r.observables)}};
    if (r.is_rig()) {
      one["script"] = r.path(r.script, "");
      one["conditions"] = json::object();
      for (const auto& [condition, var] : r.vars) one["conditions"][condition] = var;
      one["record"] = r.record;
      one["post"] = r.post;
      one["result"] = r.result;
      one["work"] = r.work;
      one["reference"] = r.reference;
      one["effects_of"] = r.effects_of;
      one["files"] = json::array();
      for (const auto* files : {&r.parameters, &r.includes})
        for (const std::string& file : *files) one["files"].push_back(r.path(file, ""));
      if (!r.wall.empty()) one["files"].push_back(r.path(r.wall, ""));
    }
    list.push_back(one);
  }
  return {{"schema", 1},
          {"conditions", conditions},
          {"observables", observables_json(table().of_all)},
          {"apparatuses", list}};
}

std::string rig_table_text() {
  std::string text;
  const auto add = [&](const std::vector<NamedObservable>& observables) {
    for (const NamedObservable& o : observables)
      text += fmt::format("    {:<24} {:<6} {}\n", o.name, o.unit, o.meaning);
  };
  for (const RigDescription& r : apparatuses()) {
    text += fmt::format("{}: {}\n", r.name, r.title);
    if (r.is_rig()) text += fmt::format("  {}; RUN/{} -> RUN/post/{}\n", r.path(r.script, ""), r.record, r.result);
    for (const NamedCondition& c : kConditions)
      if (const auto var = r.vars.find(c.name); var != r.vars.end())
        text += fmt::format("  {:<26} {:<6} {} (-var {})\n", c.name, c.unit, c.meaning, var->second);
    add(r.observables);
  }
  text += "every apparatus\n";
  add(table().of_all);
  return text;
}

}  // namespace vielto

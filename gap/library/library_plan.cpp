// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/library_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/sha256.h"
#include "gap/library/columns.h"
#include "gap/library/library.h"
#include "gap/library/sources.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Every [[key]] of a table.
std::vector<TomlTable> tables_of(const TomlTable& t, const std::string& key) {
  std::vector<TomlTable> result;
  if (!t.has(key)) return result;
  const toml::array* list = t.raw()[key].as_array();
  if (!list || list->empty() || !list->is_homogeneous(toml::node_type::table))
    t.refuse(key, "is no list of tables", fmt::format("write [[{}]]", key));
  for (const toml::node& node : *list) result.emplace_back(t.path(), *node.as_table());
  return result;
}

std::vector<double> numbers_of(const TomlTable& t, const std::string& key) {
  std::vector<double> result;
  const toml::array* list = t.raw()[key].as_array();
  if (!list || list->empty()) t.refuse(key, "is no list of numbers", fmt::format("write {} = [1, 2]", key));
  for (const toml::node& node : *list) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) t.refuse(key, "holds something that is no number", "write numbers only");
    result.push_back(*value);
  }
  return result;
}

int whole_of(const TomlTable& t, const std::string& key, int low, int high) {
  const double value = t.number(key, low, high);
  if (value != std::floor(value)) t.refuse(key, "is not whole", "write a whole number");
  return static_cast<int>(value);
}

// Numbers of conditions or of members, from 1, as places from 0.
std::vector<std::size_t> places_of(const TomlTable& t, const std::string& key, std::size_t count,
                                   const char* what = "condition") {
  std::vector<std::size_t> result;
  for (const double x : numbers_of(t, key)) {
    if (x < 1 || x > static_cast<double>(count) || x != std::floor(x))
      t.refuse(key, fmt::format("{} is no {}", x, what), fmt::format("write numbers from 1 to {}", count));
    result.push_back(static_cast<std::size_t>(x) - 1);
  }
  return result;
}

std::map<std::string, double> numbers_by_name(const TomlTable& t) {
  std::map<std::string, double> result;
  for (const auto& entry : t.raw()) {
    const std::string name(entry.first.str());
    result[name] = t.number(name, -1e12, 1e12);
  }
  return result;
}

struct FamilyFile {
  std::vector<std::string> names;
  std::vector<std::vector<double>> members;
};

FamilyFile read_family_file(const std::string& path) {
  FamilyFile family;
  family.names = read_columns(path, {"weight"}, [&](int line, const std::vector<std::string_view>& f) {
    family.members.emplace_back();
    for (std::size_t k = 1; k < f.size(); ++k)
      family.members.back().push_back(column_number(path, line, fmt::format("{}", k + 1), f[k]));
  });
  return family;
}

const Effect* effect_called(const std::string& name, const std::vector<Effect>& effects) {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == name; });
  return found == effects.end() ? nullptr : &*found;
}

const Effect& effect_of(const TomlTable& t, const std::vector<Effect>& effects) {
  const std::string name = t.text("name");
  const Effect* found = effect_called(name, effects);
  if (!found) t.refuse("name", fmt::format("'{}' has no effect file", name), "add it to libraries/effects");
  return *found;
}

// As numbers where both are: a plan says 0.1, a study 0.10.
bool same_setting(const std::string& a, const std::string& b) {
  const auto x = finite_number(a), y = finite_number(b);
  return x && y ? std::fabs(*x - *y) <= 1e-8 * std::fabs(*y) : a == b;
}

// What the effects of a rig start from.
std::map<std::string, double> base_of(const Rig& rig, const std::map<std::string, std::string>& settings) {
  std::map<std::string, double> base = rig.base;
  for (const auto& [name, value] : settings)
    if (const auto number = finite_number(value)) base[name] = *number;
  return base;
}

// Parameters of a row of a design; none stated: the baseline's own.
void take_parameters(LibraryRun& run, const std::map<std::string, double>& stated,
                     const std::vector<std::string>& names, const std::string& file, int line) {
  if (stated.empty()) return;
  for (const std::string& name : names)
    if (stated.count(name) == 0)
      throw BadInput(file, line, name, "is empty, but other calibrated parameters are stated",
                     "state all of a member or none");
  run.parameters = stated;
  for (const auto& [name, value] : stated) run.settings[name] = number_text(value);
}

// Rows of effects and calibrated parameters. Each effect starts from what the row states and the effects before it
// made.
std::vector<LibraryRun> read_together(const std::string& file, const std::vector<std::string>& parameters,
                                      const std::map<std::string, double>& own, const Rig& rig,
                                      const std::map<std::string, std::string>& common,
                                      const std::vector<Effect>& effects) {
  std::vector<std::vector<std::string>> cells;
  const std::vector<std::string> names = read_columns(
      file, {}, [&](int, const std::vector<std::string_view>& f) { cells.emplace_back(f.begin(), f.end()); });
  const auto is_parameter = [&](const std::string& name) {
    return std::find(parameters.begin(), parameters.end(), name) != parameters.end();
  };
  for (const std::string& name : names) {
    const Effect* effect = effect_called(name, effects);
    if (!effect && !is_parameter(name))
      throw BadInput(file, 1, name, "is neither an effect nor a parameter of the family",
                     "name files of libraries/effects and columns of the family's file");
    if (effect && !effect->acts_on_rig(rig.name))
      throw BadInput(file, 1, name, fmt::format("does nothing in {}", rig.name), "leave the column out");
  }
  std::vector<LibraryRun> runs;
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const int line = static_cast<int>(r) + 2;
    LibraryRun run{"", "", {}, 0, own, {}, {}};
    std::map<std::string, double> stated;
    for (std::size_t k = 0; k < names.size(); ++k)
      if (!cells[r][k].empty()) {
        const double value = column_number(file, line, names[k], cells[r][k]);
        if (is_parameter(names[k]))
          stated[names[k]] = value;
        else if (value != 0)
          run.effects[names[k]] = value;
      }
    take_parameters(run, stated, parameters, file, line);
    for (const auto& [name, strength] : run.effects) {
      const Effect& effect = *effect_called(name, effects);
      if (strength < effect.prior_low || strength > effect.prior_high)
        throw BadInput(file, line, name, fmt::format("{} is outside the prior range", strength),
                       fmt::format("write strengths from {} to {}", effect.prior_low, effect.prior_high));
      std::map<std::string, std::string> before = common;
      for (const auto& [var, value] : run.settings) before[var] = value;
      for (const VarChange& change : effect.vars)
        if (change.acts_on(rig.name) && !change.needs_base() && run.settings.count(change.name))
          throw BadInput(file, line, name, fmt::format("sets {}, which the row sets already", change.name),
                         "leave one of both out of the row");
      for (const auto& [var, value] : rig.settings(effect, strength, base_of(rig, before))) run.settings[var] = value;
      run.changes[name] = effect.changes(rig.name);
    }
    if (run.effects.empty() && stated.empty())
      throw BadInput(file, line, "states neither an effect nor parameters",
                     "the baseline has its own seeds; remove it");
    runs.push_back(std::move(run));
  }
  return runs;
}

void add_rig(LibraryPlan& plan, const TomlTable& t, const std::vector<Effect>& effects, const std::string& root,
             int seeds, const FamilyFile& family, const std::vector<std::size_t>& members) {
  t.only({"name", "settings", "conditions", "members_at", "effect", "design"});
  const Rig rig = Rig::read(t.text("name"), root);
  plan.rigs.push_back(rig);
  std::map<std::string, std::string> common;
  if (t.has("settings")) {
    const TomlTable settings = t.table("settings");
    for (const auto& entry : settings.raw()) {
      const std::string name(entry.first.str());
      if (rig.known.count(name) == 0)
        settings.refuse(name, fmt::format("is no parameter of {}", rig.script), "see its .par file");
      common[name] = settings.text(name);
    }
  }
  std::vector<std::map<std::string, std::string>> conditions;
  std::vector<int> seeds_at;
  for (const TomlTable& c : tables_of(t, "conditions")) {
    conditions.push_back(common);
    seeds_at.push_back(c.has("seeds") ? whole_of(c, "seeds", kLeastSeeds, 100) : seeds);
    for (const auto& [name, value] : numbers_by_name(c)) {
      if (name == "seeds") continue;
      const auto var = rig.vars.find(name);
      if (var == rig.vars.end()) c.refuse(name, "is no condition of this rig", "see vielto rigs");
      conditions.back()[var->second] = number_text(value);
    }
  }
  if (conditions.empty()) conditions.push_back(common), seeds_at.push_back(seeds);
  for (const std::string& name : plan.parameter_names)
    if (rig.base.count(name) == 0)
      throw BadInput(plan.family_file, 1, fmt::format("'{}' is no parameter of {}", name, rig.name),
                     "name a -var of its cards");
  std::map<std::string, double> own;
  for (const std::string& name : plan.parameter_names) own[name] = rig.base.at(name);
  if (!plan.baseline.empty() && plan.baseline != own)
    t.refuse("name", "has other baseline parameters than the rigs above", "calibrated parameters belong to the cards");
  plan.baseline = own;

  // Seeds of their own: a run with an effect that starts from the baseline's packing would share its noise. Fixed ones:
  // what is run already stays when the plan grows.
  const auto add = [&](std::size_t c, const std::string& label, int seed, LibraryRun run) {
    run.rig = rig.name;
    run.seed = seed;
    run.name = fmt::format("{}{}_{}_s{}", rig.name, c + 1, label, run.seed);
    std::map<std::string, std::string> settings = conditions[c];
    for (const auto& [name, value] : run.settings) settings[name] = value;
    run.settings = std::move(settings);
    plan.runs.push_back(std::move(run));
  };
  for (int s = 0; s < *std::max_element(seeds_at.begin(), seeds_at.end()); ++s)
    for (std::size_t c = 0; c < conditions.size(); ++c)
      if (s < seeds_at[c]) add(c, "none", s + 1, {"", "", {}, 0, own, {}, {}});
  if (t.has("members_at"))
    for (std::size_t m = 0; m < members.size(); ++m) {
      const std::size_t at = members[m];
      LibraryRun run;
      for (std::size_t k = 0; k < family.names.size(); ++k) {
        run.parameters[family.names[k]] = family.members[at][k];
        run.settings[family.names[k]] = number_text(family.members[at][k]);
      }
      for (const std::size_t c : places_of(t, "members_at", conditions.size()))
        add(c, fmt::format("member{}", m + 1), 101 + static_cast<int>(m), run);
    }
  for (const TomlTable& e : tables_of(t, "effect")) {
    e.only({"name", "strengths", "at", "seeds"});
    const Effect& effect = effect_of(e, effects);
    if (!effect.acts_on_rig(rig.name)) e.refuse("name", fmt::format("does nothing in {}", rig.name), "leave it out");
    for (const double strength : numbers_of(e, "strengths")) {
      LibraryRun run{"",
                     "",
                     {{effect.name, strength}},
                     0,
                     own,
                     rig.settings(effect, strength, base_of(rig, common)),
                     {{effect.name, effect.changes(rig.name)}}};
      if (run.settings.empty() || strength < effect.prior_low || strength > effect.prior_high)
        e.refuse("strengths", fmt::format("{} is 0 or outside the prior range", strength),
                 fmt::format("write strengths from {} to {}", effect.prior_low, effect.prior_high));
      for (int s = 0; s < (e.has("seeds") ? whole_of(e, "seeds", 1, 100) : 1); ++s)
        for (const std::size_t c : places_of(e, "at", conditions.size()))
          add(c, fmt::format("{}{}", effect.name, number_text(strength)), 301 + s, run);
    }
  }
  for (const TomlTable& d : tables_of(t, "design")) {
    d.only({"file", "at"});
    const std::string file = (fs::path(t.path()).parent_path() / d.text("file")).lexically_normal().string();
    const std::vector<LibraryRun> rows = read_together(file, plan.parameter_names, own, rig, common, effects);
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (const std::size_t c : places_of(d, "at", conditions.size()))
        add(c, fmt::format("{}{}", fs::path(file).stem().string(), k + 1), 1001 + static_cast<int>(k), rows[k]);
  }
}

}  // namespace

LibraryPlan LibraryPlan::read(const std::string& path, const std::vector<Effect>& effects, const std::string& root) {
  const TomlTable file = TomlTable::read(path);
  file.only({"seeds", "family", "rig", "bench"});
  LibraryPlan plan;
  const int seeds = whole_of(file, "seeds", kLeastSeeds, 100);
  FamilyFile family;
  std::vector<std::size_t> members;  // rows of the file, from 0
  if (file.has("family")) {
    const TomlTable t = file.table("family");
    t.only({"file", "members", "members_from"});
    const auto file_of = [&](const char* key) {
      return (fs::path(path).parent_path() / t.text(key)).lexically_normal().string();
    };
    plan.posterior_file = file_of("file");
    plan.family_file = t.has("members_from") ? file_of("members_from") : plan.posterior_file;
    family = read_family_file(plan.family_file);
    if (plan.family_file != plan.posterior_file && read_family_file(plan.posterior_file).names != family.names)
      throw BadInput(plan.family_file, 1, fmt::format("has other parameters than {}", plan.posterior_file),
                     "write the same columns in the same order");
    members = places_of(t, "members", family.members.size(), "member of the family");
    plan.parameter_names = family.names;
  }
  for (const TomlTable& t : tables_of(file, "rig")) add_rig(plan, t, effects, root, seeds, family, members);
  for (const TomlTable& t : tables_of(file, "bench")) {
    t.only({"observable", "rows"});
    const auto unit = observable_unit("bench", t.text("observable"));
    if (!unit) t.refuse("observable", "is no bench observable", "see vielto rigs");
    for (const TomlTable& r : tables_of(t, "rows")) {
      Observation row;
      row.apparatus = "bench";
      row.role = Role::fit;
      row.observable = t.text("observable");
      row.unit = *unit;
      toml::table plain = r.raw();
      plain.erase("slopes");
      for (const auto& [name, value] : numbers_by_name(TomlTable(path, plain))) {
        if (name == "value")
          row.value = value;
        else if (const auto member = condition_member(name))
          row.*member = value;
        else
          r.refuse(name, "is no condition", "write value, speed, fill ...");
      }
      r.number("value", -1e12, 1e12);
      row.u = std::max(1e-6, 1e-6 * std::fabs(row.value));  // not used: bench rows are not simulated
      row.test = fmt::format("bench_{}{}", row.observable, plan.bench.size() + 1);
      plan.bench.push_back(row);
      plan.bench_parameters.push_back(plan.baseline);
      if (!r.has("slopes")) continue;
      const TomlTable slopes = r.table("slopes");
      for (const auto& [name, slope] : numbers_by_name(slopes))
        if (plan.baseline.count(name) == 0)
          slopes.refuse(name, "is no calibrated parameter", "name columns of the family's file");
      const Observation own = row;
      for (const std::size_t at : members) {
        row.value = own.value;
        std::map<std::string, double> parameters;
        for (std::size_t k = 0; k < family.names.size(); ++k) parameters[family.names[k]] = family.members[at][k];
        for (const auto& [name, slope] : numbers_by_name(slopes))
          row.value += slope * (parameters[name] - plan.baseline.at(name));
        row.test = fmt::format("{}_member{}", own.test, at + 1);
        plan.bench.push_back(row);
        plan.bench_parameters.push_back(parameters);
      }
    }
  }
  return plan;
}

void write_study(const LibraryPlan& plan, const std::string& path) {
  std::set<std::string> names;
  for (const LibraryRun& run : plan.runs)
    for (const auto& [name, value] : run.settings) names.insert(name);
  std::string text = fmt::format("run,rig,seed,{}\n", fmt::join(names, ","));
  for (const LibraryRun& run : plan.runs) {
    text += fmt::format("{},{},{}", run.name, run.rig, run.seed);
    for (const std::string& name : names) {
      const auto value = run.settings.find(name);
      text += "," + (value == run.settings.end() ? "" : value->second);
    }
    text += "\n";
  }
  write_whole_file(path, text);
}

namespace {

std::string joined_names(const std::map<std::string, double>& effects) {
  std::vector<std::string> names;
  for (const auto& [name, strength] : effects) names.push_back(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, "+"));
}

std::string joined_strengths(const std::map<std::string, double>& effects) {
  std::vector<std::string> strengths;
  for (const auto& [name, strength] : effects) strengths.push_back(number_text(strength));
  return strengths.empty() ? "0" : fmt::format("{}", fmt::join(strengths, "+"));
}

}  // namespace

Collected collect_library(const LibraryPlan& plan, const std::string& results, const std::string& folder) {
  fs::create_directories(folder);
  std::map<std::string, std::string> hash_of;  // file name -> hash of what is there now
  std::map<std::string, std::string> inputs;   // path from the folder -> hash
  for (const Rig& rig : plan.rigs)
    for (const std::string& file : rig.files) {
      const std::string hash = sha256_of_file(file);
      hash_of[fs::path(file).filename().string()] = hash;
      inputs[fs::relative(file, folder).string()] = hash;
    }
  const auto parameters_text = [&](const std::map<std::string, double>& values) {
    std::string text;
    for (const std::string& name : plan.parameter_names) text += "," + number_text(values.at(name));
    return text;
  };
  std::string design = "test,effect,strength,seed,run_hash";
  for (const std::string& name : plan.parameter_names) design += "," + name;
  design += "\n";
  std::string sources = kSourcesHeader;
  std::set<std::string> changes;
  std::vector<Observation> rows;
  Collected collected;
  for (const LibraryRun& run : plan.runs) {
    const std::string description = (fs::path(results) / "runs" / run.name / "run.json").string();
    const std::string table = (fs::path(results) / "post" / (run.name + ".csv")).string();
    if (!fs::exists(description) || !fs::exists(table)) {
      collected.missing.push_back(run.name);
      continue;
    }
    json made = read_json(description);
    if (const std::string name = changed_file(made, hash_of); !name.empty())
      throw BadInput(description, 0, fmt::format("the run was made from another {}", name),
                     "run it again, or bring the file back");
    for (const auto& [name, value] : run.settings)
      if (const std::string had = made["parameters"].value(name, ""); !same_setting(had, value))
        throw BadInput(description, 0,
                       fmt::format("the run was made with {} {}, the plan now has {}", name, had, value),
                       "run it again, or bring the plan and the effect's file back");
    made["parameters"].erase("run");
    design +=
        fmt::format("{},{},{},{},{}{}\n", run.name, joined_names(run.effects), joined_strengths(run.effects), run.seed,
                    sha256_of_text(made["hashes"].dump() + made["parameters"].dump()), parameters_text(run.parameters));
    for (const auto& [effect, changed] : run.changes) changes.insert(fmt::format("{},{},{}", effect, run.rig, changed));
    for (Observation row : read_observations(table)) {
      row.test = run.name;
      rows.push_back(row);
    }
    const std::string power = (fs::path(results) / "runs" / run.name / "post" / "power.json").string();
    if (fs::exists(power))
      sources += sources_of_run(run.name, read_json(power), fs::path(power).replace_filename("phase.csv").string());
    ++collected.runs;
  }
  if (collected.runs == 0)
    throw BadInput(results, 0, "holds no run of the plan", "run its study with scripts/campaign");
  for (std::size_t i = 0; i < plan.bench.size(); ++i) {
    const Observation& row = plan.bench[i];
    design += fmt::format("{},none,0,1,{}{}\n", row.test, sha256_of_text(fmt::format("{} {}", row.test, row.value)),
                          parameters_text(plan.bench_parameters[i]));
  }
  const auto path = [&](const char* name) { return (fs::path(folder) / name).string(); };
  write_whole_file(path("design.csv"), design);
  write_observations(path("observations.csv"), rows);
  if (sources.find('\n') + 1 < sources.size())
    write_whole_file(path("sources.csv"), sources);  // the mixer's parts only
  if (!plan.bench.empty()) write_observations(path("bench.csv"), plan.bench);
  if (!plan.family_file.empty()) {
    fs::copy_file(plan.posterior_file, path("posterior.csv"), fs::copy_options::overwrite_existing);
    inputs["posterior.csv"] = sha256_of_file(path("posterior.csv"));
    for (const std::string& file : {plan.posterior_file, plan.family_file})
      inputs[fs::relative(file, folder).string()] = sha256_of_file(file);
  }
  std::string list = "file,sha256\n";
  for (const auto& [file, hash] : inputs) list += file + "," + hash + "\n";
  write_whole_file(path("inputs.csv"), list);
  list = "effect,rig,changes\n";
  for (const std::string& line : changes) list += line + "\n";
  write_whole_file(path("effects.csv"), list);
  return collected;
}

}  // namespace vielto::gap

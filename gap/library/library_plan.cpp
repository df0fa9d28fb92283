// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/library_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/bad_input.h"
#include "core/condition.h"
#include "gap/library/columns.h"
#include "gap/library/library.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;

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

// The calibrated family, as far as a plan runs it.
struct PlannedFamily {
  FamilyFile file;
  std::vector<std::size_t> members;  // rows of the file, from 0

  std::map<std::string, double> parameters(std::size_t member) const {
    std::map<std::string, double> values;
    for (std::size_t k = 0; k < file.names.size(); ++k) values[file.names[k]] = file.members[member][k];
    return values;
  }
};

// A block [[rig]] of a plan -> its runs. Seeds of their own: a run with an effect that starts from the baseline's
// packing would share its noise. Fixed ones: what is run already stays when the plan grows.
class RigRuns {
 public:
  RigRuns(const TomlTable& t, const std::string& root, int seeds, const PlannedFamily& family,
          const std::vector<Effect>& effects)
      : t_(t), rig_(Rig::read(t.text("name"), root)), family_(family), effects_(effects) {
    t.only({"name", "settings", "conditions", "members_at", "effect", "design"});
    read_settings();
    read_conditions(seeds);
  }

  const Rig& rig() const { return rig_; }

  std::vector<LibraryRun> runs(const std::map<std::string, double>& baseline) {
    own_ = baseline;
    add_baseline();
    if (t_.has("members_at")) add_members();
    for (const TomlTable& e : tables_of(t_, "effect")) add_effect(e);
    for (const TomlTable& d : tables_of(t_, "design")) add_design(d);
    return std::move(runs_);
  }

 private:
  void read_settings() {
    if (!t_.has("settings")) return;
    const TomlTable settings = t_.table("settings");
    for (const auto& entry : settings.raw()) {
      const std::string name(entry.first.str());
      if (rig_.known.count(name) == 0)
        settings.refuse(name, fmt::format("is no parameter of {}", rig_.script), "see its .par file");
      common_[name] = settings.text(name);
    }
  }

  void read_conditions(int seeds) {
    for (const TomlTable& c : tables_of(t_, "conditions")) {
      conditions_.push_back({common_, c.has("seeds") ? whole_of(c, "seeds", kLeastSeeds, 100) : seeds});
      for (const auto& [name, value] : numbers_by_name(c)) {
        if (name == "seeds") continue;
        const auto var = rig_.vars.find(name);
        if (var == rig_.vars.end()) c.refuse(name, "is no condition of this rig", "see vielto rigs");
        conditions_.back().settings[var->second] = number_text(value);
      }
    }
    if (conditions_.empty()) conditions_.push_back({common_, seeds});
  }

  void add(std::size_t c, const std::string& label, int seed, LibraryRun run) {
    run.rig = rig_.name;
    run.seed = seed;
    run.name = fmt::format("{}{}_{}_s{}", rig_.name, c + 1, label, run.seed);
    std::map<std::string, std::string> settings = conditions_[c].settings;
    for (const auto& [name, value] : run.settings) settings[name] = value;
    run.settings = std::move(settings);
    runs_.push_back(std::move(run));
  }

  void add_baseline() {
    int most = 0;
    for (const Condition& c : conditions_) most = std::max(most, c.seeds);
    for (int s = 0; s < most; ++s)
      for (std::size_t c = 0; c < conditions_.size(); ++c)
        if (s < conditions_[c].seeds) add(c, "none", s + 1, {"", "", {}, 0, own_, {}, {}});
  }

  void add_members() {
    for (std::size_t m = 0; m < family_.members.size(); ++m) {
      LibraryRun run;
      run.parameters = family_.parameters(family_.members[m]);
      for (const auto& [name, value] : run.parameters) run.settings[name] = number_text(value);
      for (const std::size_t c : places_of(t_, "members_at", conditions_.size()))
        add(c, fmt::format("member{}", m + 1), 101 + static_cast<int>(m), run);
    }
  }

  void add_effect(const TomlTable& e) {
    e.only({"name", "strengths", "at", "seeds"});
    const Effect& effect = effect_of(e, effects_);
    if (!effect.acts_on_rig(rig_.name)) e.refuse("name", fmt::format("does nothing in {}", rig_.name), "leave it out");
    const int seeds = e.has("seeds") ? whole_of(e, "seeds", 1, 100) : 1;
    for (const double strength : numbers_of(e, "strengths")) {
      LibraryRun run;
      run.effects = {{effect.name, strength}};
      run.parameters = own_;
      run.settings = rig_.settings(effect, strength, base_of(rig_, common_));
      run.changes = {{effect.name, effect.changes(rig_.name)}};
      if (run.settings.empty() || strength < effect.prior_low || strength > effect.prior_high)
        e.refuse("strengths", fmt::format("{} is 0 or outside the prior range", strength),
                 fmt::format("write strengths from {} to {}", effect.prior_low, effect.prior_high));
      for (int s = 0; s < seeds; ++s)
        for (const std::size_t c : places_of(e, "at", conditions_.size()))
          add(c, fmt::format("{}{}", effect.name, number_text(strength)), 301 + s, run);
    }
  }

  void add_design(const TomlTable& d) {
    d.only({"file", "at"});
    const std::string file = (fs::path(t_.path()).parent_path() / d.text("file")).lexically_normal().string();
    const std::vector<LibraryRun> rows = read_together(file, family_.file.names, own_, rig_, common_, effects_);
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (const std::size_t c : places_of(d, "at", conditions_.size()))
        add(c, fmt::format("{}{}", fs::path(file).stem().string(), k + 1), 1001 + static_cast<int>(k), rows[k]);
  }

  struct Condition {
    std::map<std::string, std::string> settings;
    int seeds = 0;  // of the baseline
  };
  const TomlTable& t_;
  Rig rig_;
  const PlannedFamily& family_;
  const std::vector<Effect>& effects_;
  std::map<std::string, std::string> common_;  // settings of every run
  std::vector<Condition> conditions_;
  std::map<std::string, double> own_;  // the family's parameters as the cards state them
  std::vector<LibraryRun> runs_;
};

void add_rig(LibraryPlan& plan, const TomlTable& t, const std::vector<Effect>& effects, const std::string& root,
             int seeds, const PlannedFamily& family) {
  RigRuns block(t, root, seeds, family, effects);
  std::map<std::string, double> own;
  for (const std::string& name : plan.parameter_names) {
    if (block.rig().base.count(name) == 0)
      throw BadInput(plan.family_file, 1, fmt::format("'{}' is no parameter of {}", name, block.rig().name),
                     "name a -var of its cards");
    own[name] = block.rig().base.at(name);
  }
  if (!plan.baseline.empty() && plan.baseline != own)
    t.refuse("name", "has other baseline parameters than the rigs above", "calibrated parameters belong to the cards");
  plan.baseline = own;
  for (LibraryRun& run : block.runs(own)) plan.runs.push_back(std::move(run));
  plan.rigs.push_back(block.rig());
}

// A row of [[bench]] for the baseline, and with slopes for each member of the family.
void add_bench_row(LibraryPlan& plan, const TomlTable& r, Observation row, const PlannedFamily& family) {
  toml::table plain = r.raw();
  plain.erase("slopes");
  for (const auto& [name, value] : numbers_by_name(TomlTable(r.path(), plain))) {
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
  if (!r.has("slopes")) return;
  const TomlTable slopes = r.table("slopes");
  const std::map<std::string, double> slope_of = numbers_by_name(slopes);
  for (const auto& [name, slope] : slope_of)
    if (plan.baseline.count(name) == 0)
      slopes.refuse(name, "is no calibrated parameter", "name columns of the family's file");
  const Observation own = row;
  for (const std::size_t at : family.members) {
    const std::map<std::string, double> parameters = family.parameters(at);
    row.value = own.value;
    for (const auto& [name, slope] : slope_of) row.value += slope * (parameters.at(name) - plan.baseline.at(name));
    row.test = fmt::format("{}_member{}", own.test, at + 1);
    plan.bench.push_back(row);
    plan.bench_parameters.push_back(parameters);
  }
}

void add_bench(LibraryPlan& plan, const TomlTable& t, const PlannedFamily& family) {
  t.only({"observable", "rows"});
  const auto unit = observable_unit("bench", t.text("observable"));
  if (!unit) t.refuse("observable", "is no bench observable", "see vielto rigs");
  Observation row;
  row.apparatus = "bench";
  row.role = Role::fit;
  row.observable = t.text("observable");
  row.unit = *unit;
  for (const TomlTable& r : tables_of(t, "rows")) add_bench_row(plan, r, row, family);
}

PlannedFamily read_family(LibraryPlan& plan, const TomlTable& t) {
  t.only({"file", "members", "members_from"});
  const auto file_of = [&](const char* key) {
    return (fs::path(t.path()).parent_path() / t.text(key)).lexically_normal().string();
  };
  plan.posterior_file = file_of("file");
  plan.family_file = t.has("members_from") ? file_of("members_from") : plan.posterior_file;
  PlannedFamily family{read_family_file(plan.family_file), {}};
  if (plan.family_file != plan.posterior_file && read_family_file(plan.posterior_file).names != family.file.names)
    throw BadInput(plan.family_file, 1, fmt::format("has other parameters than {}", plan.posterior_file),
                   "write the same columns in the same order");
  family.members = places_of(t, "members", family.file.members.size(), "member of the family");
  plan.parameter_names = family.file.names;
  return family;
}

}  // namespace

LibraryPlan LibraryPlan::read(const std::string& path, const std::vector<Effect>& effects, const std::string& root) {
  const TomlTable file = TomlTable::read(path);
  file.only({"seeds", "family", "rig", "bench"});
  LibraryPlan plan;
  const int seeds = whole_of(file, "seeds", kLeastSeeds, 100);
  PlannedFamily family;
  if (file.has("family")) family = read_family(plan, file.table("family"));
  for (const TomlTable& t : tables_of(file, "rig")) add_rig(plan, t, effects, root, seeds, family);
  for (const TomlTable& t : tables_of(file, "bench")) add_bench(plan, t, family);
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

}  // namespace vielto::gap

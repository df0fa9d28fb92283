// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/reduced_table.h"
#include "core/rig_table.h"
#include "core/sha256.h"
#include "gap/library/columns.h"
#include "gap/library/sources.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kOwnFiles = {"design.csv", "posterior.csv", "members.csv",    "discrepancy.csv",
                                         "inputs.csv", "sources.csv",   "covariance.csv", "effects.csv"};

// "cohesion+shape" and "150+0.2". Errors: BadInput with the column.
std::map<std::string, double> effects_of(const std::string& path, int line, std::string_view names,
                                         std::string_view strengths, const std::vector<Effect>& effects) {
  const auto parts = [](std::string_view text) {
    std::vector<std::string_view> result;
    for (std::size_t at = 0; (at = text.find('+')) != std::string_view::npos; text.remove_prefix(at + 1))
      result.push_back(text.substr(0, at));
    result.push_back(text);
    return result;
  };
  const std::vector<std::string_view> name = parts(names), strength = parts(strengths);
  if (name.size() != strength.size())
    throw BadInput(path, line, "strength", fmt::format("states {} for {} effects", strength.size(), name.size()),
                   "state one strength an effect, as cohesion+shape and 150+0.2");
  std::map<std::string, double> result;
  for (std::size_t k = 0; k < name.size(); ++k) {
    const double s = column_number(path, line, "strength", strength[k]);
    if (names == "none") {
      if (s != 0)
        throw BadInput(path, line, "strength", "is not 0 for the effect 'none'", "name the effect or write 0");
      return {};
    }
    const auto effect =
        std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == name[k]; });
    if (effect == effects.end())
      throw BadInput(path, line, "effect", fmt::format("'{}' has no file", name[k]),
                     "add its NAME.toml to the effects' folder, or write none");
    if (s < effect->prior_low || s > effect->prior_high)
      throw BadInput(path, line, "strength",
                     fmt::format("{} is outside the prior range of {}, {} to {}", s, name[k], effect->prior_low,
                                 effect->prior_high),
                     "run strengths inside it");
    if (!result.emplace(name[k], s).second)
      throw BadInput(path, line, "effect", fmt::format("names {} twice", name[k]), "state its strength once");
  }
  return result;
}

void read_design(Library& library, const std::vector<Effect>& effects) {
  const std::string path = (fs::path(library.folder) / "design.csv").string();
  std::map<std::string, int> tests, hashes;
  std::vector<std::vector<std::string>> parameters;
  library.parameter_names = read_columns(
      path, {"test", "effect", "strength", "seed", "run_hash"}, [&](int line, const std::vector<std::string_view>& f) {
        Run run;
        run.line = line;
        run.test = f[0];
        run.effects = effects_of(path, line, f[1], f[2], effects);
        const double seed = column_number(path, line, "seed", f[3]);
        run.seed = static_cast<int>(seed);
        run.run_hash = f[4];
        if (run.seed < 1 || run.seed != seed)
          throw BadInput(path, line, "seed", fmt::format("'{}' is no seed", f[3]), "write 1, 2, 3 ...");
        if (run.run_hash.size() != 64 || run.run_hash.find_first_not_of("0123456789abcdef") != std::string::npos)
          throw BadInput(path, line, "run_hash", fmt::format("'{}' is no SHA-256", f[4]),
                         "write 64 hexadecimal digits");
        if (const auto [at, is_new] = tests.emplace(run.test, line); !is_new)
          throw BadInput(path, line, "test", fmt::format("'{}' is the run of line {}", f[0], at->second),
                         "name every run as a test of its own");
        if (const auto [at, is_new] = hashes.emplace(run.run_hash, line); !is_new)
          throw BadInput(path, line, "run_hash", fmt::format("is the run of line {} again", at->second),
                         "state each run once");
        run.parameters.resize(static_cast<Eigen::Index>(f.size()) - 5);
        for (std::size_t k = 5; k < f.size(); ++k)
          run.parameters[static_cast<Eigen::Index>(k) - 5] = column_number(path, line, fmt::format("{}", k + 1), f[k]);
        library.runs.push_back(run);
      });
  library.files.push_back(path);

  // The baseline's own parameters: those of most runs without an effect.
  std::map<std::vector<double>, int> counts;
  const auto key = [](const Run& run) {
    return std::vector<double>(run.parameters.data(), run.parameters.data() + run.parameters.size());
  };
  for (const Run& run : library.runs)
    if (run.effects.empty()) ++counts[key(run)];
  if (counts.empty()) throw BadInput(path, 0, "holds no run of the baseline", "add runs of effect none");
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  library.nominal =
      Eigen::Map<const Eigen::VectorXd>(most->first.data(), static_cast<Eigen::Index>(most->first.size()));
  for (Run& run : library.runs) run.nominal = key(run) == most->first;
}

/* What no simulated run can give: a bed without slope, power, stress or weight, a slope of 90 degrees. Such a row is a
   mistake of its maker, and an emulator would take it as a response. The table of rigs says
   which may have any sign. */
void refuse_impossible(const Observation& row, const std::string& path, int line) {
  if (const NamedObservable* o = find_observable(row.apparatus, row.observable); o && o->any_sign) return;
  if (!(row.value > 0))
    throw BadInput(path, line, "value", fmt::format("{} of {} is {}", row.observable, row.apparatus, row.value),
                   "state a value above 0, or remove the run");
  if (row.unit == "deg" && !(row.value < 90))
    throw BadInput(path, line, "value", fmt::format("{} of {} is {} degrees", row.observable, row.apparatus, row.value),
                   "state an angle below 90, or remove the run");
}

void read_tables(Library& library) {
  std::map<std::string, int> runs;
  for (std::size_t i = 0; i < library.runs.size(); ++i) runs[library.runs[i].test] = static_cast<int>(i);
  std::vector<std::string> paths;
  for (const auto& entry : fs::directory_iterator(library.folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".csv" && kOwnFiles.count(name) == 0 && name.rfind("together", 0) != 0 &&
        name.find(".covariance.csv") == std::string::npos)
      paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  std::set<std::pair<int, std::string>> seen;
  std::vector<bool> has_rows(library.runs.size(), false);
  for (const std::string& path : paths) {
    const ReducedTable table = read_reduced_table(path);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const Observation& row = table.rows[i];
      const auto run = runs.find(row.test);
      if (run == runs.end())
        throw BadInput(path, table.lines[i], "test", fmt::format("'{}' is no run of design.csv", row.test),
                       "add it to the design or remove its rows");
      if (!seen.emplace(run->second, row.apparatus + " " + row.observable).second)
        throw BadInput(path, table.lines[i], "observable", fmt::format("of run '{}' is stated twice", row.test),
                       "state each observable of a run once");
      refuse_impossible(row, path, table.lines[i]);
      has_rows[run->second] = true;
      library.values.push_back({run->second, row});
    }
    library.files.push_back(path);
  }
  for (std::size_t i = 0; i < has_rows.size(); ++i)
    if (!has_rows[i])
      throw BadInput((fs::path(library.folder) / "design.csv").string(), library.runs[i].line, "test",
                     fmt::format("'{}' has no row in any table", library.runs[i].test), "add its observations");
}

void check_seeds(const Library& library) {
  std::map<std::string, std::pair<int, const LibraryValue*>> counts;
  for (const LibraryValue& value : library.values) {
    if (!find_rig(value.row.apparatus)) continue;
    const std::string where =
        fmt::format("{} {} at {}", value.row.apparatus, value.row.observable, conditions_text(value.row));
    auto& entry = counts.try_emplace(where, 0, &value).first->second;
    entry.first += library.runs[value.run].baseline();
  }
  for (const auto& [where, entry] : counts)
    if (entry.first < kLeastSeeds)
      throw BadInput((fs::path(library.folder) / "design.csv").string(), library.runs[entry.second->run].line, "seed",
                     fmt::format("the baseline of {} has {} seeds", where, entry.first),
                     fmt::format("run at least {}", kLeastSeeds));
}

void read_family(Library& library) {
  const std::string path = (fs::path(library.folder) / "posterior.csv").string();
  if (!fs::exists(path)) return;
  std::vector<std::vector<double>> rows;
  const auto names = read_columns(path, {"weight"}, [&](int line, const std::vector<std::string_view>& f) {
    rows.emplace_back();
    for (const std::string_view field : f) rows.back().push_back(column_number(path, line, "", field));
    if (rows.back()[0] < 0) throw BadInput(path, line, "weight", "is negative", "state weights of 0 or more");
  });
  if (names != library.parameter_names)
    throw BadInput(path, 1, fmt::format("names the parameters {}", fmt::join(names, ", ")),
                   fmt::format("name those of design.csv: {}", fmt::join(library.parameter_names, ", ")));
  const bool shown = std::any_of(library.runs.begin(), library.runs.end(), [](const Run& run) { return !run.nominal; });
  if (!shown)
    throw BadInput(path, 0, "cannot be used: no run shows what its parameters do",
                   "add baseline runs at other members of the family to design.csv");
  const auto m = static_cast<Eigen::Index>(rows.size()), p = static_cast<Eigen::Index>(names.size());
  library.family.weights.resize(m);
  library.family.parameters.resize(m, p);
  for (Eigen::Index i = 0; i < m; ++i) {
    library.family.weights[i] = rows[i][0];
    for (Eigen::Index k = 0; k < p; ++k) library.family.parameters(i, k) = rows[i][k + 1];
  }
  if (!(library.family.weights.sum() > 0)) throw BadInput(path, 0, "has no weight above 0", "state at least one");
  library.family.weights /= library.family.weights.sum();
  library.files.push_back(path);
}

// The effects' runs are those of the effects as they are now.
void check_effects(const Library& library, const std::vector<Effect>& effects) {
  const std::string path = (fs::path(library.folder) / "effects.csv").string();
  if (!fs::exists(path)) return;
  read_columns(path, {"effect", "rig", "changes"}, [&](int line, const std::vector<std::string_view>& f) {
    for (const Effect& e : effects)
      if (const std::string now = e.changes(std::string(f[1])); e.name == f[0] && now != f[2])
        throw BadInput(path, line, "changes", fmt::format("the library is stale: {} now says '{}'", e.path, now),
                       "make the effect's runs again and add them with scripts/library add, or bring the file back");
  });
}

void check_fresh(const Library& library) {
  const std::string path = (fs::path(library.folder) / "inputs.csv").string();
  if (!fs::exists(path)) return;
  read_columns(path, {"file", "sha256"}, [&](int line, const std::vector<std::string_view>& f) {
    const std::string file = (fs::path(library.folder) / std::string(f[0])).string();
    if (!fs::is_regular_file(file))
      throw BadInput(path, line, "file", fmt::format("'{}' is not there", f[0]),
                     "state paths from the library's folder");
    if (sha256_of_file(file) != f[1])
      throw BadInput(path, line, "sha256", fmt::format("the library is stale: '{}' has changed since its runs", f[0]),
                     "run the campaign again, or bring the file back");
  });
}

}  // namespace

Library Library::read(const std::string& folder, const std::vector<Effect>& effects) {
  if (!fs::is_directory(folder)) throw BadInput(folder, 0, "is no response library", "name a folder with design.csv");
  Library library;
  library.folder = folder;
  read_design(library, effects);
  for (const char* name : {"inputs.csv", "effects.csv"})
    if (!fs::exists(fs::path(folder) / name))
      library.notes.push_back(fmt::format("the library has no {}: whether it is stale cannot be told", name));
  const auto several =
      std::count_if(library.runs.begin(), library.runs.end(), [](const Run& r) { return r.varies_several(); });
  if (several > 0)
    library.notes.push_back(
        fmt::format("{} runs vary several things at once: they are kept, but not yet used", several));
  check_fresh(library);
  check_effects(library, effects);
  read_tables(library);
  add_paddle_shares(library);
  check_seeds(library);
  read_family(library);
  return library;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// The runs of a plan that are done -> the files of a library.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/sha256.h"
#include "gap/library/library_plan.h"
#include "gap/library/sources.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// As numbers where both are: a plan says 0.1, a study 0.10.
bool same_setting(const std::string& a, const std::string& b) {
  const auto x = finite_number(a), y = finite_number(b);
  return x && y ? std::fabs(*x - *y) <= 1e-8 * std::fabs(*y) : a == b;
}

// A limit on overlaps only ends a run: one that it did not end is the same with a wider limit.
bool same_run(const std::string& name, const std::string& had, const std::string& planned) {
  if (same_setting(had, planned)) return true;
  const auto tight = finite_number(had), wide = finite_number(planned);
  return name == "maxOverlap" && tight && wide && *tight < *wide;
}

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

// What the files that runs are made from are now.
class Files {
 public:
  Files(const std::vector<Rig>& rigs, const std::string& folder) : folder_(folder) {
    for (const Rig& rig : rigs)
      for (const std::string& file : rig.files) hash_of_name_[fs::path(file).filename().string()] = add(file);
  }

  const std::string& add(const std::string& file) {
    return inputs_[fs::relative(file, folder_).string()] = sha256_of_file(file);
  }

  // Errors: BadInput if a run was made from other files, or with other settings than the plan's.
  void check(const json& made, const LibraryRun& run, const std::string& description) const {
    if (const std::string name = changed_file(made, hash_of_name_); !name.empty())
      throw BadInput(description, 0, fmt::format("the run was made from another {}", name),
                     "run it again, or bring the file back");
    for (const auto& [name, value] : run.settings)
      if (const std::string had = made.at("parameters").value(name, ""); !same_run(name, had, value))
        throw BadInput(description, 0,
                       fmt::format("the run was made with {} {}, the plan now has {}", name, had, value),
                       "run it again, or bring the plan and the effect's file back");
  }

  std::string table() const {
    std::string list = "file,sha256\n";
    for (const auto& [file, hash] : inputs_) list += file + "," + hash + "\n";
    return list;
  }

 private:
  std::string folder_;
  std::map<std::string, std::string> hash_of_name_;
  std::map<std::string, std::string> inputs_;  // path from the folder -> hash
};

// The tables of a library, grown run by run.
class Tables {
 public:
  explicit Tables(const LibraryPlan& plan) : plan_(plan) {
    for (const std::string& name : plan.parameter_names) design_ += "," + name;
    design_ += "\n";
  }

  void add(const LibraryRun& run, json made, const fs::path& results) {
    made["parameters"].erase("run");
    add_design(run.name, joined_names(run.effects), joined_strengths(run.effects), run.seed,
               made["hashes"].dump() + made["parameters"].dump(), run.parameters);
    for (const auto& [effect, changed] : run.changes)
      changes_.insert(fmt::format("{},{},{}\n", effect, run.rig, changed));
    for (Observation row : read_observations((results / "post" / (run.name + ".csv")).string())) {
      row.test = run.name;
      rows_.push_back(row);
    }
    const fs::path power = results / "runs" / run.name / "post" / "power.json";
    if (fs::exists(power))
      sources_ +=
          sources_of_run(run.name, read_json(power.string()), fs::path(power).replace_filename("phase.csv").string());
  }

  void write(const fs::path& folder) {
    for (std::size_t i = 0; i < plan_.bench.size(); ++i) {
      const Observation& row = plan_.bench[i];
      add_design(row.test, "none", "0", 1, fmt::format("{} {}", row.test, row.value), plan_.bench_parameters[i]);
    }
    const auto path = [&](const char* name) { return (folder / name).string(); };
    write_whole_file(path("design.csv"), design_);
    write_observations(path("observations.csv"), rows_);
    if (sources_.find('\n') + 1 < sources_.size())
      write_whole_file(path("sources.csv"), sources_);  // the mixer's parts only
    if (!plan_.bench.empty()) write_observations(path("bench.csv"), plan_.bench);
    std::string effects = "effect,rig,changes\n";
    for (const std::string& line : changes_) effects += line;
    write_whole_file(path("effects.csv"), effects);
  }

 private:
  void add_design(const std::string& test, const std::string& effects, const std::string& strengths, int seed,
                  const std::string& made_of, const std::map<std::string, double>& parameters) {
    design_ += fmt::format("{},{},{},{},{}", test, effects, strengths, seed, sha256_of_text(made_of));
    for (const std::string& name : plan_.parameter_names) design_ += "," + number_text(parameters.at(name));
    design_ += "\n";
  }

  const LibraryPlan& plan_;
  std::string design_ = "test,effect,strength,seed,run_hash";
  std::string sources_ = kSourcesHeader;
  std::set<std::string> changes_;
  std::vector<Observation> rows_;
};

}  // namespace

Collected collect_library(const LibraryPlan& plan, const std::string& results, const std::string& folder) {
  fs::create_directories(folder);
  Files files(plan.rigs, folder);
  Tables tables(plan);
  Collected collected;
  for (const LibraryRun& run : plan.runs) {
    const std::string description = (fs::path(results) / "runs" / run.name / "run.json").string();
    if (!fs::exists(description) || !fs::exists(fs::path(results) / "post" / (run.name + ".csv"))) {
      collected.missing.push_back(run.name);
      continue;
    }
    const json made = read_json(description);
    files.check(made, run, description);
    tables.add(run, made, results);
    ++collected.runs;
  }
  if (collected.runs == 0)
    throw BadInput(results, 0, "holds no run of the plan", "run its study with scripts/campaign");
  tables.write(folder);
  if (!plan.family_file.empty()) {
    const fs::path posterior = fs::path(folder) / "posterior.csv";
    fs::copy_file(plan.posterior_file, posterior, fs::copy_options::overwrite_existing);
    for (const std::string& file : {posterior.string(), plan.posterior_file, plan.family_file}) files.add(file);
  }
  write_whole_file((fs::path(folder) / "inputs.csv").string(), files.table());
  return collected;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "confirm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <regex>
#include <set>
#include <thread>

#include "bad_input.h"
#include "condition.h"
#include "csv.h"
#include "rig.h"
#include "sha256.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::VectorXd;

const Effect& effect_named(const Inputs& inputs, const std::string& name) {
  return *std::find_if(inputs.effects.begin(), inputs.effects.end(), [&](const Effect& e) { return e.name == name; });
}

std::vector<double> medians(const ModelEvidence& m) {
  std::vector<double> s;
  for (std::size_t e = 0; e < m.effects.size(); ++e) s.push_back(m.strength(e).value);
  return s;
}

// What a command simulates: without the folder, and without the taking up of a run that was broken off.
std::string simulated_by(const std::string& command) {
  static const std::regex place(" -var (run|resume) [^ ]+");
  return std::regex_replace(command, place, "");
}

}  // namespace

Plan plan_confirmation(const Inputs& inputs, const TableModel& model, const Diagnosis& d,
                       const Isolability& isolability, const std::string& rigs_file, const std::string& root,
                       const std::string& runs, int seeds, const std::vector<std::string>& extra,
                       const std::map<std::string, double>& known) {
  std::vector<Index> fit_rows;
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    if (model.rows[i].role == "fit") fit_rows.push_back(static_cast<Index>(i));
  const TableModel fit = model.part(fit_rows);
  Plan plan;
  const auto add_variant = [&](const std::string& name, const ModelEvidence* m) {
    Variant v;
    v.name = name;
    if (m) {
      v.effects = m->effects;
      v.strengths = medians(*m);
    }
    if (name != "before" && fit.family_weights.size() > 0)
      v.parameters = recalibrated_parameters(fit, v.effects, v.strengths);
    for (const auto& [effect, strength] : known) {
      v.effects.push_back(effect);
      v.strengths.push_back(strength);
    }
    plan.variants.push_back(v);
  };
  add_variant("before", nullptr);
  add_variant("recalibrated", nullptr);
  const auto applied = d.applied();
  if (!applied.empty()) {
    add_variant("after", d.model(applied.size() == 2 ? applied[0] + "+" + applied[1] : applied[0]));
    if (const ModelEvidence* placebo = placebo_of(d, isolability)) {
      add_variant("placebo", placebo);
      plan.placebo = placebo->name();
    }
  }

  // Settings of all runs; what an effect or the family changes starts from them.
  std::map<std::string, std::string> common;
  for (const std::string& setting : extra) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw BadInput("--var " + setting, 0, "is no setting", "write --var NAME=VALUE");
    common[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  const TomlTable file = TomlTable::read(rigs_file);
  std::map<std::string, Rig> rigs;
  std::set<std::string> done;
  std::map<std::string, std::string> alike;  // conditions -> the test whose runs serve all of these
  for (const Observation& row : model.rows) {
    if (row.role != "check" || row.apparatus == "bench" || !done.insert(row.test).second) continue;
    if (rigs.count(row.apparatus) == 0) rigs[row.apparatus] = Rig::read(file, row.apparatus, root);
    const Rig& rig = rigs[row.apparatus];
    const std::string first = alike.emplace(row.apparatus + " " + conditions_text(row), row.test).first->second;
    if (first != row.test) {
      for (PlannedRun& run : plan.runs)
        if (run.tests.front() == first) run.tests.push_back(row.test);
      continue;
    }
    for (const Variant& v : plan.variants)
      for (int seed = 1; seed <= seeds; ++seed) {
        PlannedRun run;
        run.variant = v.name;
        run.tests = {row.test};
        run.apparatus = row.apparatus;
        run.seed = seed;
        run.folder = rig.folder;
        run.files = rig.files;
        run.resumes = rig.known.count("resume") > 0;
        run.run = (fs::absolute(runs) / fmt::format("{}-{}-s{}", row.test, v.name, seed)).lexically_normal().string();
        run.command = {"liggghts", "-in", rig.script};
        const auto var = [&](const std::string& name, const std::string& value) {
          run.command.insert(run.command.end(), {"-var", name, value});
        };
        for (const NamedCondition& c : kConditions) {
          const auto name = rig.vars.find(c.name);
          if (name == rig.vars.end() || !(row.*c.member)) continue;
          double value = *(row.*c.member);
          for (std::size_t e = 0; e < v.effects.size(); ++e)
            for (const Transform& t : effect_named(inputs, v.effects[e]).transforms)
              if (t.operation == Operation::shift && t.condition == c.name && t.apparatus == row.apparatus)
                value *= 1 + t.factor * v.strengths[e];
          var(name->second, fmt::format("{:.9g}", value));
        }
        std::map<std::string, double> base = rig.base;
        for (const auto& [name, value] : common)
          if (const auto number = finite_number(value)) base[name] = *number;
        for (Index k = 0; k < v.parameters.size(); ++k) {
          const std::string& name = inputs.library.parameter_names[static_cast<std::size_t>(k)];
          base[name] = v.parameters[k];
        }
        std::map<std::string, std::string> changed = common;
        for (Index k = 0; k < v.parameters.size(); ++k) {
          const std::string& name = inputs.library.parameter_names[static_cast<std::size_t>(k)];
          changed[name] = fmt::format("{:.9g}", base[name]);
        }
        for (std::size_t e = 0; e < v.effects.size(); ++e) {
          if (v.strengths[e] == 0) continue;
          const Effect& effect = effect_named(inputs, v.effects[e]);
          for (const auto& [name, value] : rig.settings(effect, v.strengths[e], base)) {
            changed[name] = value;
            if (const auto number = finite_number(value)) base[name] = *number;
          }
          for (const VarChange& change : effect.vars)
            if (change.acts_on(row.apparatus) && change.rule == VarRule::switched) {
              if (known.count(effect.name) && v.strengths[e] != 1)
                throw BadInput("--known " + effect.name, 0, "is a switch: a run has it wholly or not",
                               "state strength 1, or leave it a candidate");
              if (known.count(effect.name) == 0) run.share = v.strengths[e];
            }
        }
        for (const auto& [name, value] : changed) var(name, value);
        var("seed", fmt::format("{}", seed));
        var("run", run.run);
        if (!rig.post.empty()) run.post = rig.post + " '" + run.run + "'";
        plan.runs.push_back(run);
      }
  }
  return plan;
}

std::string command_line(const PlannedRun& run) {
  return fmt::format("(cd '{}' && {}{})", run.folder, fmt::join(run.command, " "),
                     run.post.empty() ? "" : " && " + run.post);
}

void refuse_other_runs(const Plan& plan) {
  std::map<std::string, std::string> hash_of_path;
  for (const PlannedRun& run : plan.runs)
    for (const char* state : {"", ".partial"}) {
      const std::string folder = run.run + state, description = folder + "/run.json";
      if (!fs::exists(description)) continue;
      const nlohmann::json made = read_json(description);
      const std::string mend = fmt::format("remove {} to run it anew, or state another --runs", folder);
      if (simulated_by(made.value("command", "")) != simulated_by(fmt::format("{}", fmt::join(run.command, " "))))
        throw BadInput(description, 0, "the run was made by another command than now planned", mend);
      std::map<std::string, std::string> hash_of;
      for (const std::string& file : run.files) {
        std::string& hash = hash_of_path[file];
        if (hash.empty()) hash = sha256_of_file(file);
        hash_of[fs::path(file).filename().string()] = hash;
      }
      if (const std::string name = changed_file(made, hash_of); !name.empty())
        throw BadInput(description, 0, fmt::format("the run was made from another {}", name), mend);
    }
}

void run_plan(const Plan& plan, int jobs) {
  std::vector<std::pair<std::string, std::string>> missing;  // command line, log
  for (const PlannedRun& run : plan.runs) {
    if (fs::exists(fs::path(run.run) / "post" / "observations.csv")) continue;
    fs::create_directories(fs::path(run.run).parent_path());
    PlannedRun now = run;
    if (fs::exists(fs::path(run.run) / "run.json"))
      now.command = {"true"};  // complete, only its rows are missing
    else if (fs::exists(run.run + ".partial") && !run.resumes)
      fs::remove_all(run.run + ".partial");
    else if (fs::exists(run.run + ".partial"))
      now.command.insert(now.command.end(), {"-var", "resume", "yes"});
    missing.emplace_back(command_line(now), run.run + ".out");
  }
  std::mutex lock;
  std::size_t next = 0;
  std::string failed;
  const auto work = [&] {
    for (;;) {
      std::pair<std::string, std::string> run;
      {
        const std::lock_guard<std::mutex> guard(lock);
        if (next == missing.size() || !failed.empty()) return;
        run = missing[next++];
        fmt::print("{} of {}: {}\n", next, missing.size(), run.first);
        std::fflush(stdout);
      }
      if (std::system((run.first + " > '" + run.second + "' 2>&1").c_str()) != 0) {
        const std::lock_guard<std::mutex> guard(lock);
        if (failed.empty()) failed = fmt::format("a run failed, see {}: {}", run.second, run.first);
      }
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < jobs; ++k) workers.emplace_back(work);
  for (std::thread& w : workers) w.join();
  if (!failed.empty()) throw std::runtime_error(failed);
}

Shrink measured_shrink(const Plan& plan, const Inputs& inputs, const TableModel& model) {
  // Mean over the seeds by variant, test and observable.
  std::map<std::string, std::pair<double, int>> sums;
  std::map<std::string, double> share;
  for (const PlannedRun& run : plan.runs) {
    const std::string path = (fs::path(run.run) / "post" / "observations.csv").string();
    if (!fs::exists(path)) throw BadInput(path, 0, "is not there", "run: " + command_line(run));
    for (const Observation& row : read_reduced_table(path).rows) {
      for (const std::string& test : run.tests) {
        auto& sum = sums[run.variant + " " + test + " " + row.observable];
        sum.first += row.value;
        ++sum.second;
      }
    }
    for (const std::string& test : run.tests) share[run.variant + " " + test] = run.share;
  }
  std::vector<const Observation*> rows;
  std::set<std::string> tests;
  for (const Observation& row : model.rows)
    if (row.role == "check" && row.apparatus != "bench") {
      rows.push_back(&row);
      tests.insert(row.test);
    }
  const Index n = static_cast<Index>(rows.size());
  VectorXd observed(n), u(n);
  std::map<std::string, VectorXd> simulated;
  const auto mean = [&](const std::string& variant, const Observation& row) {
    const auto sum = sums.find(variant + " " + row.test + " " + row.observable);
    if (sum == sums.end())
      throw BadInput("runs of " + variant, 0, fmt::format("test '{}' shows no {}", row.test, row.observable),
                     "the rig must write it to post/observations.csv");
    return sum->second.first / sum->second.second;
  };
  for (const Variant& v : plan.variants) {
    VectorXd y(n);
    for (Index i = 0; i < n; ++i) {
      const Observation& row = *rows[static_cast<std::size_t>(i)];
      observed[i] = row.value;
      u[i] = row.u;
      y[i] = mean(v.name, row);
      const double part = share.at(v.name + " " + row.test);
      if (part != 1) y[i] = part * y[i] + (1 - part) * mean("recalibrated", row);
      for (std::size_t e = 0; e < v.effects.size(); ++e) {
        const Transform* t = effect_named(inputs, v.effects[e]).transform_of(row.apparatus, row.observable);
        if (!t || t->operation == Operation::shift) continue;
        const double g = t->amount(row, v.strengths[e]);
        y[i] = t->operation == Operation::scale ? y[i] * (1 + g)
               : t->operation == Operation::add ? y[i] + g
                                                : y[i] * std::exp(g);
      }
    }
    simulated[v.name] = y;
  }
  const VectorXd& recalibrated = simulated.at("recalibrated");
  const auto of = [&](const char* name) { return simulated.count(name) ? simulated.at(name) : recalibrated; };
  Shrink s = shrink_of(observed, u, simulated.at("before"), recalibrated, of("after"), of("placebo"),
                       static_cast<int>(tests.size()));
  s.placebo_name = plan.placebo;
  return s;
}

}  // namespace vielto::gap

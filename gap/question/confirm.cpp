// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/confirm.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <regex>
#include <set>
#include <sstream>
#include <thread>
#include <tuple>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/csv.h"
#include "core/program.h"
#include "core/rig_table.h"
#include "core/sha256.h"
#include "gap/library/rig.h"

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

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string quoted(const std::string& word) {
  const char* const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=+:,-%@";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word);
  return text;
}

// Held by one process at a time and by the runs that it starts, which go on where it is killed: whoever calls again
// waits for their end.
class RunLock {
 public:
  explicit RunLock(const std::string& run)
      : file_(::open((run + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ < 0) throw std::runtime_error(fmt::format("{}.lock: cannot be written; check the folder", run));
    while (flock(file_, LOCK_EX) == -1 && errno == EINTR) {
    }
  }
  ~RunLock() { ::close(file_); }
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  int file() const { return file_; }

 private:
  int file_;
};

bool contains(const std::string& file, const std::string& words) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.find(words) != std::string::npos) return true;
  return false;
}

bool is_done(const PlannedRun& run) { return fs::exists(fs::path(run.run) / "post" / "observations.csv"); }

// The run and its rows, what is there of it taken up. True if both ended well.
bool complete(const PlannedRun& run) {
  const RunLock lock(run.run);
  if (is_done(run)) return true;  // by another process meanwhile
  const std::string partial = run.run + ".partial", log = run.run + ".out";
  const ProgramPlace place{run.folder, log, lock.file()};
  fs::remove(log);
  if (!run.command.empty() && !fs::exists(fs::path(run.run) / "run.json")) {
    if (!run.resumes) fs::remove_all(partial);
    std::vector<std::string> command = run.command;
    if (fs::exists(partial)) command.insert(command.end(), {"-var", "resume", "yes"});
    bool well = run_program(command, place) == 0;
    // killed before its first restart was whole: there is nothing to take up
    if (!well && fs::exists(partial) && contains(log, "cannot resume")) {
      fs::remove(log);
      fs::remove_all(partial);
      well = run_program(run.command, place) == 0;
    }
    if (!well) return false;
  }
  return run.post.empty() || run_program(run.post, place) == 0;
}

// -var of the library's own runs of a rig: what its plan says.
std::map<std::string, std::string> library_settings(const std::string& folder, const std::string& rig,
                                                    std::vector<std::string>& notes) {
  std::map<std::string, std::string> settings;
  const std::string path = (fs::path(folder) / "plan.toml").string();
  if (!fs::exists(path)) {
    notes.push_back(
        fmt::format("the library has no plan.toml that says how its runs of {} were set: they are made as the rig "
                    "stands, with --var",
                    rig));
    return settings;
  }
  const TomlTable plan = TomlTable::read(path);
  if (const toml::array* rigs = plan.raw()["rig"].as_array())
    for (const toml::node& node : *rigs) {
      if (!node.is_table()) continue;
      const TomlTable t(path, *node.as_table());
      if (t.text("name") != rig || !t.has("settings")) continue;
      const TomlTable own = t.table("settings");
      for (const auto& entry : own.raw())
        settings[std::string(entry.first.str())] = own.text(std::string(entry.first.str()));
    }
  return settings;
}

// What a command simulates: without the folder, and without the taking up of a run that was broken off.
std::string simulated_by(const std::string& command) {
  static const std::regex place(" -var (run|resume) [^ ]+");
  return std::regex_replace(command, place, "");
}

VariantSettings settings_of(Variant variant, const ModelEvidence* m, const Question& question) {
  VariantSettings v;
  v.variant = variant;
  if (m) {
    v.effects = m->effects;
    v.strengths = medians(*m);
  }
  if (variant != Variant::before && question.fit.family_weights.size() > 0)
    v.parameters = recalibrated_parameters(question.fit, v.effects, v.strengths);
  for (const auto& [effect, strength] : question.options.emulator.known) {
    v.effects.push_back(effect);
    v.strengths.push_back(strength);
  }
  return v;
}

void add_variants(const Question& question, const Diagnosis& d, const Isolability& isolability, Plan& plan) {
  plan.variants = {settings_of(Variant::before, nullptr, question),
                   settings_of(Variant::recalibrated, nullptr, question)};
  const auto applied = d.applied();
  if (applied.empty()) return;
  const std::string name = applied.size() == 2 ? applied[0] + "+" + applied[1] : applied[0];
  plan.variants.push_back(settings_of(Variant::after, d.model(name), question));
  if (const ModelEvidence* placebo = placebo_of(d, isolability)) {
    plan.variants.push_back(settings_of(Variant::placebo, placebo, question));
    plan.placebo = placebo->name();
  }
}

bool is_simulated(const Observation& row) { return row.role == Role::check && find_rig(row.apparatus); }

std::map<std::string, std::string> settings_asked(const std::vector<std::string>& texts) {
  std::map<std::string, std::string> asked;
  for (const std::string& setting : texts) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw BadInput("--var " + setting, 0, "is no setting", "write --var NAME=VALUE");
    asked[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  return asked;
}

std::string place_of(const std::string& runs) {
  const std::string place = fs::absolute(runs).lexically_normal().string();
  if (place.find_first_of(" \t\n$") != std::string::npos)
    throw BadInput(place, 0, "has a blank or a $ in it, at which LIGGGHTS would split it",
                   "state --runs FOLDER elsewhere");
  return place;
}

// A rig of the check tests and the settings of all its runs.
struct CheckRig {
  Rig rig;
  std::map<std::string, std::string> settings;
};

using CheckRigs = std::map<std::string, CheckRig>;

void check_settings(const std::map<std::string, std::string>& asked, const CheckRigs& rigs) {
  for (const auto& [name, value] : asked) {
    bool is_known = false;
    for (const auto& [apparatus, check] : rigs) {
      is_known = is_known || check.rig.known.count(name);
      if (check.rig.base.count(name) && !finite_number(value))
        throw BadInput(fmt::format("--var {}={}", name, value), 0,
                       fmt::format("is no number, as in.{} has it", apparatus), "state one");
    }
    if (!is_known)
      throw BadInput(fmt::format("--var {}={}", name, value), 0, "is no parameter of the check tests' rigs",
                     "see cases/*/*.par and materials/*.par");
  }
}

CheckRigs rigs_of(const ConfirmationRequest& request, const Question& question, std::vector<std::string>& notes) {
  const std::map<std::string, std::string> asked = settings_asked(request.settings);
  CheckRigs rigs;
  for (const Observation& row : question.model.rows) {
    if (!is_simulated(row) || rigs.count(row.apparatus)) continue;
    CheckRig& check = rigs[row.apparatus];
    check.rig = Rig::read(row.apparatus, request.root);
    check.settings = library_settings(question.inputs.library.folder, row.apparatus, notes);
    for (const auto& [name, value] : asked)
      if (check.rig.known.count(name)) check.settings[name] = value;
  }
  check_settings(asked, rigs);
  return rigs;
}

// A condition of the row as the effects of the variant shift it.
double shifted(double value, const NamedCondition& condition, const Observation& row, const VariantSettings& v,
               const Inputs& inputs) {
  for (std::size_t e = 0; e < v.effects.size(); ++e)
    for (const Transform& t : effect_named(inputs, v.effects[e]).transforms)
      if (t.operation == Operation::shift && t.condition == condition.name && t.apparatus == row.apparatus)
        value *= 1 + t.factor * v.strengths[e];
  return value;
}

void check_switch(const Effect& effect, double strength, const std::map<std::string, double>& known) {
  if (known.count(effect.name) && strength != 1)
    throw BadInput("--known " + effect.name, 0, "is a switch: a run has it wholly or not",
                   "state strength 1, or leave it a candidate");
}

// -var of the settings, the family's parameters and the effects, in that order: each starts from those before it. Sets
// the share of a switched effect.
std::map<std::string, std::string> changed_settings(const CheckRig& check, const VariantSettings& v,
                                                    const Question& question, PlannedRun& run) {
  const Inputs& inputs = question.inputs;
  std::map<std::string, double> base = check.rig.base;
  std::map<std::string, std::string> changed = check.settings;
  for (const auto& [name, value] : check.settings)
    if (const auto number = finite_number(value)) base[name] = *number;
  for (Index k = 0; k < v.parameters.size(); ++k) {
    const std::string& name = inputs.library.parameter_names[static_cast<std::size_t>(k)];
    base[name] = v.parameters[k];
    changed[name] = fmt::format("{:.9g}", v.parameters[k]);
  }
  const auto& known = question.options.emulator.known;
  for (std::size_t e = 0; e < v.effects.size(); ++e) {
    if (v.strengths[e] == 0) continue;
    const Effect& effect = effect_named(inputs, v.effects[e]);
    for (const auto& [name, value] : check.rig.settings(effect, v.strengths[e], base)) {
      changed[name] = value;
      if (const auto number = finite_number(value)) base[name] = *number;
    }
    for (const VarChange& change : effect.vars) {
      if (!change.acts_on(run.apparatus) || change.rule != VarRule::switched) continue;
      check_switch(effect, v.strengths[e], known);
      if (known.count(effect.name) == 0) run.share = v.strengths[e];
    }
  }
  return changed;
}

PlannedRun planned_run(const Observation& row, const VariantSettings& v, int seed, const CheckRig& check,
                       const std::string& place, const Question& question) {
  const Rig& rig = check.rig;
  PlannedRun run;
  run.variant = v.variant;
  run.tests = {row.test};
  run.apparatus = row.apparatus;
  run.seed = seed;
  run.folder = rig.folder;
  run.files = rig.files;
  run.resumes = rig.known.count("resume") > 0;
  run.run = (fs::path(place) / fmt::format("{}-{}-s{}", file_name_of(row.test), text_of(v.variant), seed)).string();
  run.command = {"liggghts", "-in", rig.script};
  const auto var = [&](const std::string& name, const std::string& value) {
    run.command.insert(run.command.end(), {"-var", name, value});
  };
  for (const NamedCondition& c : kConditions) {
    const auto name = rig.vars.find(c.name);
    if (name == rig.vars.end() || !(row.*c.member)) continue;
    var(name->second, fmt::format("{:.9g}", shifted(*(row.*c.member), c, row, v, question.inputs)));
  }
  for (const auto& [name, value] : changed_settings(check, v, question, run)) var(name, value);
  var("seed", fmt::format("{}", seed));
  var("run", run.run);
  if (!rig.post.empty()) {
    run.post = words_of(rig.post);
    run.post.push_back(run.run);
  }
  return run;
}

}  // namespace

Plan plan_confirmation(const ConfirmationRequest& request, const Question& question, const Diagnosis& d,
                       const Isolability& isolability, std::vector<std::string>& notes) {
  Plan plan;
  add_variants(question, d, isolability, plan);
  const std::string place = place_of(request.runs);
  const CheckRigs rigs = rigs_of(request, question, notes);
  std::set<std::string> done;
  std::map<std::string, std::string> alike;  // conditions -> the test whose runs serve all of these
  for (const Observation& row : question.model.rows) {
    if (!is_simulated(row) || !done.insert(row.test).second) continue;
    const std::string first = alike.emplace(row.apparatus + " " + conditions_text(row), row.test).first->second;
    if (first != row.test) {
      for (PlannedRun& run : plan.runs)
        if (run.tests.front() == first) run.tests.push_back(row.test);
      continue;
    }
    for (const VariantSettings& v : plan.variants)
      for (int seed = 1; seed <= request.seeds; ++seed)
        plan.runs.push_back(planned_run(row, v, seed, rigs.at(row.apparatus), place, question));
  }
  return plan;
}

std::string file_name_of(const std::string& test) {
  std::string name = test;
  for (char& c : name)
    if (!(c >= '0' && c <= '9') && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && c != '.' && c != '_' &&
        c != '-')
      c = '_';
  if (name.front() == '.' || name.front() == '-') name.front() = '_';
  return name == test ? name : name + "-" + sha256_of_text(test).substr(0, 8);
}

std::string command_line(const PlannedRun& run) {
  return fmt::format("(cd {} && {}{})", quoted(run.folder), quoted(run.command),
                     run.post.empty() ? "" : " && " + quoted(run.post));
}

std::vector<std::string> stated_commands(const Plan& plan) {
  std::vector<std::string> commands;
  for (const PlannedRun& run : plan.runs) {
    std::vector<std::string> words = run.command;
    std::replace(words.begin(), words.end(), run.run, fs::relative(run.run, run.folder).string());
    commands.push_back(fmt::format("{}", fmt::join(words, " ")));
  }
  return commands;
}

std::string liggghts_version(const Plan& plan) {
  const fs::path description = fs::path(plan.runs.front().run) / "run.json";
  if (!fs::exists(description)) return "";
  return read_json(description.string()).value(nlohmann::json::json_pointer("/versions/liggghts"), std::string());
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
  std::vector<PlannedRun> missing;
  for (const PlannedRun& run : plan.runs) {
    if (is_done(run)) continue;
    fs::create_directories(fs::path(run.run).parent_path());
    missing.push_back(run);
  }
  std::mutex lock;
  std::size_t next = 0;
  std::string failed;
  const auto work = [&] {
    for (;;) {
      PlannedRun run;
      {
        const std::lock_guard<std::mutex> guard(lock);
        if (next == missing.size() || !failed.empty()) return;
        run = missing[next++];
        fmt::print("{} of {}: {}\n", next, missing.size(), command_line(run));
        std::fflush(stdout);
      }
      std::string fault;
      try {
        if (!complete(run)) fault = fmt::format("a run failed, see {}.out: {}", run.run, command_line(run));
      } catch (const std::exception& e) {
        fault = e.what();
      }
      const std::lock_guard<std::mutex> guard(lock);
      if (failed.empty()) failed = fault;
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < jobs; ++k) workers.emplace_back(work);
  for (std::thread& w : workers) w.join();
  if (!failed.empty()) throw std::runtime_error(failed);
}

namespace {

// What the runs show: by variant, test and observable values and their own standard uncertainties.
class Shown {
 public:
  explicit Shown(const Plan& plan) {
    for (const PlannedRun& run : plan.runs) {
      const std::string path = (fs::path(run.run) / "post" / "observations.csv").string();
      if (!fs::exists(path)) throw BadInput(path, 0, "is not there", "run: " + command_line(run));
      for (const Observation& row : read_reduced_table(path).rows)
        for (const std::string& test : run.tests)
          values_[{run.variant, test, row.observable}].emplace_back(row.value, row.u);
      for (const std::string& test : run.tests) share_[{run.variant, test}] = run.share;
    }
  }

  double share(Variant variant, const std::string& test) const { return share_.at({variant, test}); }

  // Mean over the seeds and its variance: what the run itself says, what seeds of the library scatter by, and what
  // these seeds do, whichever is largest.
  std::pair<double, double> mean(Variant variant, const Observation& row, double scatter) const {
    const auto found = values_.find({variant, row.test, row.observable});
    if (found == values_.end())
      throw BadInput("runs of " + text_of(variant), 0, fmt::format("test '{}' shows no {}", row.test, row.observable),
                     "the rig must write it to post/observations.csv");
    const double k = static_cast<double>(found->second.size());
    double sum = 0, own = 0, squares = 0;
    for (const auto& [value, u] : found->second) sum += value / k, own += u * u / k;
    for (const auto& [value, u] : found->second) squares += std::pow(value - sum, 2);
    return {sum, std::max({own, scatter, k > 1 ? squares / (k - 1) : 0.0}) / k};
  }

 private:
  std::map<std::tuple<Variant, std::string, std::string>, std::vector<std::pair<double, double>>> values_;
  std::map<std::pair<Variant, std::string>, double> share_;
};

// A value and its variance with the measurement effects of the variant, which no run has.
void transform(const VariantSettings& v, const Observation& row, const Inputs& inputs, double& y, double& variance) {
  for (std::size_t e = 0; e < v.effects.size(); ++e) {
    const Transform* t = effect_named(inputs, v.effects[e]).transform_of(row.apparatus, row.observable);
    if (!t || t->operation == Operation::shift) continue;
    const Reading reading = t->reading(row, y, v.strengths[e]);
    y = reading.value;
    variance *= reading.slope * reading.slope;
  }
}

}  // namespace

Shrink measured_shrink(const Plan& plan, const Question& question) {
  const Shown shown(plan);
  const TableModel& model = question.model;
  const TableModel plain = question.simulated();
  const VectorXd seed_variance = plain.seed.diagonal();
  std::vector<Index> at;
  CheckRows check;
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    if (is_simulated(model.rows[i])) {
      at.push_back(static_cast<Index>(i));
      check.tests.push_back(model.rows[i].test);
    }
  check.observed = model.observed(at);
  check.noise = model.noise(at, at);
  const Index n = static_cast<Index>(at.size());
  std::map<Variant, SimulatedRows> simulated;
  for (const VariantSettings& v : plan.variants) {
    SimulatedRows s{VectorXd(n), VectorXd(n)};
    for (Index i = 0; i < n; ++i) {
      const Observation& row = model.rows[static_cast<std::size_t>(at[i])];
      auto [y, variance] = shown.mean(v.variant, row, seed_variance[at[i]]);
      const double part = shown.share(v.variant, row.test);
      if (part != 1) {
        const auto [without, its] = shown.mean(Variant::recalibrated, row, seed_variance[at[i]]);
        y = part * y + (1 - part) * without;
        variance = part * part * variance + (1 - part) * (1 - part) * its;
      }
      transform(v, row, question.inputs, y, variance);
      const double off =
          question.reference && model.relative[at[i]] > 0 ? model.baseline[at[i]] / plain.baseline[at[i]] : 1;
      s.value[i] = y * off;
      s.u[i] = std::sqrt(variance) * off;
    }
    simulated[v.variant] = s;
  }
  const SimulatedRows& recalibrated = simulated.at(Variant::recalibrated);
  const auto of = [&](Variant variant) { return simulated.count(variant) ? simulated.at(variant) : recalibrated; };
  Shrink s = shrink_of(check, simulated.at(Variant::before), recalibrated, of(Variant::after), of(Variant::placebo));
  s.placebo_name = plan.placebo;
  for (Index i = 0; i < n; ++i) {
    const Observation& row = model.rows[static_cast<std::size_t>(at[static_cast<std::size_t>(i)])];
    SimulatedAgain again{row.test, row.observable, {}};
    for (const Variant variant : {Variant::before, Variant::recalibrated, Variant::after})
      if (const auto found = simulated.find(variant); found != simulated.end())
        again.values.push_back({variant, found->second.value[i], found->second.u[i]});
    s.runs.push_back(std::move(again));
  }
  return s;
}

}  // namespace vielto::gap

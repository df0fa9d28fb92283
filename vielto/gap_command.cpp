// SPDX-License-Identifier: GPL-2.0-or-later
// vielto gap {isolability, programme, diagnose, next, confirm, predict, discrepancy, plan, collect}: where the
// simulation departs from a measurement, why, how far.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "core/csv.h"
#include "core/data_folder.h"
#include "core/rig_table.h"
#include "core/seal.h"
#include "gap/library/library_plan.h"
#include "gap/question/answer.h"
#include "gap/question/confirm.h"
#include "gap/question/next_question.h"
#include "gap/question/programme.h"
#include "gap/question/question.h"
#include "gap/question/sealed.h"
#include "gap/question/simulated.h"
#include "report/diagnosis_page.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;
using namespace vielto::gap;
using json = nlohmann::ordered_json;

struct GapOptions {
  InputFiles files;
  std::string table, out, candidates, sealed, root = ".", runs;
  std::string apparatus = "mixer", observable = "power";
  std::map<std::string, std::vector<double>> conditions;
  std::string reference;
  std::vector<std::string> tables, ignored, only, reference_only, without, known, vars;
  double runs_per_observation = 1, transfer = 0;
  bool change_only = false;
  std::uint64_t seed = 1;
  int seeds = 1, draws = 0, jobs = 1;
  bool extrapolate = false, no_discrepancy = false, run = false;

  EmulatorOptions emulator() const {
    EmulatorOptions o;
    o.ignored = {ignored.begin(), ignored.end()};
    o.extrapolate = extrapolate;
    o.runs_per_observation = runs_per_observation;
    o.use_discrepancy = !no_discrepancy;
    o.known = known_effects(known, without);
    return o;
  }
  QuestionOptions question() const {
    return {files, table, only, without, reference, reference_only, transfer, emulator(), seed, draws};
  }
  AnswerOptions answer() const { return {question(), sealed, candidate_file(), change_only}; }
  std::string candidate_file() const {
    return candidates.empty() ? (fs::path(files.completed().settings).parent_path() / "next_tests.toml").string()
                              : candidates;
  }
};

const std::vector<const char*> kAnswerFiles = {"diagnosis.json", "diagnosis.html"};

fs::path make_out(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw BadInput(folder, 0, "cannot be made", "state a folder that can be written with --out");
  return folder;
}

// Said before the work begins, and nothing is made yet.
void check_out(const std::string& folder, const std::vector<const char*>& names) {
  if (folder.empty()) return;
  fs::path there = fs::absolute(folder).lexically_normal();
  while (!fs::exists(there) && there.has_parent_path() && there != there.parent_path()) there = there.parent_path();
  if (!fs::is_directory(there)) throw BadInput(there.string(), 0, "is no folder", "state a folder with --out");
  if (access(there.c_str(), W_OK) != 0)
    throw BadInput(there.string(), 0, "cannot be written", "state another folder with --out");
  for (const char* name : names)
    if (fs::is_directory(fs::path(folder) / name))
      throw BadInput((fs::path(folder) / name).string(), 0, "is a folder, where a file is to be written",
                     "move it away");
}

void run_isolability(const GapOptions& o) {
  check_out(o.out, {"isolability.json", "isolability.json.sha256", "isolability.csv", "isolability.svg"});
  const Question q(o.question());
  const Isolability i = isolability(q.before_data(), q.inputs.settings);
  const json j = isolability_json(q, i, q.threshold());
  if (!o.out.empty()) {
    const fs::path out = make_out(o.out);
    write_answer_file((out / "isolability.json").string(), j);
    seal((out / "isolability.json").string());
    write_whole_file((out / "isolability.csv").string(), isolability_csv(i));
    write_whole_file((out / "isolability.svg").string(), isolability_svg(i));
  }
  fmt::print("{:<18}{:>12}{:>12}{:>14}{:>12}  not told apart at its farthest from\n", "effect", "farthest at", "sd",
             "detectable", "isolable");
  const auto from = [](double s) { return std::isnan(s) ? std::string("never") : fmt::format("from {:.3g}", s); };
  for (const std::string& e : i.effects) {
    const double s = i.farthest(e);
    std::vector<std::string> others = i.group_of(e, s);
    others.erase(others.begin());
    fmt::print("{:<18}{:>12.3g}{:>12.1f}{:>14}{:>12}  {}\n", e, s, i.from_nothing(e, s), from(i.detectable_from(e)),
               from(i.isolable_from(e)), others.empty() ? "-" : fmt::format("{}", fmt::join(others, ", ")));
  }
  for (const std::string& note : q.model.notes) fmt::print("note: {}\n", note);
}

void run_programme(const GapOptions& o) {
  const Question q(o.question());
  std::vector<std::string> notes = q.model.notes;
  const std::vector<ProgrammeStep> steps = programme(q, o.candidate_file(), notes);
  if (!o.out.empty()) write_whole_file(o.out, programme_csv(steps));
  fmt::print("{:<24}{:>7}{:>10}{:>12}  effects detectable from here on\n", "test", "hours", "so far", "told apart");
  for (const ProgrammeStep& s : steps)
    fmt::print("{:<24}{:>7.1f}{:>10.1f}{:>12}  {}\n", s.test, s.hours, s.all_hours,
               fmt::format("{} of {}", s.told, s.possible),
               s.detectable.empty() ? "-" : fmt::format("{}", fmt::join(s.detectable, ", ")));
  for (const std::string& note : notes) fmt::print("note: {}\n", note);
}

std::string title_of(const GapOptions& o) {
  return "Gap between simulation and measurement: " + fs::path(o.table).filename().string();
}

json provenance_of(const GapOptions& o, const Question& q) {
  json p = q.provenance();
  p["options"]["sealed"] = !o.sealed.empty();
  p["options"]["var"] = o.vars;
  p["options"]["seeds_of_each_run"] = o.seeds;
  return p;
}

void write_answer(const GapOptions& o, const Question& q, const Diagnosis& d, const json& provenance) {
  const json j = answer_json(o.answer(), q, d, provenance);
  const fs::path out = make_out(o.out);
  const std::string page = diagnosis_page(j, title_of(o));
  write_answer_file((out / "diagnosis.json").string(), j);
  write_whole_file((out / "diagnosis.html").string(), page);
  fmt::print("{}\n", verdict_sentence(d));
  if (j.contains("why_it_is_off"))
    fmt::print("Without the reference: {}\n", j["why_it_is_off"]["sentence"].get<std::string>());
  for (const std::string& note : d.notes) fmt::print("note: {}\n", note);
}

void run_diagnose(const GapOptions& o) {
  check_out(o.out, kAnswerFiles);
  const Question q(o.question());
  const Isolability i = isolability(q.before_data(), q.inputs.settings);
  write_answer(o, q, answer(o.answer(), q, i), provenance_of(o, q));
}

void run_confirm(const GapOptions& o) {
  check_out(o.out, kAnswerFiles);
  const Question q(o.question());
  const auto simulable = [](const Observation& row) { return row.role == Role::check && find_rig(row.apparatus); };
  if (std::none_of(q.table.rows.begin(), q.table.rows.end(), simulable))
    throw BadInput(o.table, 0, "holds no row of role check that a rig can simulate",
                   fmt::format("mark held-out tests of {}: the shrink is measured on them", rig_names()));
  const Isolability i = isolability(q.before_data(), q.inputs.settings);
  Diagnosis d = answer(o.answer(), q, i);
  json provenance = provenance_of(o, q);
  if (d.verdict == Verdict::no_gap) {
    if (o.run)
      write_answer(o, q, d, provenance);
    else
      fmt::print("{}\nnothing to simulate: no gap is to be closed\n", verdict_sentence(d));
    return;
  }
  const std::string runs = o.runs.empty() ? (fs::path(o.out) / "runs").string() : o.runs;
  const Plan plan = plan_confirmation({o.root, runs, o.seeds, o.vars}, q, d, i, d.notes);
  provenance["commands"] = stated_commands(plan);
  if (!o.run) {
    for (const PlannedRun& run : plan.runs) fmt::print("{}\n", command_line(run));
    for (const std::string& note : d.notes) fmt::print(stderr, "note: {}\n", note);
    return;
  }
  refuse_other_runs(plan);
  // The prediction is on record before the runs begin.
  write_answer(o, q, d, provenance);
  run_plan(plan, o.jobs);
  d.shrink = measured_shrink(plan, q);
  provenance["liggghts"] = liggghts_version(plan);
  write_answer(o, q, d, provenance);
}

void run_next(const GapOptions& o) {
  const Question q(o.question());
  Diagnosis d = diagnose(q.model, threshold_of(o.answer(), q), q.inputs.settings);
  d.of_a_change = q.reference.has_value();
  d.next_tests = next_tests(q, d, o.candidate_file(), d.notes);
  fmt::print("{}\n{:<22}{:>7}{:>10}{:>10}{:>12}  separates\n", verdict_sentence(d), "test", "hours", "sd now",
             "sd then", "sd an hour");
  for (const NextTest& t : d.next_tests)
    fmt::print("{:<22}{:>7.1f}{:>10.2f}{:>10.2f}{:>12.2f}  {}\n", t.name, t.hours, t.separation_now, t.separation,
               t.gain_per_hour, t.separates);
  for (const std::string& note : d.notes) fmt::print("note: {}\n", note);
}

void run_predict(const GapOptions& o) {
  const Inputs inputs(o.files);
  const auto [values, outside, silent] =
      simulated_values(inputs, combinations(o.apparatus, o.observable, o.conditions), o.emulator());
  if (!o.out.empty()) write_whole_file(o.out, simulated_csv(values));
  fmt::print("{} of {} [{}], mean over seeds; k = 1, from {}\n", o.observable, o.apparatus, values[0].row.unit,
             fmt::join(kSimulatedParts, ", "));
  for (const SimulatedValue& v : values)
    fmt::print("{}{:.4g} ± {:.2g} (95 %: {:.4g} to {:.4g}); ± {:.2g}, {:.2g}, {:.2g}; on the card {:.4g}\n",
               conditions_text(v.row).empty() ? "" : conditions_text(v.row) + ": ", v.row.value, v.row.u, v.low95,
               v.high95, v.parts[0], v.parts[1], v.parts[2], v.card);
  for (const std::string& note : outside) fmt::print("OUTSIDE the library, {}\n", note);
  for (const std::string& note : silent) fmt::print("note: {}\n", note);
}

void run_discrepancy(const GapOptions& o) {
  const Inputs inputs(o.files);
  std::map<std::pair<std::string, std::string>, std::vector<LawDifference>> laws;
  for (const std::string& path : o.tables)
    for (auto& [name, difference] : inputs.emulator.differences(read_reduced_table(path), o.emulator()))
      laws[name].push_back(std::move(difference));
  std::vector<DiscrepancyEntry> entries;
  for (const auto& [name, differences] : laws)
    entries.push_back({name.first, name.second, estimate_discrepancy(differences)});
  write_discrepancies(o.out, entries);
}

LibraryPlan library_plan(const GapOptions& o) {
  if (!fs::is_regular_file(o.table))
    throw BadInput(o.table, 0, "is no file", "name a plan, such as libraries/millet/plan.toml");
  const InputFiles files =
      InputFiles{fs::path(o.table).parent_path().string(), o.files.effects, o.files.settings}.completed();
  return LibraryPlan::read(o.table, read_effects(files.effects, Settings::read(files.settings)), o.root);
}

void run_plan_command(const GapOptions& o) {
  const LibraryPlan plan = library_plan(o);
  write_study(plan, o.out);
  fmt::print("{}: {} runs\n", o.out, plan.runs.size());
}

void run_collect(const GapOptions& o) {
  const Collected c = collect_library(library_plan(o), o.runs, o.out);
  fmt::print("{}: {} runs\n", o.out, c.runs);
  if (!c.missing.empty()) fmt::print("not there yet: {}\n", fmt::join(c.missing, ", "));
}

// CLI11's own checks let nan through, and -1 as an unsigned number
CLI::Validator finite() {
  return CLI::Validator(
      [](const std::string& text) {
        return finite_number(text) ? std::string() : "'" + text + "' is no finite number";
      },
      "FINITE");
}

CLI::Validator condition() {
  return CLI::Validator(
      [](const std::string& text) {
        return condition_member(text) || text == "wall" || text == "material"
                   ? std::string()
                   : fmt::format("'{}' is no condition; name moisture, tilt, wall, material ...", text);
      },
      "CONDITION");
}

using Options = std::shared_ptr<GapOptions>;

void add_library_options(CLI::App* c, const Options& o) {
  add_rigs_option(c);
  c->add_option("--library", o->files.library,
                "response library: a folder, or the name of one that came with vielto (millet, wheat, mcc)")
      ->required()
      ->transform([](const std::string& given) { return named_in("libraries", given); });
  c->add_option("--effects", o->files.effects, "folder of effect files; without it effects/ beside the library");
  c->add_option("--settings", o->files.settings, "without it diagnosis.toml beside the library");
  c->add_option("--ignore", o->ignored, "conditions that need not agree with the library, such as moisture,wall")
      ->delimiter(',')
      ->check(condition());
  c->add_flag("--extrapolate", o->extrapolate, "outside the library's conditions: flagged, not refused");
}

void add_question_options(CLI::App* c, const Options& o) {
  c->add_option("TABLE", o->table, "observation table")->required();
  add_library_options(c, o);
  c->add_option("--only", o->only, "rows that satisfy this only, such as wall=B (repeatable)");
  CLI::Option* reference =
      c->add_option("--reference", o->reference,
                    "observation table of the same machine where the model is validated: what has changed since?");
  c->add_option("--reference-only", o->reference_only, "rows of the reference, as --only (repeatable)")
      ->needs(reference);
  c->add_option("--transfer", o->transfer,
                "part of what calibration and contact law leave open that may have changed too (a machine rebuilt)")
      ->needs(reference)
      ->check(finite() & CLI::Range(0.0, 10.0))
      ->capture_default_str();
  c->add_option("--without", o->without, "effects that are no candidates")->delimiter(',');
  c->add_option("--known", o->known,
                "EFFECT=STRENGTH that the apparatus surely has: part of the baseline, no candidate (repeatable)");
  c->add_option("--runs-per-observation", o->runs_per_observation,
                "how many independent runs an observed value is the mean of; 0: u holds their scatter already")
      ->check(finite() & CLI::NonNegativeNumber)
      ->capture_default_str();
  c->add_flag("--no-discrepancy", o->no_discrepancy, "leave the law discrepancy out (more false alarms)");
  c->add_option("--seed", o->seed, "of the bootstrap")->check(CLI::NonNegativeNumber)->capture_default_str();
  c->add_option("--draws", o->draws, "of the bootstrap; without it those of the settings")->check(CLI::PositiveNumber);
}

void add_candidates_option(CLI::App* c, const Options& o) {
  c->add_option("--candidates", o->candidates, "candidate tests; without it next_tests.toml beside the settings");
}

void add_answer_options(CLI::App* c, const Options& o) {
  c->add_option("--sealed", o->sealed, "isolability.json, sealed before the data: its threshold is taken");
  add_candidates_option(c, o);
}

void add_isolability(CLI::App* gap, const Options& o) {
  CLI::App* c =
      gap->add_subcommand("isolability",
                          "before any data: which effects these tests can tell apart\n"
                          "The table's conditions and u count, its values do not. Writes isolability.json (sealed), "
                          ".csv and .svg.");
  add_question_options(c, o);
  c->add_option("--out", o->out, "folder for the answer");
  c->callback([o] { run_isolability(*o); });
}

void add_programme(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand("programme",
                                    "before any data: which tests to add to these, best first for an hour of work\n"
                                    "Told apart: effects from nothing and from one another. Example: vielto gap "
                                    "programme planned.csv --library millet");
  add_question_options(c, o);
  add_candidates_option(c, o);
  c->add_option("--out", o->out, "table to write (CSV)");
  c->callback([o] { run_programme(*o); });
}

void add_diagnose(CLI::App* gap, const Options& o) {
  CLI::App* c =
      gap->add_subcommand("diagnose",
                          "what explains the gap: diagnosis.json and diagnosis.html\n"
                          "Example: vielto gap diagnose measured.csv --library libraries/millet --out answer");
  add_question_options(c, o);
  add_answer_options(c, o);
  c->add_flag("--change-only", o->change_only,
              "with a reference: what has changed, not besides why the simulation is off by itself")
      ->needs("--reference");
  c->add_option("--out", o->out, "folder for the answer")->required();
  c->callback([o] { run_diagnose(*o); });
}

void add_confirm(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand(
      "confirm",
      "the check tests simulated again with the effect: prints the commands, or runs them (--run) and resumes");
  add_question_options(c, o);
  add_answer_options(c, o);
  c->add_option("--out", o->out, "folder for the answer")->required();
  c->add_option("--root", o->root, "folder that holds cases/ and materials/")->capture_default_str();
  c->add_option("--runs", o->runs, "where the run folders go; without it OUT/runs");
  c->add_option("--seeds", o->seeds, "runs of each")->check(CLI::Range(1, 1000))->capture_default_str();
  c->add_option("--var", o->vars,
                "NAME=VALUE for all runs beside the library's own settings, such as turns=14 (repeatable)");
  c->add_option("--jobs", o->jobs, "runs at a time")->check(CLI::Range(1, 1000))->capture_default_str();
  c->add_flag("--run", o->run, "run them, then write the measured shrink");
  c->callback([o] { run_confirm(*o); });
}

void add_next(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand("next", "the next test that separates best per hour");
  add_question_options(c, o);
  add_answer_options(c, o);
  c->callback([o] { run_next(*o); });
}

void add_predict(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand(
      "predict",
      "what the calibrated simulation says under these conditions, without a run, and how sure it is\n"
      "Every combination of the conditions. Example: vielto gap predict --library libraries/millet --speed 0.5,1 "
      "--fill "
      "0.2");
  add_library_options(c, o);
  c->add_option("--apparatus", o->apparatus, rig_names())->capture_default_str();
  c->add_option("--observable", o->observable, "of the apparatus, as `vielto rigs` lists them")->capture_default_str();
  for (const NamedCondition& at : kConditions) {
    std::string option = std::string("--") + at.name;
    std::replace(option.begin(), option.end(), '_', '-');
    c->add_option(option, o->conditions[at.name], "values, by commas")->delimiter(',')->check(finite());
  }
  c->add_option("--known", o->known, "EFFECT=STRENGTH that the apparatus surely has (repeatable)");
  c->add_flag("--no-discrepancy", o->no_discrepancy, "leave the law discrepancy out");
  c->add_option("--out", o->out, "table to write (CSV)");
  c->callback([o] { run_predict(*o); });
}

void add_discrepancy(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand(
      "discrepancy", "law discrepancy from development laws: one observation table a law, runs without an effect");
  add_library_options(c, o);
  c->add_option("TABLE", o->tables, "observation tables, one for each law")->required();
  c->add_option("--out", o->out, "discrepancy.csv to write")->required();
  c->callback([o] { run_discrepancy(*o); });
}

void add_plan_options(CLI::App* c, const Options& o) {
  c->add_option("PLAN", o->table, "plan of the library, such as libraries/millet/plan.toml")->required();
  c->add_option("--effects", o->files.effects, "folder of effect files; without it effects/ beside the plan's folder");
  c->add_option("--settings", o->files.settings, "without it diagnosis.toml beside the plan's folder");
  add_rigs_option(c);
  c->add_option("--root", o->root, "folder that holds cases/ and materials/")->capture_default_str();
}

void add_plan(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand("plan",
                                    "the runs of a response library as a study for scripts/campaign\n"
                                    "Example: vielto gap plan libraries/millet/plan.toml --out studies/library.csv");
  add_plan_options(c, o);
  c->add_option("--out", o->out, "study table to write")->required();
  c->callback([o] { run_plan_command(*o); });
}

void add_collect(CLI::App* gap, const Options& o) {
  CLI::App* c = gap->add_subcommand(
      "collect",
      "makes the response library of the runs that are done, with the hashes of what they were made from\n"
      "Example: vielto gap collect libraries/millet/plan.toml results/studies/library --out libraries/millet");
  add_plan_options(c, o);
  c->add_option("RESULTS", o->runs, "the campaign's folder")->required();
  c->add_option("--out", o->out, "folder of the library")->required();
  c->callback([o] { run_collect(*o); });
}

}  // namespace

void add_gap_command(CLI::App& app) {
  const auto o = std::make_shared<GapOptions>();
  CLI::App* gap =
      app.add_subcommand("gap", "why simulation and measurement disagree: which effect, where, how far it closes");
  gap->require_subcommand(1);
  for (const auto add : {add_isolability, add_programme, add_diagnose, add_confirm, add_next, add_predict,
                         add_discrepancy, add_plan, add_collect})
    add(gap, o);
}

}  // namespace vielto

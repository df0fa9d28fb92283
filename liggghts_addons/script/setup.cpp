// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/setup.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/par_range.h"
#include "core/program.h"
#include "core/sha256.h"
#include "engine/law.h"
#include "script/command_line.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

// The k-th prime number over 10000, as LIGGGHTS wants its seeds.
int prime(int k) {
  int candidate = 10000;
  for (int found = 0; found < k;) {
    bool is_prime = ++candidate > 1;
    for (int d = 2; d * d <= candidate && is_prime; d++) is_prime = candidate % d != 0;
    found += is_prime;
  }
  return candidate;
}

// What `variable NAME index VALUE` lines of a mesh's geometry.par say, in their order: derived numbers first.
std::map<std::string, std::string> derived_numbers(const std::string& geometry_par) {
  std::map<std::string, std::string> numbers;
  std::ifstream in(geometry_par);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string keyword, name, style, value;
    if (words >> keyword >> name >> style >> value && keyword == "variable") numbers.emplace(name, value);
  }
  return numbers;
}

}  // namespace

void RunSetup::run(int ranks, const char* liggghts) {
  read();
  const RunFolder folder(parameters_.value("run"));
  const std::map<std::string, std::string> now = present();
  std::string restart;
  const bool resuming = parameters_.has("resume") && parameters_.value("resume") == "yes";
  if (resuming)
    restart = folder.resume(now);
  else if (parameters_.has("bed") && parameters_.value("bed") != "none")
    restart = RunFolder::bed(parameters_.value("bed"), now, {apart_.begin(), apart_.end()});
  set("work", folder.partial());
  set("provisional", parameters_.provisional() ? "1" : "0");
  set("resuming", resuming ? "1" : "0");
  set("restarting", restart.empty() ? "0" : "1");
  set("restartFile", restart.empty() ? "none" : restart);
  if (parameters_.has("seed"))
    for (int k = 1; k <= 9; k++)
      set("seed" + std::to_string(k), std::to_string(prime(10 * std::stoi(parameters_.value("seed")) - 9 + k)));
  if (!resuming) {
    folder.open({{"command", command_line()},
                 {"ranks", ranks},
                 {"versions", {{"vielto", VIELTO_VERSION}, {"liggghts", liggghts}}},
                 {"parameters", now},
                 {"hashes", hashes(script_on_command_line(), now)}});
    try {
      make_mesh(folder.partial() + "/mesh");
      if (std::ifstream inputs(folder.partial() + "/mesh/inputs.json"); inputs)
        folder.add_hashes(nlohmann::json::parse(inputs));
    } catch (...) {  // nothing has been run in it
      fs::remove_all(folder.partial());
      throw;
    }
  }
  parameters_.check_values(derived_numbers(folder.partial() + "/mesh/geometry.par"));
  log_ = "log " + folder.partial() + "/log.liggghts" + (resuming ? " append" : "");
}

// Parameter files, settings NAME=VALUE, conditions and the names that a bed may differ in; then cards and checks.
void RunSetup::read() {
  if (const std::string several = several_values_on_command_line(); !several.empty())
    throw std::runtime_error("-var " + several + " has several values; give one, without blanks");
  std::size_t i = 0;
  const auto is_keyword = [](const std::string& word) { return word == "when" || word == "bed"; };
  for (; i < words_.size() && !is_keyword(words_[i]) && words_[i].find('=') == std::string::npos; i++)
    parameters_.read(words_[i]);
  // of all laws: `vielto law` refuses one of another law, and holds them in their ranges
  for (const Law& law : laws())
    for (const LawParameter& p : law.parameters) {
      Parameter stated;
      stated.name = p.rule.name;
      stated.value = p.value;
      stated.range = "-";
      parameters_.add(stated, law.header);
    }
  std::vector<std::string> settings;
  std::vector<std::pair<std::string, std::string>> demands;  // NAME==VALUE and the parameter whose word asks for it
  std::string condition;
  for (bool holds = true; i < words_.size(); i++) {
    if (words_[i] == "when" && i + 2 < words_.size()) {
      condition = words_[i + 1];
      holds = parameters_.value(condition) == words_[i + 2];
      i += 2;
    } else if (words_[i] == "bed") {
      apart_.assign(words_.begin() + static_cast<std::ptrdiff_t>(i) + 1, words_.end());
      break;
    } else if (holds && words_[i].find("==") != std::string::npos) {
      demands.emplace_back(words_[i], condition);
    } else if (holds) {
      settings.push_back(words_[i]);
    }
  }
  for (const std::string& setting : settings) give(setting);
  parameters_.read_cards();
  parameters_.check_names(names_on_command_line());
  parameters_.check_values();
  for (const auto& [demand, of] : demands) check_demand(demand, of);
  for (const auto& v : parameters_.all()) {
    if (v.stated.name != "run") continue;
    const std::string& run = v.now;
    if (run.empty()) throw std::runtime_error("run has no name; name the run folder with -var run");
    if (run.find_first_of(" \t'\"$#&*") != std::string::npos)
      throw std::runtime_error("run is '" + run +
                               "': LIGGGHTS reads no folder with blanks or any of '\"$#&* in its "
                               "name; name another with -var run");
  }
}

// NAME==VALUE: what a parameter has to be because `condition` is what it is.
void RunSetup::check_demand(const std::string& demand, const std::string& condition) const {
  const std::size_t equals = demand.find("==");
  const std::string name = demand.substr(0, equals), wanted = demand.substr(equals + 2);
  const std::string& now = parameters_.value(name);
  const std::optional<double> number = parameter_number(now);
  if (now == wanted || (number && number == parameter_number(wanted))) return;
  const std::string& word = parameters_.value(condition);
  std::string other = word;
  for (const auto& v : parameters_.all())
    if (v.stated.name == condition) {
      const ParRange range = ParRange::parse(v.stated.range);
      for (const std::string& choice : range.words())
        if (choice != word) other = choice;
    }
  throw std::runtime_error(name + " is " + now + "; " + condition + " " + word + " takes " + name + " " + wanted +
                           " only; leave it so, or take " + condition + " " + other);
}

// NAME=VALUE: of a parameter in the place of what the files say, of another name a variable of the script; {P} in
// VALUE is parameter P. A NAME that ends in File is an input.
void RunSetup::give(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::string name = setting.substr(0, equals);
  std::string value = setting.substr(std::min(equals, setting.size() - 1) + 1);
  for (std::size_t at; (at = value.find('{')) != std::string::npos;) {
    const std::size_t end = value.find('}', at);
    value.replace(at, end - at + 1, parameters_.value(value.substr(at + 1, end - at - 1)));
  }
  if (parameters_.has(name)) {
    parameters_.set(name, value);
    return;
  }
  if (name.size() > 4 && name.compare(name.size() - 4, 4, "File") == 0) {
    if (!fs::exists(value)) throw std::runtime_error("input file " + value + " is missing");
    files_.push_back(value);
  }
  extra_[name] = value;
}

// The present values of all parameters. Of other names too for the script's variables.
std::map<std::string, std::string> RunSetup::present() {
  std::map<std::string, std::string> now;
  for (const auto& v : parameters_.all()) {
    now[v.stated.name] = v.now;
    index.emplace_back(v.stated.name, v.now);
    const ParRange range = ParRange::parse(v.stated.range);
    for (const std::string& word : range.words()) set(v.stated.name + "_is_" + word, word == v.now ? "1" : "0");
  }
  for (const auto& [name, value] : extra_) set(name, value);
  return now;
}

nlohmann::json RunSetup::hashes(const std::string& script, std::map<std::string, std::string> values) {
  if (script.empty())
    throw std::runtime_error("the script's name is unknown, which run.json states; start LIGGGHTS with -in SCRIPT");
  values.insert(extra_.begin(), extra_.end());
  std::vector<std::string> files = script_files(script, values);
  files.insert(files.end(), parameters_.files().begin(), parameters_.files().end());
  files.insert(files.end(), files_.begin(), files_.end());
  nlohmann::json of;
  for (const std::string& file : files) of[fs::path(file).lexically_normal().string()] = sha256_of_file(file);
  return of;
}

// With the values of the rig's own file, which comes first, that were given.
void RunSetup::make_mesh(const std::string& folder) const {
  const std::string& rig = parameters_.files().front();
  std::vector<std::string> words = {"vielto", "geometry", rig, "--out", folder};
  for (const auto& v : parameters_.all())
    if (v.given && v.file == rig && v.stated.name != "rig") {
      words.push_back("--set");
      words.push_back(v.stated.name + "=" + v.now);
    }
  int status = run_program(words);
  if (status == -1) {  // called by its path our liggghts has it beside itself
    words.front() = (fs::read_symlink("/proc/self/exe").parent_path() / "vielto").string();
    status = run_program(words);
  }
  if (status == -1) throw std::runtime_error("no program 'vielto' is found; put the folder that holds it into PATH");
  if (status != 0) throw std::runtime_error("'vielto geometry' failed; its own line stands above");
}

}  // namespace vielto

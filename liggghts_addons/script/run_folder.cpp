// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "core/bad_input.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;
using Values = std::map<std::string, std::string>;

// Step in the name of a restart file, N.restart; -1 for another file.
long long step_of(const fs::path& file) {
  const std::string name = file.stem().string();
  if (file.extension() != ".restart" || name.empty() || name.find_first_not_of("0123456789") != std::string::npos)
    return -1;
  return atoll(name.c_str());
}

// Step of the last whole row of the record in a run folder (torque.csv, shear.csv); 0 if there is none.
long long last_step(const fs::path& partial) {
  std::ifstream in(partial / (fs::exists(partial / "shear.csv") ? "shear.csv" : "torque.csv"));
  long long step = 0;
  for (std::string line; std::getline(in, line) && !in.eof();)
    if (!line.empty() && line[0] >= '0' && line[0] <= '9') step = atoll(line.c_str());
  return step;
}

/* The last restart file that is surely whole: the run went on after it and wrote a row. One that was being written when
   the run was broken off is left alone. */
std::string newest_restart(const fs::path& partial) {
  const long long end = last_step(partial);
  fs::path newest;
  if (!fs::exists(partial / "restart")) return "";
  for (const auto& entry : fs::directory_iterator(partial / "restart"))
    if (step_of(entry.path()) < end && step_of(entry.path()) > step_of(newest)) newest = entry.path();
  return newest.string();
}

// A complete run keeps its last restart file.
void remove_older_restarts(const fs::path& partial) {
  std::vector<fs::path> files;
  if (!fs::exists(partial / "restart")) return;
  for (const auto& entry : fs::directory_iterator(partial / "restart"))
    if (step_of(entry.path()) >= 0) files.push_back(entry.path());
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return step_of(a) < step_of(b); });
  if (!files.empty()) files.pop_back();
  for (const fs::path& file : files) fs::remove(file);
}

void write_json(const fs::path& path, const nlohmann::json& content) {
  const fs::path partial = path.string() + ".partial";
  std::ofstream out(partial);
  out << content.dump(2) << '\n';
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{} cannot be written; check the space left", path.string()));
  fs::rename(partial, path);
}

// A process that runs in a folder holds this file locked until it ends, however it ends.
const char* const kInUse = "in_use";

void take(const fs::path& partial) {
  const int file = ::open((partial / kInUse).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) throw std::runtime_error(fmt::format("cannot write in {}; check its permissions", partial.string()));
  // a file system without locks refuses otherwise, and has to do without
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw std::runtime_error(fmt::format(
        "another run is at work in {}; wait for its end, or name another folder with -var run", partial.string()));
}

fs::path opened;  // by this process, anew

bool holds_results(const fs::path& partial) {
  for (const auto& entry : fs::recursive_directory_iterator(partial)) {
    const bool record = entry.path().extension() == ".csv" && entry.path().parent_path() == partial;
    if (record || entry.path().extension() == ".restart") return true;
  }
  return false;
}

// Throws if a run was made with other parameters than those that hold now.
void same_parameters(const nlohmann::json& run, const Values& now, const std::set<std::string>& apart) {
  for (const auto& [name, value] : run.at("parameters").items()) {
    const auto found = now.find(name);
    if (found != now.end() && !apart.count(name) && value.get<std::string>() != found->second)
      throw std::runtime_error(
          fmt::format("it was started with {} {}, not {}", name, value.get<std::string>(), found->second));
  }
}

// ${NAME} by its value; nothing left of a text with an unknown name.
std::string substituted(const std::string& text, const Values& values) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "${") != 0) {
      out += text[i++];
      continue;
    }
    const std::size_t end = text.find('}', i);
    const auto found = values.find(text.substr(i + 2, end - i - 2));
    if (end == std::string::npos || found == values.end()) return "";
    out += found->second;
    i = end + 1;
  }
  return out;
}

void add_files(const std::string& path, const Values& values, std::vector<std::string>& files) {
  if (std::find(files.begin(), files.end(), path) != files.end()) return;
  std::ifstream in(path);
  if (!in) throw BadInput(path, 0, "cannot be read", "name an existing file with include, or with -in");
  files.push_back(path);
  static const std::regex include("^\\s*(?:vielto\\s+)?include\\s+(\\S+)");
  std::smatch found;
  for (std::string line; std::getline(in, line);)
    if (std::regex_search(line, found, include))
      if (const std::string name = substituted(found[1], values); !name.empty()) add_files(name, values, files);
}

}  // namespace

void RunFolder::open(nlohmann::json run) const {
  if (fs::exists(folder_))
    throw std::runtime_error("the run folder " + folder_ +
                             " is there already; remove it or name another with -var run");
  std::error_code code;
  fs::create_directories(partial_, code);
  if (code) throw std::runtime_error("cannot make the run folder " + partial_ + "; check the path and its permissions");
  take(partial_);
  std::vector<fs::path> old;  // of a run that was broken off
  for (const auto& entry : fs::directory_iterator(partial_))
    if (entry.path().filename() != kInUse) old.push_back(entry.path());
  for (const fs::path& path : old) fs::remove_all(path);
  run["schema"] = 1;
  run["status"] = "running";
  write_json(fs::path(partial_) / "run.json", run);
  opened = partial_;
}

void RunFolder::add_hashes(const nlohmann::json& hashes) const {
  const fs::path path = fs::path(partial_) / "run.json";
  nlohmann::json run = nlohmann::json::parse(std::ifstream(path));
  run["hashes"].update(hashes);
  write_json(path, run);
}

void RunFolder::drop_opened() {
  if (opened.empty()) return;
  try {
    if (!holds_results(opened)) fs::remove_all(opened);
  } catch (const fs::filesystem_error&) {  // the refusal itself is what has to be told
  }
}

std::string RunFolder::resume(const Values& parameters) const {
  const fs::path partial = partial_;
  try {
    std::ifstream in(partial / "run.json");
    if (!in) throw std::runtime_error("it does not exist");
    take(partial);
    if (!fs::exists(partial / "mesh" / "geometry.par")) throw std::runtime_error("mesh/geometry.par is missing");
    same_parameters(nlohmann::json::parse(in), parameters, {"resume", "run"});
    const std::string newest = newest_restart(partial);
    if (newest.empty()) throw std::runtime_error("it was broken off before the first restart file was complete");
    return newest;
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("cannot resume {}: {}; start anew without -var resume", partial_, e.what()));
  }
}

std::string RunFolder::bed(const std::string& folder, const Values& parameters, std::set<std::string> apart) {
  try {
    std::ifstream in(fs::path(folder) / "run.json");
    if (!in) throw std::runtime_error("it is no complete run folder");
    apart.insert({"run", "resume", "bed"});
    same_parameters(nlohmann::json::parse(in), parameters, apart);
    const fs::path file = fs::path(folder) / "bed.restart";
    if (!fs::exists(file)) throw std::runtime_error("bed.restart is missing");
    return file.string();
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format(
        "cannot take the bed of {}: {}; name a run of the same bed with -var bed, or none", folder, e.what()));
  }
}

void RunFolder::close() const {
  try {
    std::ifstream in(fs::path(partial_) / "run.json");
    nlohmann::json run = nlohmann::json::parse(in);
    run["status"] = "complete";
    remove_older_restarts(partial_);
    write_json(fs::path(partial_) / "run.json", run);
    fs::remove(fs::path(partial_) / kInUse);
    fs::rename(partial_, folder_);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("cannot complete the run folder {}: {}", folder_, e.what()));
  }
}

std::vector<std::string> script_files(const std::string& script, const Values& values) {
  std::vector<std::string> files;
  add_files(script, values, files);
  return files;
}

}  // namespace vielto

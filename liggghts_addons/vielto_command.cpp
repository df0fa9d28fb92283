// SPDX-License-Identifier: GPL-2.0-or-later
#include "vielto_command.h"

#include <mpi.h>
#include <stdio.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "comm.h"
#include "error.h"
#include "force.h"
#include "input.h"
#include "universe.h"
#include "variable.h"
#include "vielto_critical_time.h"
#include "vielto_state.h"

using namespace LAMMPS_NS;
namespace fs = std::filesystem;

namespace {

// sha256sum is in every Debian system; a hash needs no code of ours
std::string sha256(const std::string& path) {
  FILE* pipe = popen(("sha256sum -- '" + path + "' 2>/dev/null").c_str(), "r");
  if (!pipe) return "";
  std::array<char, 128> buffer = {};
  const bool got = fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr;
  pclose(pipe);
  const std::string line = got ? buffer.data() : "";
  return line.substr(0, line.find(' '));
}

std::string command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (char& c : text)
    if (c == '\0') c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::vector<std::string> parameter_names(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::string> names;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string keyword, name, style;
    if (words >> keyword >> name >> style && keyword == "variable" && style == "index") names.push_back(name);
  }
  return names;
}

void write_json(const fs::path& path, const nlohmann::json& content) {
  const fs::path partial = path.string() + ".partial";
  std::ofstream(partial) << content.dump(2) << '\n';
  fs::rename(partial, path);
}

}  // namespace

void ViEltoCommand::command(int narg, char** arg) {
  const std::string what = narg > 0 ? arg[0] : "";
  if (what == "error" && narg == 2)
    error->all(FLERR, arg[1]);
  else if (what == "half_period" && narg == 6)
    half_period(narg, arg);
  else if (what == "open" && narg > 2)
    open(narg, arg);
  else if (what == "close" && narg == 2)
    close(narg, arg);
  else
    error->all(FLERR, "vielto: unknown form of this command; use error, half_period, open or close");
}

void ViEltoCommand::half_period(int, char** arg) {
  if (std::string(arg[2]) != "radius" || std::string(arg[4]) != "density")
    error->all(FLERR, "vielto: write 'vielto half_period NAME radius R density RHO'");
  if (!vielto::settings().chosen)
    error->all(FLERR, "vielto: half_period needs 'pair_style gran model vielto ...' before it");
  const double radius = force->numeric(FLERR, arg[3]), density = force->numeric(FLERR, arg[5]);
  if (!(radius > 0 && density > 0)) error->all(FLERR, "vielto: half_period needs a radius and a density > 0");
  char value[64];
  snprintf(value, sizeof value, "%.12g", vielto::shortest_half_period_of(lmp, radius, density));
  char string_style[] = "string";
  char* set[3] = {arg[1], string_style, value};
  input->variable->set(3, set);
}

void ViEltoCommand::open(int narg, char** arg) {
  const fs::path folder = arg[1];
  const fs::path partial = folder.string() + ".partial";
  std::string fault;
  if (comm->me == 0) {
    std::error_code code;
    if (fs::exists(folder)) {
      fault = "vielto: the run folder " + folder.string() + " is there already; remove it or name another with -var run";
    } else {
      nlohmann::json run = {{"schema", 1},
                            {"status", "running"},
                            {"command", command_line()},
                            {"ranks", comm->nprocs},
                            {"versions", {{"vielto", VIELTO_VERSION}, {"liggghts", universe->version}}}};
      bool parameters = false;
      for (int i = 2; i < narg && fault.empty(); i++) {
        const std::string word = arg[i];
        if (word == "parameters" || word == "inputs") {
          parameters = word == "parameters";
          continue;
        }
        if (!fs::exists(word)) fault = "vielto: input file " + word + " is missing";
        run["hashes"][fs::path(word).filename().string()] = sha256(word);
        if (!parameters) continue;
        for (std::string name : parameter_names(word))
          if (const char* value = input->variable->retrieve(&name[0])) run["parameters"][name] = value;
      }
      if (fault.empty()) {
        fs::remove_all(partial, code);
        if (!fs::create_directories(partial, code))
          fault = "vielto: cannot make the run folder " + partial.string() + "; check the path and its permissions";
        else
          write_json(partial / "run.json", run);
      }
    }
  }
  int length = static_cast<int>(fault.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  fault.resize(length);
  MPI_Bcast(&fault[0], length, MPI_CHAR, 0, world);
  if (length) error->all(FLERR, fault.c_str());
}

void ViEltoCommand::close(int, char** arg) {
  MPI_Barrier(world);
  if (comm->me == 0) {
    const fs::path folder = arg[1], partial = folder.string() + ".partial";
    try {
      std::ifstream in(partial / "run.json");
      nlohmann::json run = nlohmann::json::parse(in);
      run["status"] = "complete";
      write_json(partial / "run.json", run);
      fs::rename(partial, folder);
    } catch (const std::exception& e) {
      error->one(FLERR, ("vielto: cannot complete the run folder " + folder.string() + ": " + e.what()).c_str());
    }
  }
  MPI_Barrier(world);
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/script_command.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "atom.h"
#include "comm.h"
#include "core/bad_input.h"
#include "core/par_file.h"
#include "engine/critical_time.h"
#include "engine/law.h"
#include "error.h"
#include "force.h"
#include "input.h"
#include "script/clump.h"
#include "script/command_line.h"
#include "script/law_command.h"
#include "universe.h"
#include "variable.h"
#include "vielto_state.h"
#include "vielto_stop.h"

using namespace LAMMPS_NS;
using vielto::choices;
using vielto::command_line;
using vielto::is_number;
using vielto::names_on_command_line;
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

std::string joined(int narg, char** arg, int from) {
  std::string line;
  for (int i = from; i < narg; i++) line += (i > from ? " " : "") + std::string(arg[i]);
  return line;
}

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
  std::ofstream(partial) << content.dump(2) << '\n';
  fs::rename(partial, path);
}

}  // namespace

void ViEltoCommand::command(int narg, char** arg) {
  const std::string what = narg > 0 ? arg[0] : "";
  if (what == "error" && narg > 1)
    vielto::stop_all(lmp, joined(narg, arg, 1).c_str());
  else if (what == "half_period" && narg == 6)
    half_period(narg, arg);
  else if (what == "shell" && narg > 1)
    shell(narg, arg);
  else if (what == "prime" && narg == 3)
    prime(narg, arg);
  else if (what == "words" && narg > 2)
    set_variable(arg[1], joined(narg, arg, 2).c_str());
  else if (what == "property" && narg == 4)
    property(narg, arg);
  else if (what == "pair_property" && narg == 4)
    pair_property(narg, arg);
  else if (what == "law")
    vielto::LawCommand(lmp).command(narg, arg);
  else if (what == "check" && narg > 1)
    check(narg, arg);
  else if (what == "provisional" && narg > 2)
    provisional(narg, arg);
  else if (what == "clump" && narg == 8)
    clump(narg, arg);
  else if (what == "resume" && narg == 3)
    resume(narg, arg);
  else if (what == "bed" && narg > 3)
    bed(narg, arg);
  else if (what == "grains" && narg > 1 && narg % 2 == 0)
    grains(narg, arg);
  else if (what == "open" && narg > 2)
    open(narg, arg);
  else if (what == "close" && narg == 2)
    close(narg, arg);
  else
    vielto::stop_all(lmp,
                     "vielto: unknown form of this command; use error, half_period, shell, prime, words, property, "
                     "pair_property, law, check, provisional, clump, grains, open, resume, bed or close");
}

void ViEltoCommand::half_period(int, char** arg) {
  if (std::string(arg[2]) != "radius" || std::string(arg[4]) != "density")
    vielto::stop_all(lmp, "vielto: write 'vielto half_period NAME radius R density RHO'");
  vielto::law_in_use(lmp, "half_period");
  const double radius = force->numeric(FLERR, arg[3]), density = force->numeric(FLERR, arg[5]);
  if (!(radius > 0 && density > 0)) vielto::stop_all(lmp, "vielto: half_period needs a radius and a density > 0");
  char value[64];
  snprintf(value, sizeof value, "%.12g", vielto::shortest_half_period_of(lmp, radius, density));
  set_variable(arg[1], value);
}

void ViEltoCommand::set_variable(char* name, const char* value) {
  std::string text = value, style = "string";
  char* set[3] = {name, &style[0], &text[0]};
  input->variable->set(3, set);
}

// Files are looked at by one processor only; all have to stop.
void ViEltoCommand::stop_if(const std::string& faultOnRankZero) {
  std::string fault = faultOnRankZero;
  int length = static_cast<int>(fault.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  if (length == 0) return;
  fault.resize(length);
  MPI_Bcast(&fault[0], length, MPI_CHAR, 0, world);
  vielto::stop_all(lmp, fault.c_str());
}

void ViEltoCommand::shell(int narg, char** arg) {
  const std::string line = joined(narg, arg, 1);
  std::string fault;
  if (comm->me == 0 && system(line.c_str()) != 0)
    fault = "vielto: '" + std::string(arg[1]) + (narg > 2 ? std::string(" ") + arg[2] : "") +
            "' failed; its own line stands above";
  stop_if(fault);
}

void ViEltoCommand::prime(int, char** arg) {
  const int k = force->inumeric(FLERR, arg[2]);
  if (k < 1 || k > 10000) vielto::stop_all(lmp, "vielto: seeds are numbers from 1 to 10000");
  int candidate = 10000;
  for (int found = 0; found < k;) {
    bool isPrime = ++candidate > 1;
    for (int d = 2; d * d <= candidate && isPrime; d++) isPrime = candidate % d != 0;
    found += isPrime;
  }
  set_variable(arg[1], std::to_string(candidate).c_str());
}

void ViEltoCommand::property(int, char** arg) {
  const std::string name = arg[1], grain = arg[2], wall = arg[3];
  if (atom->ntypes < 2 || atom->ntypes > 3)
    vielto::stop_all(lmp, "vielto: property needs a box of two types (grain, wall) or three (and fixed grains)");
  const std::string line = "fix " + name + " all property/global " + name + " peratomtype " + grain + " " + wall +
                           (atom->ntypes == 3 ? " " + grain : "");
  input->one(line.c_str());
}

void ViEltoCommand::pair_property(int, char** arg) {
  const std::string name = arg[1], grain = arg[2], wall = arg[3];
  if (atom->ntypes < 2 || atom->ntypes > 3)
    vielto::stop_all(lmp, "vielto: pair_property needs a box of two types (grain, wall) or three (and fixed grains)");
  std::string line =
      "fix " + name + " all property/global " + name + " peratomtypepair " + std::to_string(atom->ntypes);
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = 1; j <= atom->ntypes; j++) line += " " + (i == 2 || j == 2 ? wall : grain);
  input->one(line.c_str());
}

void ViEltoCommand::check(int narg, char** arg) {
  std::string fault;
  if (comm->me == 0) try {
      const vielto::ParFile file = vielto::ParFile::read(arg[1]);
      for (int i = 3; i < narg; i++) file.number(arg[i]);
      for (const vielto::Parameter& p : file.all())
        for (std::string name : {p.name, "wall_" + p.name}) {
          const char* now = input->variable->retrieve(&name[0]);
          if (!now || !fault.empty()) continue;
          const std::vector<std::string> words = choices(p.unit);
          const bool good = words.empty() ? !is_number(p.value) || is_number(now)
                                          : std::find(words.begin(), words.end(), now) != words.end();
          if (!good)
            fault = "vielto: " + name + " is '" + now + "'; give " +
                    (words.empty() ? "a number (" + p.unit + ")" : p.unit) + " with -var " + name;
        }
    } catch (const vielto::BadInput& e) {
      fault = std::string("vielto: ") + e.what();
    }
  stop_if(fault);
}

void ViEltoCommand::provisional(int narg, char** arg) {
  int found = 0;
  std::string fault;
  if (comm->me == 0) try {
      for (int i = 2; i < narg; i++) found = found || vielto::ParFile::read(arg[i]).provisional();
    } catch (const vielto::BadInput& e) {
      fault = std::string("vielto: ") + e.what();
    }
  stop_if(fault);
  MPI_Bcast(&found, 1, MPI_INT, 0, world);
  set_variable(arg[1], found ? "1" : "0");
}

void ViEltoCommand::clump(int, char** arg) {
  const std::string name = arg[1], out = arg[3];
  if (std::string(arg[4]) != "diameter" || std::string(arg[6]) != "density")
    vielto::stop_all(lmp, "vielto: write 'vielto clump NAME FILE OUT diameter D density RHO'");
  const double d = force->numeric(FLERR, arg[5]), density = force->numeric(FLERR, arg[7]);
  if (!(d > 0 && density > 0)) vielto::stop_all(lmp, "vielto: clump needs a diameter and a density > 0");
  double smallest = 0;
  char words[2000] = "";
  std::string fault;
  if (comm->me == 0) try {
      const vielto::Clump shape = vielto::Clump::read(arg[2]).scaled_to(d);
      std::ofstream file(out);
      file.precision(12);
      for (const vielto::ClumpSphere& s : shape.spheres)
        file << s.x[0] << ' ' << s.x[1] << ' ' << s.x[2] << ' ' << s.r << '\n';
      file.close();
      if (!file) fault = "vielto: cannot write " + out;
      const double mass = density * shape.volume;
      const auto& I = shape.inertia;
      // ntry: LIGGGHTS still counts which sphere has which share of the volume, which nothing here uses
      const int length = snprintf(words, sizeof words,
                                  "nspheres %d ntry 100000 spheres file %s scale 1 mass %.12g inertia_tensor %.12g "
                                  "%.12g %.12g %.12g %.12g %.12g "
                                  "use_density",
                                  static_cast<int>(shape.spheres.size()), out.c_str(), mass, mass * I[0], mass * I[1],
                                  mass * I[2], mass * I[3], mass * I[4], mass * I[5]);
      if (length >= static_cast<int>(sizeof words)) fault = "vielto: the run folder's path is too long: " + out;
      smallest = shape.smallest();
    } catch (const vielto::BadInput& e) {
      fault = std::string("vielto: ") + e.what();
    }
  stop_if(fault);
  MPI_Bcast(words, sizeof words, MPI_CHAR, 0, world);
  MPI_Bcast(&smallest, 1, MPI_DOUBLE, 0, world);
  set_variable(arg[1], words);
  char radius[64];
  snprintf(radius, sizeof radius, "%.12g", smallest);
  set_variable(&(name + "Radius")[0], radius);
  set_variable(&(name + "Spheres")[0], std::string(words).substr(9, std::string(words).find(" ntry") - 9).c_str());
}

void ViEltoCommand::grains(int narg, char** arg) {
  // x, y, z, radius and number of each grain that moves, from all processors
  std::vector<double> mine;
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->type[i] == 1) {
      for (int d = 0; d < 3; d++) mine.push_back(atom->x[i][d]);
      mine.push_back(atom->radius[i]);
      mine.push_back(atom->tag[i]);
    }
  int length = static_cast<int>(mine.size());
  std::vector<int> lengths(comm->nprocs), offsets(comm->nprocs);
  MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, world);
  int sum = 0;
  for (int p = 0; p < comm->nprocs; p++) offsets[p] = sum, sum += lengths[p];
  std::vector<double> all(sum);
  MPI_Gatherv(mine.data(), length, MPI_DOUBLE, all.data(), lengths.data(), offsets.data(), MPI_DOUBLE, 0, world);
  std::string fault;
  if (comm->me == 0) {
    std::map<int, std::string> rows;  // in the order of their numbers, whatever the processors
    for (std::size_t k = 0; k < all.size(); k += 5) {
      char line[120];
      snprintf(line, sizeof line, "%.9g,%.9g,%.9g,%.9g\n", all[k], all[k + 1], all[k + 2], all[k + 3]);
      rows[static_cast<int>(all[k + 4])] = line;
    }
    std::ofstream out(arg[1]);
    for (int i = 2; i < narg; i += 2) out << "# " << arg[i] << '=' << arg[i + 1] << '\n';
    out << "x_m,y_m,z_m,radius_m\n";
    for (const auto& row : rows) out << row.second;
    out.close();
    if (!out) fault = std::string("vielto: cannot write ") + arg[1];
  }
  stop_if(fault);
}

void ViEltoCommand::open(int narg, char** arg) {
  const fs::path folder = arg[1];
  const fs::path partial = folder.string() + ".partial";
  std::string fault;
  if (comm->me == 0) {
    std::error_code code;
    if (fs::exists(folder)) {
      fault =
          "vielto: the run folder " + folder.string() + " is there already; remove it or name another with -var run";
    } else {
      nlohmann::json run = {{"schema", 1},
                            {"status", "running"},
                            {"command", command_line()},
                            {"ranks", comm->nprocs},
                            {"versions", {{"vielto", VIELTO_VERSION}, {"liggghts", universe->version}}}};
      bool parameters = false;
      std::set<std::string> known;
      for (int i = 2; i < narg && fault.empty(); i++) {
        const std::string word = arg[i];
        if (word == "parameters" || word == "inputs") {
          parameters = word == "parameters";
          continue;
        }
        if (!fs::exists(word)) fault = "vielto: input file " + word + " is missing";
        run["hashes"][fs::path(word).filename().string()] = sha256(word);
        if (!parameters || !fault.empty()) continue;
        // the wall's card has the names of the grain's; its values stand under wall_NAME
        const vielto::ParFile file = vielto::ParFile::read(word);
        for (const vielto::Parameter& p : file.all())
          for (std::string name : {p.name, "wall_" + p.name}) {
            known.insert(name);
            if (const char* value = input->variable->retrieve(&name[0])) run["parameters"][name] = value;
          }
      }
      for (const vielto::Law& law : vielto::laws())
        for (const vielto::LawParameter& p : law.parameters) {
          std::string name = p.rule.name;
          known.insert(name);
          if (const char* value = input->variable->retrieve(&name[0])) run["parameters"][name] = value;
        }
      for (const std::string& name : names_on_command_line())
        if (fault.empty() && !known.count(name))
          fault =
              "vielto: -var " + name + ": there is no such parameter; see " + arg[3] + " and the cards for the names";
      if (fault.empty()) {
        fs::remove_all(partial, code);
        if (!fs::create_directories(partial, code))
          fault = "vielto: cannot make the run folder " + partial.string() + "; check the path and its permissions";
        else
          write_json(partial / "run.json", run);
      }
    }
  }
  stop_if(fault);
}

// Throws if a run was made with other parameters than those that hold now.
void ViEltoCommand::same_parameters(const nlohmann::json& run, const std::set<std::string>& apart) {
  for (const auto& [key, value] : run.at("parameters").items()) {
    std::string name = key;
    const char* now = input->variable->retrieve(&name[0]);
    if (now && !apart.count(key) && value.get<std::string>() != now)
      throw std::runtime_error("it was started with " + key + " " + value.get<std::string>() + ", not " + now);
  }
}

// The text that processor 0 has, as a variable on all of them.
void ViEltoCommand::share_variable(char* name, std::string text) {
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  text.resize(length);
  MPI_Bcast(&text[0], length, MPI_CHAR, 0, world);
  set_variable(name, text.c_str());
}

void ViEltoCommand::resume(int, char** arg) {
  const fs::path partial = std::string(arg[1]) + ".partial";
  std::string fault, newest;
  if (comm->me == 0) {
    try {
      std::ifstream in(partial / "run.json");
      if (!in) throw std::runtime_error("it does not exist");
      if (!fs::exists(partial / "mesh" / "geometry.par")) throw std::runtime_error("mesh/geometry.par is missing");
      same_parameters(nlohmann::json::parse(in), {"resume", "run"});
      newest = newest_restart(partial);
      if (newest.empty()) throw std::runtime_error("it was broken off before the first restart file was complete");
    } catch (const std::exception& e) {
      fault = "vielto: cannot resume " + partial.string() + ": " + e.what() + "; start anew without -var resume";
    }
  }
  stop_if(fault);
  share_variable(arg[2], newest);
}

void ViEltoCommand::bed(int narg, char** arg) {
  const std::string folder = arg[1];
  std::string fault, file;
  if (comm->me == 0 && folder != "none") {
    try {
      std::ifstream in(fs::path(folder) / "run.json");
      if (!in) throw std::runtime_error("it is no complete run folder");
      std::set<std::string> apart(arg + 4, arg + narg);
      apart.insert({"run", "resume", "bed"});
      same_parameters(nlohmann::json::parse(in), apart);
      file = (fs::path(folder) / "bed.restart").string();
      if (!fs::exists(file)) throw std::runtime_error("bed.restart is missing");
    } catch (const std::exception& e) {
      fault = "vielto: cannot take the bed of " + folder + ": " + e.what() +
              "; name a run of the same bed with -var bed, or none";
    }
  }
  stop_if(fault);
  set_variable(arg[2], folder == "none" ? "0" : "1");
  share_variable(arg[3], file);
}

void ViEltoCommand::close(int, char** arg) {
  MPI_Barrier(world);
  if (comm->me == 0) {
    const fs::path folder = arg[1], partial = folder.string() + ".partial";
    try {
      std::ifstream in(partial / "run.json");
      nlohmann::json run = nlohmann::json::parse(in);
      run["status"] = "complete";
      remove_older_restarts(partial);
      write_json(partial / "run.json", run);
      fs::rename(partial, folder);
    } catch (const std::exception& e) {
      vielto::stop_here(lmp, ("vielto: cannot complete the run folder " + folder.string() + ": " + e.what()).c_str());
    }
  }
  MPI_Barrier(world);
}

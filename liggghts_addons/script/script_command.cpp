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
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "core/bad_input.h"
#include "domain.h"
#include "engine/bodies.h"
#include "engine/critical_time.h"
#include "engine/law.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "input.h"
#include "modify.h"
#include "script/clump.h"
#include "script/law_command.h"
#include "script/run_folder.h"
#include "script/setup.h"
#include "universe.h"
#include "variable.h"
#include "vielto_state.h"
#include "vielto_stop.h"

using namespace LAMMPS_NS;

namespace {

std::string joined(int narg, char** arg, int from) {
  std::string line;
  for (int i = from; i < narg; i++) line += (i > from ? " " : "") + std::string(arg[i]);
  return line;
}

}  // namespace

void ViEltoCommand::command(int narg, char** arg) {
  const std::string what = narg > 0 ? arg[0] : "";
  if (what == "error" && narg > 1)
    refuse(joined(narg, arg, 1));
  else if (what == "half_period" && narg == 6)
    half_period(narg, arg);
  else if (what == "repeat" && narg > 2)
    repeat(narg, arg);
  else if (what == "include" && narg == 4)
    include(narg, arg);
  else if (what == "words" && narg > 2)
    set_variable(arg[1], joined(narg, arg, 2).c_str());
  else if (what == "property" && narg == 4)
    property(narg, arg);
  else if (what == "pair_property" && narg == 4)
    pair_property(narg, arg);
  else if (what == "law")
    vielto::LawCommand(lmp).command(narg, arg);
  else if (what == "clump" && narg == 8)
    clump(narg, arg);
  else if (what == "mass" && narg == 2)
    mass(narg, arg);
  else if (what == "place" && narg == 11)
    place(narg, arg);
  else if (what == "grains" && narg > 1 && narg % 2 == 0)
    grains(narg, arg);
  else if (what == "setup" && narg > 1)
    setup(narg, arg);
  else if (what == "close" && narg == 2)
    close(narg, arg);
  else
    vielto::stop_all(lmp,
                     "vielto: unknown form of this command; use setup, error, half_period, words, repeat, include, "
                     "property, pair_property, law, clump, mass, place, grains or close");
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

// Nothing that was not run stays behind.
void ViEltoCommand::refuse(const std::string& line) {
  if (comm->me == 0) vielto::RunFolder::drop_opened();
  vielto::stop_all(lmp, line.c_str());
}

// Files are looked at by one processor only; all have to stop.
void ViEltoCommand::stop_if(const std::string& faultOnRankZero) {
  std::string fault = faultOnRankZero;
  int length = static_cast<int>(fault.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  if (length == 0) return;
  fault.resize(length);
  MPI_Bcast(&fault[0], length, MPI_CHAR, 0, world);
  refuse(fault);
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

void ViEltoCommand::mass(int, char** arg) {
  double mine = 0, all = 0;
  vielto::each_mass(modify, atom, [&](double m, const double*) { mine += m; });
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  char value[64];
  snprintf(value, sizeof value, "%.15g", all);
  set_variable(arg[1], value);
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

void ViEltoCommand::place(int, char** arg) {
  if (std::string(arg[3]) != "radii" || std::string(arg[7]) != "density" || std::string(arg[9]) != "seed")
    vielto::stop_all(lmp, "vielto: write 'vielto place FILE N radii R1 R2 R3 density RHO seed S'");
  const int count = force->inumeric(FLERR, arg[2]);
  const double radii[3] = {force->numeric(FLERR, arg[4]), force->numeric(FLERR, arg[5]), force->numeric(FLERR, arg[6])};
  const double density = force->numeric(FLERR, arg[8]);
  if (!(count > 0 && density > 0 && radii[0] > 0 && radii[1] > 0 && radii[2] > 0))
    vielto::stop_all(lmp, "vielto: place needs N, radii and a density > 0");
  std::vector<double> places(3 * static_cast<std::size_t>(count));
  std::string fault;
  if (comm->me == 0) {
    std::ifstream in(arg[1]);
    std::string line;
    if (!std::getline(in, line)) fault = std::string("vielto: cannot read ") + arg[1];
    int there = 0;
    for (; there < count && std::getline(in, line); there++) {
      double* x = &places[3 * static_cast<std::size_t>(there)];
      if (sscanf(line.c_str(), "%lf,%lf,%lf", x, x + 1, x + 2) != 3) break;
    }
    if (fault.empty() && there < count)
      fault = "vielto: mass that cannot be placed: asked for " + std::to_string(count) + " grains, there is room for " +
              std::to_string(there) + "; lower fill or mass, or take smaller grains (grainDiameter)";
  }
  stop_if(fault);
  MPI_Bcast(places.data(), static_cast<int>(places.size()), MPI_DOUBLE, 0, world);
  std::vector<int> size(count, 1);
  const int few = static_cast<int>(std::lround(count / 6.0));
  std::fill_n(size.begin(), few, 0);
  std::fill_n(size.rbegin(), few, 2);
  std::mt19937 random(static_cast<std::mt19937::result_type>(force->inumeric(FLERR, arg[10])));
  for (int i = count - 1; i > 0; i--) std::swap(size[i], size[random() % static_cast<unsigned>(i + 1)]);

  const int before = atom->nlocal;
  const bigint numbered = atom->natoms;
  for (int i = 0; i < count; i++) {
    double* const x = &places[3 * static_cast<std::size_t>(i)];
    bool mine = true;
    for (int d = 0; d < 3; d++) mine = mine && x[d] >= domain->sublo[d] && x[d] < domain->subhi[d];
    if (!mine) continue;
    atom->avec->create_atom(1, x);
    const int k = atom->nlocal - 1;
    atom->radius[k] = radii[size[i]];
    atom->density[k] = density;
    atom->rmass[k] = density * 4.0 / 3.0 * M_PI * std::pow(radii[size[i]], 3);
    atom->tag[k] = static_cast<int>(numbered) + i + 1;
  }
  for (int m = 0; m < modify->nfix; m++)
    if (modify->fix[m]->create_attribute) {
      modify->fix[m]->pre_set_arrays();
      for (int k = before; k < atom->nlocal; k++) modify->fix[m]->set_arrays(k);
    }
  const bigint mine = atom->nlocal;
  MPI_Allreduce(&mine, &atom->natoms, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (atom->natoms != numbered + count)
    vielto::stop_all(lmp, (std::string("vielto: a place of ") + arg[1] + " lies outside the box").c_str());
  if (atom->map_style) {
    atom->nghost = 0;
    atom->map_init();
    atom->map_set();
  }
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

void ViEltoCommand::close(int, char** arg) {
  MPI_Barrier(world);
  std::string fault;
  if (comm->me == 0) try {
      vielto::RunFolder(arg[1]).close();
    } catch (const std::exception& e) {
      fault = std::string("vielto: ") + e.what();
    }
  stop_if(fault);
}

void ViEltoCommand::repeat(int narg, char** arg) {
  const int times = force->inumeric(FLERR, arg[1]);
  std::vector<std::string> commands(arg + 2, arg + narg);  // LIGGGHTS takes its words away as it reads another line
  std::string until;
  if (commands.size() > 2 && commands[commands.size() - 2] == "until") {
    until = commands.back();
    commands.resize(commands.size() - 2);
  }
  for (int i = 1; i <= times; i++) {
    for (std::string line : commands) {
      for (std::size_t at = 0; (at = line.find('%', at)) != std::string::npos;) line.replace(at, 1, std::to_string(i));
      input->one(line.c_str());
    }
    if (!until.empty() && value_of(until) != 0) return;
  }
}

void ViEltoCommand::include(int, char** arg) {
  if (std::string(arg[2]) != "if") vielto::stop_all(lmp, "vielto: write 'vielto include FILE if NUMBER'");
  if (force->numeric(FLERR, arg[3]) != 0) input->one(("include " + std::string(arg[1])).c_str());
}

double ViEltoCommand::value_of(std::string name) {
  const int variable = input->variable->find(&name[0]);
  if (variable < 0 || !input->variable->equalstyle(variable))
    vielto::stop_all(lmp, ("vielto: repeat until " + name + ": no such equal-style variable").c_str());
  return input->variable->compute_equal(variable);
}

void ViEltoCommand::setup(int narg, char** arg) {
  const auto given = [this](std::string name) -> std::optional<std::string> {
    const char* value = input->variable->retrieve(&name[0]);
    return value ? std::optional<std::string>(value) : std::nullopt;
  };
  std::string fault, log;
  std::vector<std::string> names;  // name, value, name, value ...: index variables, an empty name, the others
  if (comm->me == 0) try {
      vielto::RunSetup setup(std::vector<std::string>(arg + 1, arg + narg), given);
      setup.run(comm->nprocs, universe->version);
      for (const auto& [name, value] : setup.index) names.insert(names.end(), {name, value});
      names.insert(names.end(), {"", ""});
      for (const auto& [name, value] : setup.strings) names.insert(names.end(), {name, value});
      names.insert(names.end(), {"log", setup.log()});
    } catch (const std::exception& e) {
      fault = std::string("vielto: ") + e.what();
    }
  stop_if(fault);
  share(names);
  std::string style = "index";
  for (std::size_t k = 0; k + 2 < names.size(); k += 2) {
    if (names[k].empty()) {
      style = "string";
      continue;
    }
    char* set[3] = {&names[k][0], &style[0], &names[k + 1][0]};
    input->variable->set(3, set);
  }
  input->one(names.back().c_str());
  std::string work = "work";
  input->one((std::string("include ") + input->variable->retrieve(&work[0]) + "/mesh/geometry.par").c_str());
}

// The texts that processor 0 has, on all of them.
void ViEltoCommand::share(std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + '\0';
  int length = static_cast<int>(all.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  all.resize(length);
  MPI_Bcast(&all[0], length, MPI_CHAR, 0, world);
  texts.clear();
  std::istringstream in(all);
  for (std::string text; std::getline(in, text, '\0');) texts.push_back(text);
}

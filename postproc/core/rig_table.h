// SPDX-License-Identifier: GPL-2.0-or-later
// The one table of rigs and what they observe: cases/rigs.toml, which is compiled in, and files of the same form for
// rigs of a user's own. An apparatus is what a row of the observation table was seen on: a rig, or the bench.
//
// Errors: BadInput with file, line and key.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vielto {

struct NamedObservable {
  std::string name, unit, meaning;
  bool any_sign = false;  // a simulated value may be 0 or less
  bool fitful = false;    // comes and goes with single grains: no evidence for a diagnosis
};

struct RigPicture {
  bool from_side = false, close_up = false;
  std::vector<std::string> without;  // meshes
};

// cases/rigs.toml says what each means. Paths start from the table's folder.
struct RigDescription {
  std::string name, title;
  std::vector<NamedObservable> observables;
  std::string script;  // empty: measured with, never simulated
  std::vector<std::string> parameters, includes;
  std::string wall;
  std::string record, post, result;
  std::map<std::string, std::string> vars;  // condition -> its -var
  std::string work;
  std::vector<std::string> reference;
  std::string effects_of;  // rig whose effects act on this one too; empty: none
  RigPicture picture;
  std::string table;  // file that states it; empty: the table that is compiled in

  bool is_rig() const { return !script.empty(); }
  // A path of the table, for `root`, the folder that holds cases/ and materials/.
  std::string path(const std::string& stated, const std::string& root) const;
};

// Rigs and bench, in the table's order.
const std::vector<RigDescription>& apparatuses();

// Adds the rigs of a file; for a program, before it reads anything else.
void add_rigs(const std::string& path);

// Null if there is none of that name.
const RigDescription* find_apparatus(const std::string& name);
const RigDescription* find_rig(const std::string& name);

// "mixer, shearbox, repose, drum", and with the bench, to say what could be written instead.
std::string rig_names();
std::string apparatus_names();
// "torque.csv, shear.csv, ..."
std::string record_names();

// What the apparatus observes, with what every apparatus does. Empty for one that there is not.
std::vector<NamedObservable> observables_of(const std::string& apparatus);

// Null if the apparatus has no such observable, or there is none of that name.
const NamedObservable* find_observable(const std::string& apparatus, const std::string& observable);

// The whole table with the conditions of an observation, for scripts and for people.
nlohmann::ordered_json rig_table_json();
std::string rig_table_text();

}  // namespace vielto

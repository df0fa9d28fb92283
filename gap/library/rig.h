// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: how a test becomes a run: folder and script of a rig (core/rig_table.h), the -var of each condition, and the
// baseline value of every -var.
//
// Errors: BadInput for a rig that there is not, a script or a parameter file that is not there.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "gap/library/effect.h"
#include "gap/library/settings.h"

namespace vielto::gap {

struct Rig {
  std::string name, folder, script, post;
  std::vector<std::string> files;           // what a run is made from: script and parameter files, paths
  std::set<std::string> known;              // every -var its files state
  std::map<std::string, double> base;       // of every -var with a number
  std::map<std::string, std::string> vars;  // condition -> -var

  // `root`: the folder that holds cases/ and materials/.
  static Rig read(const std::string& name, const std::string& root);

  // The -var of an effect at a strength, from the baseline values `base`. Empty at strength 0.
  // Errors: BadInput if the rig's files do not state such a -var, or no number for one that starts from it.
  std::map<std::string, std::string> settings(const Effect& effect, double strength,
                                              const std::map<std::string, double>& base) const;
};

// Name of the first file a run was made from (the hashes of its run.json) that differs from the one of that name in
// `hash_of`; empty if there is none.
std::string changed_file(const nlohmann::json& run, const std::map<std::string, std::string>& hash_of);

// Errors: BadInput if it is not there or no JSON object.
nlohmann::json read_json(const std::string& path);

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/rig.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "core/bad_input.h"
#include "core/json_file.h"
#include "core/par_file.h"
#include "core/rig_table.h"

namespace vielto::gap {

namespace fs = std::filesystem;

Rig Rig::read(const std::string& name, const std::string& root) {
  const RigDescription* stated = find_rig(name);
  if (!stated) throw BadInput(name, 0, "is no rig", fmt::format("name one of {}, or add it with --rigs", rig_names()));
  Rig rig;
  rig.name = name;
  const fs::path script(stated->path(stated->script, root));
  rig.folder = script.parent_path().string();
  rig.script = script.filename().string();
  rig.post = stated->post;
  rig.vars = stated->vars;
  if (!fs::exists(script)) throw BadInput(script.string(), 0, "is not there", "state --root, or a rig that can be run");
  rig.files.push_back(script.string());
  const auto add = [&](const std::string& path, const std::string& prefix) {
    rig.files.push_back(stated->path(path, root));
    const ParFile par = ParFile::read(rig.files.back());
    for (const Parameter& p : par.all()) {
      rig.known.insert(prefix + p.name);
      char* end = nullptr;
      const double value = std::strtod(p.value.c_str(), &end);
      // as in LIGGGHTS: what the rig states of a card's parameter comes first and holds
      if (end != p.value.c_str() && *end == '\0') rig.base.emplace(prefix + p.name, value);
    }
  };
  for (const std::string& file : stated->parameters) add(file, "");
  if (!stated->wall.empty()) add(stated->wall, "wall_");
  for (const std::string& file : stated->includes) rig.files.push_back(stated->path(file, root));
  return rig;
}

std::map<std::string, std::string> Rig::settings(const Effect& effect, double strength,
                                                 const std::map<std::string, double>& from) const {
  std::map<std::string, std::string> changed;
  if (strength == 0) return changed;
  for (const VarChange& change : effect.vars) {
    if (!change.acts_on(name)) continue;
    // LIGGGHTS takes any -var in silence: one that the rig does not read would be no effect at all.
    if (known.count(change.name) == 0)
      throw BadInput(effect.path, 0, change.name, fmt::format("is no parameter of {}", script),
                     "give the rig this switch first (doc/develop/add_rig.md)");
    if (change.needs_base() && from.count(change.name) == 0)
      throw BadInput(effect.path, 0, change.name, fmt::format("has no baseline value in the files of {}", name),
                     "state it in the rig's parameter file");
    changed[change.name] = change.text(change.needs_base() ? from.at(change.name) : 0, strength);
  }
  return changed;
}

std::string changed_file(const nlohmann::json& run, const std::map<std::string, std::string>& hash_of) {
  const auto hashes = run.find("hashes");
  if (hashes == run.end()) return "";
  for (const auto& [name, hash] : hashes->items()) {
    const auto now = hash_of.find(fs::path(name).filename().string());
    if (now != hash_of.end() && now->second != hash) return name;
  }
  return "";
}

nlohmann::json read_json(const std::string& path) {
  nlohmann::json j = read_json_file(path, "make the run again");
  if (!j.is_object()) throw BadInput(path, 0, "is no JSON object", "make the run again");
  return j;
}

}  // namespace vielto::gap

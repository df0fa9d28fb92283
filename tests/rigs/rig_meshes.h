// SPDX-License-Identifier: GPL-2.0-or-later
// The meshes of a rig with some of its parameters, by the names of its parts.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "core/bad_input.h"
#include "rigs/rig_code.h"

namespace vielto_test {

using namespace vielto;

using Settings = std::map<std::string, std::string>;

struct Rig {
  RigGeometry geometry;
  const Triangles& part(const std::string& name) const {
    for (const Part& p : geometry.parts)
      if (p.name == name) return p.triangles;
    throw std::out_of_range(name);
  }
  double number(const std::string& name) const {
    for (const auto& [key, value] : geometry.derived)
      if (key == name) return std::stod(value);
    throw std::out_of_range(name);
  }
};

inline Rig rig(const std::string& name, const Settings& settings = {}) {
  ParFile file = ParFile::read(VIELTO_SOURCE_DIR "/cases/" + name + "/" + name + ".par");
  for (const auto& [key, value] : settings) file.override_value(key, value);
  GeometryInput input(file);
  return {rig_geometry(input)};
}

// What such settings are refused with.
inline std::string refusal(const std::string& name, const Settings& settings) {
  try {
    rig(name, settings);
  } catch (const BadInput& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace vielto_test

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/rig_code.h"

#include <fmt/format.h>

#include <map>

#include "core/bad_input.h"
#include "rig_list.h"

namespace vielto {

#define VIELTO_DECLARE(name) RigCode name##_rig();
VIELTO_RIGS(VIELTO_DECLARE)
#undef VIELTO_DECLARE

namespace {

const std::map<std::string, RigCode>& all_code() {
#define VIELTO_ENTRY(name) {#name, name##_rig()},
  static const std::map<std::string, RigCode> code = {VIELTO_RIGS(VIELTO_ENTRY)};
#undef VIELTO_ENTRY
  return code;
}

}  // namespace

const RigCode* find_rig_code(const std::string& rig) {
  const auto found = all_code().find(rig);
  return found == all_code().end() ? nullptr : &found->second;
}

RigGeometry rig_geometry(GeometryInput& input) {
  std::vector<std::string> names;
  for (const RigDescription& rig : apparatuses())
    if (find_rig_code(rig.name)) names.push_back(rig.name);
  RigGeometry geometry = find_rig_code(input.choice("rig", names))->geometry(input);
  std::size_t triangles = 0;
  for (const Part& part : geometry.parts) {
    triangles += part.triangles.size();
    const double angle = measure(part.triangles).smallest_angle * 180 / kPi;
    if (angle < 0.5)  // LIGGGHTS warns below 0.5 degrees and stops below 0.26
      throw BadInput(input.path(), 0,
                     fmt::format("the mesh '{}' has a triangle with an angle of {:.3f} deg", part.name, angle),
                     "use fewer chords, or change the lengths that leave a sliver");
  }
  geometry.derived.emplace_back("triangles", fmt::format("{}", triangles));
  return geometry;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of a machine of a user's own: a file machine.toml and the STL files that it names.
//
//   unit = "mm"                     of every length here and in the STL files: m, mm, cm or in
//   up = [0, 0, 1]                  against gravity
//   [axis]                          of rotation, right-handed
//   origin = [0, 0, 0]
//   direction = [1, 0, 0]
//   [[part]]                        as many as there are
//   name = "blades"                 any word of a-z, A-Z, 0-9 and _
//   file = "blades.stl"             from this file's folder
//   motion = "turns"                or "stands"
//   open = true                     optional: edges with one triangle are meant (a sheet, a vessel without lid)
//   through = true                  optional, of what turns: it passes through walls (a shaft in its bearings), so that
//                                   no clearance is asked of it
//
// Made of them: meshes in m, mended (geometry/own_mesh.h), in the frame of the run: z up, the axis through the origin,
// x along the horizontal part of its direction.
//
// Errors: BadInput with file, line and key; for a mesh that is open without saying so, for edges that more than two
// triangles share, for extents that no machine has.
#pragma once

#include <string>
#include <vector>

#include "geometry/own_mesh.h"
#include "geometry/turn_clearance.h"

namespace vielto {

struct MachinePart {
  std::string name, file;
  bool turns = false, open = false, through = false;
  MendedMesh mesh;
};

struct MachineParts {
  std::string path;  // of machine.toml
  TurnAxis axis;     // in the frame of the run
  std::vector<MachinePart> parts;

  Triangles of(bool turning, bool with_through = true) const;
};

MachineParts read_machine_parts(const std::string& path);

}  // namespace vielto

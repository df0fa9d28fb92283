// SPDX-License-Identifier: GPL-2.0-or-later
// What a rig's geometry is to the rest of the program: meshes to write, numbers derived from them, and a record of the
// parameters they were made with. One NAME_geometry.cpp a rig.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "par_file.h"
#include "surface.h"

namespace vielto {

// Reads parameters and remembers every one that was asked for, so that geometry.par can refuse a value that contradicts the mesh.
class GeometryInput {
 public:
  struct Used {
    std::string name, value;
    std::vector<std::string> choices;  // of a text parameter, empty for a number
  };

  explicit GeometryInput(const ParFile& file) : file_(file) {}

  // Errors: BadInput for a missing or malformed value, one outside (0, inf), [0, inf) or of a count below `at_least`,
  // or a text that is not among `choices`.
  double positive(const std::string& name);
  double not_negative(const std::string& name);
  double number(const std::string& name);
  int count(const std::string& name, int at_least);
  const std::string& choice(const std::string& name, const std::vector<std::string>& choices);

  // Throws BadInput at the parameter's line.
  [[noreturn]] void refuse(const std::string& name, const std::string& what, const std::string& mend) const;

  const std::vector<Used>& used() const { return used_; }

 private:
  const ParFile& file_;
  std::vector<Used> used_;
};

struct Part {
  std::string name;      // file NAME.stl
  std::string kind;      // drum, shaft, stems, paddle, plate ...: the colour in pictures
  bool moves = false;    // belongs to the rotor or is driven otherwise
  Triangles triangles;
};

struct RigGeometry {
  std::string rig;
  std::vector<Part> parts;
  std::vector<std::pair<std::string, std::string>> derived;  // name, value (quoted if it has blanks)
  std::vector<std::string> notes;                            // lines for the person at the terminal
};

// Mixer: shaft axis along x through y = z = 0, gravity -z, drum half circle below z = 0, open top at z = drumHeight - R.
// Angles count from +y towards +z, positive rotation about +x; a positive inclination pushes the grains towards +x.
// Parts: drum, shaft, stems, paddle_1 ... A slice (slicePaddles >= 2) is periodic in x, 0 <= x <= slicePaddles * drumLength /
// paddleCount; slicePaddles = 0 is the whole drum with both end walls. The drum's chords are inscribed: its vertices lie on the circle.
RigGeometry mixer_geometry(GeometryInput& input);

// The rig named by the parameter `rig`.
RigGeometry rig_geometry(GeometryInput& input);

}  // namespace vielto

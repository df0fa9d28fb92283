// SPDX-License-Identifier: GPL-2.0-or-later
// What a rig's geometry is to the rest of the program: meshes to write, numbers derived from them, and a record of the
// parameters they were made with. One NAME_geometry.cpp a rig.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/par_file.h"
#include "geometry/surface.h"

namespace vielto {

// Reads parameters and remembers every one that was asked for, so that geometry.par can refuse a value that contradicts
// the mesh.
class GeometryInput {
 public:
  struct Used {
    std::string name, value;
    bool is_text = false;
  };

  explicit GeometryInput(const ParFile& file) : file_(file) {}

  // Errors: BadInput for a missing or malformed value, one outside (0, inf), [0, inf) a count outside
  // least..most, or a text that is not among `choices`.
  double positive(const std::string& name);
  double not_negative(const std::string& name);
  double number(const std::string& name);
  int count(const std::string& name, int least, int most);
  const std::string& choice(const std::string& name, const std::vector<std::string>& choices);

  // Throws BadInput at the parameter's line, naming it and its value.
  [[noreturn]] void refuse(const std::string& name, const std::string& what, const std::string& mend) const;

  const std::string& path() const { return file_.path(); }
  const std::vector<Used>& used() const { return used_; }

 private:
  const ParFile& file_;
  std::vector<Used> used_;
};

struct Part {
  std::string name;    // file NAME.stl
  std::string kind;    // drum, shaft, stems, paddle, plate ...: the colour in pictures
  bool moves = false;  // belongs to the rotor or is driven otherwise
  Triangles triangles;
};

struct RigGeometry {
  std::vector<Part> parts;
  std::vector<std::pair<std::string, std::string>> derived;  // name, value (quoted if it has blanks)
  std::vector<std::string> notes;                            // lines for the person at the terminal
};

// Mixer: shaft axis along x through y = z = 0, gravity -z, drum half circle below z = 0, open top at z = drumHeight -
// R. Angles count from +y towards +z, positive rotation about +x; a positive inclination pushes the grains towards +x.
// Parts: drum, shaft, stems, paddle_1 ... A slice (slicePaddles >= 2) is periodic in x, 0 <= x <= slicePaddles *
// drumLength / paddleCount; slicePaddles = 0 is the whole drum with both end walls. The drum's chords are inscribed:
// its vertices lie on the circle.
RigGeometry mixer_geometry(GeometryInput& input);

// Direct shear box: split plane z = 0, shear along x, centre x = y = 0, normals towards the grains. The upper half
// stands splitGap above the lower: were the side walls flush, a grain at the split would be counted by both meshes.
// Parts: lower, upper (each with flanges of flangeLength at the split on both sides along x), plate (closed, normals
// outward) at the top of the upper half.
RigGeometry shearbox_geometry(GeometryInput& input);

// Angle of repose by a lifted cylinder: base (square or disc, normal up) in z = 0, cylinder (open, normals inward)
// standing on it.
RigGeometry repose_geometry(GeometryInput& input);

// Rotating drum: axis along x, 0 <= x <= drumLength, normals inward; parts drum (mantle) and ends (squares around
// the circle). A tilt of the axis is left to the
// direction of gravity: (-sin tilt, 0, -cos tilt) puts the bed on the end x = 0.
RigGeometry drum_geometry(GeometryInput& input);

// The rig named by the parameter `rig`.
RigGeometry rig_geometry(GeometryInput& input);

}  // namespace vielto

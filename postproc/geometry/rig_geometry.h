// SPDX-License-Identifier: GPL-2.0-or-later
// What a rig's geometry is to the rest of the program: meshes to write, numbers derived from them, and a record of the
// parameters they were made with. One NAME_geometry.cpp a rig, in postproc/rigs/NAME.
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

  // A path of the parameter file: a relative one starts from its folder. Not part of geometry.par.
  std::string file(const std::string& name) const;

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
  std::vector<std::string> inputs;                           // files it was made from, which it must not overwrite
  std::vector<std::pair<std::string, std::string>> files;    // further ones beside the meshes: name, text
};

}  // namespace vielto

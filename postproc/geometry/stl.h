// SPDX-License-Identifier: GPL-2.0-or-later
// STL files. Written as text with 12 digits (a binary STL's 7 digits would part nodes that LIGGGHTS must find equal
// within 1e-8 m). Read: text and binary, lines that end in LF or CRLF, binary files whose header begins with "solid"
// (they have the length that their number of triangles says). A file that is cut off is refused. Not vtkSTLReader: it
// is single precision, takes a cut-off file for a shorter one, and names no line.
#pragma once

#include <string>

#include "geometry/surface.h"

namespace vielto {

// Writes PATH.partial and renames it. Errors: std::runtime_error if it cannot be written.
void write_stl(const std::string& path, const std::string& name, const Triangles& triangles);

// In the file's own unit of length. Errors: BadInput with line for a file that cannot be read, is no STL, is cut off,
// holds no triangle or a number that is none.
Triangles read_stl(const std::string& path);

struct StlCheck {
  Measure measure;
  std::string fault;  // how LIGGGHTS 3.8 misreads the file, which goes by its first five letters; empty if it does not
};

// Reads the file and measures it. `closed` asks for a closed surface: BadInput if an edge is open or crowded, or a
// triangle has no area.
StlCheck check_stl(const std::string& path, bool closed);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// STL files: what LIGGGHTS reads. Written as text with 12 digits (a binary STL's 7 digits would part nodes that
// LIGGGHTS must find equal within 1e-8 m).
#pragma once

#include <string>

#include "geometry/surface.h"

namespace vielto {

// Writes PATH.partial and renames it. Errors: std::runtime_error if it cannot be written.
void write_stl(const std::string& path, const std::string& name, const Triangles& triangles);

// Errors: BadInput if the file is missing, empty, truncated or no STL, or holds a triangle without area.
Triangles read_stl(const std::string& path);

// Reads the file and measures it. `closed` asks for a closed surface: BadInput if an edge is open or crowded.
Measure check_stl(const std::string& path, bool closed);

}  // namespace vielto

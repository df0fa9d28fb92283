// SPDX-License-Identifier: GPL-2.0-or-later
// STL files as CAD programs write them, made into meshes that LIGGGHTS takes.
//
// Read: text and binary, lines that end in LF or CRLF, binary files whose header begins with "solid" (they have the
// length that their number of triangles says). A file that is cut off is refused. Not vtkSTLReader: it is single
// precision, takes a cut-off file for a shorter one, and names no line.
//
// Mended, each said: vertices nearer than kMergeDistance are one (LIGGGHTS takes neighbours by equal end points);
// triangles without area and copies of others are dropped; the faces of a shell get one orientation, closed shells
// outward (vtkPolyDataNormals); triangles with an angle below kLeastAngle are cut along their longest edge together
// with the neighbour there, which leaves the surface as it is (LIGGGHTS warns below 0.5 degrees and stops below 0.26).
#pragma once

#include <string>
#include <vector>

#include "geometry/surface.h"

namespace vielto {

constexpr double kMergeDistance = 1e-6;            // m; finer than any wall of a machine
constexpr double kLeastAngle = 1.0 * kPi / 180;    // rad
constexpr double kLeastTaken = 0.5 * kPi / 180;    // rad
constexpr std::size_t kMostTriangles = 2'000'000;  // of one part; some 200 MB

// In the file's own unit of length. Errors: BadInput with line for a file that cannot be read, is no STL, is cut off,
// holds no triangle or a number that is none.
Triangles read_own_stl(const std::string& path);

struct MendedMesh {
  Triangles triangles;
  Measure measure;
  std::vector<std::string> mended;  // "7 triangles without area dropped"
  std::string first_open_edge;      // its middle, "(0.1, 0, 0.2) m", if there is one
};

// `triangles` in m. Errors: BadInput naming `path` if nothing with an area is left, or too many triangles are needed.
MendedMesh mended_mesh(const std::string& path, const Triangles& triangles);

}  // namespace vielto

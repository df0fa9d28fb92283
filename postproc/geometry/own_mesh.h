// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes as CAD programs write them, made into meshes that LIGGGHTS takes.
//
// Mended, each said: vertices nearer than kMergeDistance are one (LIGGGHTS takes neighbours by equal end points);
// triangles without area and copies of others are dropped; the faces of a shell get one orientation, closed shells
// outward (vtkPolyDataNormals); triangles with an angle below kLeastAngle are cut anew, which leaves the surface as it
// is (slivers.h; LIGGGHTS warns below 0.5 degrees and stops below 0.26).
#pragma once

#include <string>
#include <vector>

#include "geometry/surface.h"

namespace vielto {

constexpr double kMergeDistance = 1e-6;            // m; finer than any wall of a machine
constexpr double kLeastAngle = 1.0 * kPi / 180;    // rad
constexpr double kLeastTaken = 0.5 * kPi / 180;    // rad
constexpr std::size_t kMostTriangles = 2'000'000;  // of one part; some 200 MB

struct MendedMesh {
  Triangles triangles;
  Measure measure;
  std::vector<std::string> mended;  // "7 triangles without area dropped"
  std::string first_open_edge;      // its middle, "(0.1, 0, 0.2) m", if there is one
};

// `triangles` in m. Errors: BadInput naming `path` if nothing with an area is left, or too many triangles are needed.
MendedMesh mended_mesh(const std::string& path, const Triangles& triangles);

}  // namespace vielto

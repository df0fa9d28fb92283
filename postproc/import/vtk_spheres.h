// SPDX-License-Identifier: GPL-2.0-or-later
// Places and radii from a .vtu or .vtp file: its points and the array `radii` or `radius` at them, of every piece.
//
// VTK's own readers of such files take memory by what a file says of its sizes, and read cells that nobody asked for.
// Here only these two arrays are read, with VTK's parser, and only after their sizes agree with the file's own.
//
// Errors: BadInput for a file that is none of its kind, is cut off, holds no grains or no radii, or whose sizes
// contradict one another or the file's length.
#pragma once

#include <string>
#include <vector>

#include "rigs/grain.h"

namespace vielto {

// `kind`: UnstructuredGrid or PolyData.
std::vector<Grain> read_vtk_spheres(const std::string& path, const std::string& kind);

}  // namespace vielto

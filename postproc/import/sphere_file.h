// SPDX-License-Identifier: GPL-2.0-or-later
// Places and radii of grains from a file: VTKRecorder's .vtu or .vtp (points with the array `radii` or `radius`), or
// text with columns x, y, z, r (Yade's export.text). Lengths times `factor` are m.
//
// Errors: BadInput for a file that cannot be read, holds no grains or no radii, or a value that is not finite or a
// radius that is not positive.
#pragma once

#include <string>
#include <vector>

#include "rigs/grain.h"

namespace vielto {

std::vector<Grain> read_spheres(const std::string& path, double factor = 1);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Place and radius of one grain, and how records hold them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/record_file.h"

namespace vielto {

struct Grain {
  std::array<double, 3> x{};  // m
  double radius = 0;          // m
};

// The rows x_m,y_m,z_m,radius_m of a record, as the script command `vielto grains` writes them. Errors: BadInput for a
// radius that is not above 0, and for no grain.
std::vector<Grain> read_grains(RecordFile& file, const std::string& path);

}  // namespace vielto

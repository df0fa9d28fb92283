// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "rigs/shearbox/shear_result.h"

namespace vielto {

// Shear stress and the plate's force over its area against the displacement: rows thin, block means thick, the steady
// part shaded.
// Errors: std::runtime_error if the file cannot be written.
void draw_shear(const ShearRecord& record, const ShearResult& result, const std::string& path);

}  // namespace vielto

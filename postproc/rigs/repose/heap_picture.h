// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "rigs/repose/cone_fit.h"

namespace vielto {

// The heap's profile: the surface of all strips, their mean, the fitted line, the flank shaded.
// Errors: std::runtime_error if the file cannot be written.
void draw_heap(const Heap& heap, const ConeFit& fit, const std::string& path);

}  // namespace vielto

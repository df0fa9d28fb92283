// SPDX-License-Identifier: GPL-2.0-or-later
// A table of rigs of a user's own (rig_table.h), read without adding it to those that there are.
#pragma once

#include <string>
#include <vector>

#include "core/rig_table.h"

namespace vielto {

// In the file's order; they may name those that there are. Errors: BadInput with file, line and key.
std::vector<RigDescription> read_rigs(const std::string& path);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The power of the grain from that of the loaded and of the empty machine.
#pragma once

#include <string>

#include "core/observation_table.h"

namespace vielto {

// `loaded` less `idle`; its u is that of independent rows.
// Errors: BadInput, with the line of `loaded`, if the machine takes less with grain than without by over three of that
// u.
Observation net_power(const std::string& path, int line, const Observation& loaded, const Observation& idle);

}  // namespace vielto

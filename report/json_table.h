// SPDX-License-Identifier: GPL-2.0-or-later
// Any JSON as a table of keys and values: "a.b[2].c".
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/page.h"

namespace vielto {

// The first 300 values; the caption says where that is not all.
Table json_table(const nlohmann::json& value);

}  // namespace vielto

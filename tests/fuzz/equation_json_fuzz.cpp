// SPDX-License-Identifier: GPL-2.0-or-later
#include <nlohmann/json.hpp>

#include "equation/power_equation.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("equation.json") { vielto::to_json(vielto::read_equation(path)).dump(); }

// SPDX-License-Identifier: GPL-2.0-or-later
#include <nlohmann/json.hpp>

#include "gap/library/rig.h"
#include "report/equation_pages.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("power.json") { vielto::booklet_plots({vielto::power_point(vielto::gap::read_json(path), path, "run")}); }

// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/measured_surface.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("surface.csv") { vielto::read_surface(path, {"x", "y", 0.001, false}, 0.042); }

// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/stl.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("part.stl") { vielto::check_stl(path, true); }

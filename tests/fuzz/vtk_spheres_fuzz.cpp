// SPDX-License-Identifier: GPL-2.0-or-later
// VTK's own reader of XML is in this one; it has no sanitizers in it.
#include "import/sphere_file.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("grains.vtu") { vielto::read_spheres(path); }

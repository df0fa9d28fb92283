// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/clump.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("clump.txt") { vielto::Clump::read(path, 10); }

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/rig_file.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("rigs.toml") { vielto::read_rigs(path); }

// SPDX-License-Identifier: GPL-2.0-or-later
// An observation table as fits use it: loaded less idle power.
#include "core/reduced_table.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("table.csv") { vielto::read_reduced_table(path); }

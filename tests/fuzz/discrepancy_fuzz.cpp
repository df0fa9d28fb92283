// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/discrepancy.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("discrepancy.csv") { vielto::gap::read_discrepancies(path); }

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/shearbox/shear_record.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("shear.csv") { vielto::read_shear_record(path); }

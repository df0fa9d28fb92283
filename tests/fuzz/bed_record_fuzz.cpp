// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/bed_angle.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("bed_1.csv") { vielto::read_bed_angle(path); }

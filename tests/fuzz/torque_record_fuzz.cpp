// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/torque_record.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("torque.csv") { vielto::read_torque_record(path); }

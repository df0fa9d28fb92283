// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/data_file.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("data.csv") { vielto::read_data_file(path); }

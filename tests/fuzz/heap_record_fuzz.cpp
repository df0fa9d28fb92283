// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/heap.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("heap.csv") { vielto::read_heap(path); }

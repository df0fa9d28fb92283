// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/settings.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("diagnosis.toml") { vielto::gap::Settings::read(path); }

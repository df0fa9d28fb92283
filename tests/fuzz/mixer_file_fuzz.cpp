// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/dimensionless_groups.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("mixer.par") { vielto::MixerDimensions::read(path); }

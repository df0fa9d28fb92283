// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/library_plan.h"
#include "tests/fuzz/harness.h"

using namespace vielto::gap;

VIELTO_FUZZ("plan.toml") {
  static const auto effects = read_effects(VIELTO_SOURCE_DIR "/libraries/effects",
                                           Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml"));
  LibraryPlan::read(path, effects, VIELTO_SOURCE_DIR);
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/dimensionless_groups.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("grain.par") {
  const vielto::BulkMaterial grain = vielto::BulkMaterial::read(path);
  vielto::groups_of(0.15, 1, vielto::MixerDimensions(), grain, &grain);
}

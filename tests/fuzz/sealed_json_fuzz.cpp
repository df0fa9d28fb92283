// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/seal.h"
#include "gap/question/sealed.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("isolability.json") {
  vielto::seal(path);
  vielto::gap::read_sealed(path);
}

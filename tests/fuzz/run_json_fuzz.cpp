// SPDX-License-Identifier: GPL-2.0-or-later
// What a run says of itself, as collect looks at it.
#include "gap/library/rig.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("run.json") {
  vielto::gap::changed_file(vielto::gap::read_json(path), {{"in.mixer", "0"}, {"mixer.par", "1"}});
}

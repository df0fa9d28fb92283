// SPDX-License-Identifier: GPL-2.0-or-later
// Columns of numbers, as torque over time and as places of grains.
#include "import/column_text.h"
#include "import/sampled_torque.h"
#include "import/sphere_file.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("plot.txt") {
  const vielto::ColumnText text = vielto::read_column_text(path);
  if (text.names.size() > 3)
    vielto::read_spheres(path);
  else if (text.names.size() > 1)
    vielto::sampled_torque(text, {text.names[0], text.names[1], 1, 1, {}, true}, 1);
}

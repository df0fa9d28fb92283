// SPDX-License-Identifier: GPL-2.0-or-later
// The grains that stay and, behind a line "---", the flow.
#include <iterator>

#include "rigs/silo/silo_discharge.h"
#include "tests/fuzz/harness.h"

using namespace vielto_fuzz;

VIELTO_FUZZ("silo.csv") {
  std::ifstream in(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto cut = text.find("---\n");
  write(folder().file("flow.csv"), cut == std::string::npos ? "" : text.substr(cut + 4));
  write(path, text.substr(0, cut));
  vielto::read_silo_discharge(path);
}

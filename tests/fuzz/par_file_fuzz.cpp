// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/par_file.h"
#include "core/par_range.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("rig.par") {
  const vielto::ParFile file = vielto::ParFile::read(path);
  for (const vielto::Parameter& p : file.all()) {
    const auto range = vielto::ParRange::parse(p.range);
    range.refusal(p.value, p.unit, [&](const std::string& name) {
      return file.has(name) ? vielto::parameter_number(file.find(name).value) : std::nullopt;
    });
    if (vielto::parameter_number(p.value)) file.number(p.name);
  }
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/effect.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("effect.toml") {
  static const auto settings = vielto::gap::Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml");
  const vielto::gap::Effect effect = vielto::gap::read_effect(path, settings);
  vielto::Observation row;
  row.apparatus = "mixer";
  row.observable = "power";
  row.speed = 1;
  row.fill = 0.15;
  const auto* transform = effect.transform_of("mixer", "power");
  if (transform && transform->operation != vielto::gap::Operation::shift)
    transform->reading(row, 20, effect.prior_high);
  effect.changes("mixer");
}

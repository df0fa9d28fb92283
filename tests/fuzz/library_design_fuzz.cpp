// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/library.h"
#include "tests/fuzz/harness.h"

using namespace vielto::gap;
using namespace vielto_fuzz;

VIELTO_FUZZ("design.csv") {
  static const auto effects = read_effects(VIELTO_SOURCE_DIR "/libraries/effects",
                                           Settings::read(VIELTO_SOURCE_DIR "/libraries/diagnosis.toml"));
  static const bool written = [] {
    std::string text =
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\n";
    for (int i = 1; i <= 8; ++i) text += "r" + std::to_string(i) + ",fit,mixer,power,20,1,W,1,0.15,,,,,,\n";
    write(folder().file("observations.csv"), text);
    return true;
  }();
  demand(written, "no table");
  Library::read(folder().path(), effects);
}

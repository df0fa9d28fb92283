// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/reduced_table.h"
#include "tests/fuzz/harness.h"

using namespace vielto_fuzz;

VIELTO_FUZZ("table.covariance.csv") {
  static const bool written = [] {
    std::string text =
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\n";
    for (const char* test : {"a", "b", "c"})
      for (const char* row : {"power_loaded,40,3", "power_idle,12,4"})
        text += std::string(test) + ",fit,mixer," + row + ",W,1,0.15,,,,,,\n";
    write(folder().file("table.csv"), text);
    return true;
  }();
  demand(written, "no table");
  vielto::read_reduced_table(folder().file("table.csv"));
}

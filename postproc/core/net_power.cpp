// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/net_power.h"

#include <fmt/format.h>

#include <cmath>

#include "core/bad_input.h"

namespace vielto {

Observation net_power(const std::string& path, int line, const Observation& loaded, const Observation& idle) {
  Observation power = loaded;
  power.observable = "power";
  power.value -= idle.value;
  power.u = std::hypot(loaded.u, idle.u);
  if (power.value < -3 * power.u)
    throw BadInput(path, line, "value",
                   fmt::format("power_loaded, {:.6g} W, is below power_idle, {:.6g} W", loaded.value, idle.value),
                   "check which is which: the machine takes more with grain than without");
  return power;
}

}  // namespace vielto

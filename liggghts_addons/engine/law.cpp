// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/law.h"

#include <stdio.h>

#include "engine/law_list.h"
#include "vielto_state.h"
#include "vielto_stop.h"

namespace vielto {

#define VIELTO_LAW(NAME) Law describe_##NAME();
VIELTO_LAWS
#undef VIELTO_LAW

std::string range_of(const PropertyRule& rule) {
  const auto bound = [](double x) {
    char text[40];
    snprintf(text, sizeof text, "%g", x);
    return std::string(text);
  };
  return (rule.lowAllowed ? "[" : "(") + bound(rule.low) + ", " + bound(rule.high) + (rule.highAllowed ? "]" : ")");
}

std::string models_of(const Law& law) {
  std::string text = "model " + law.normal;
  if (!law.tangential.empty()) text += " tangential " + law.tangential;
  for (std::size_t k = 0; k < law.cohesions.size(); k++)
    text += (k == 0 ? " [cohesion " : "|") + law.cohesions[k] + (k + 1 == law.cohesions.size() ? "]" : "");
  if (!law.rolling.empty()) text += " rolling_friction " + law.rolling;
  return text;
}

const std::vector<Law>& laws() {
#define VIELTO_LAW(NAME) describe_##NAME(),
  static const std::vector<Law> all = {VIELTO_LAWS};
#undef VIELTO_LAW
  return all;
}

const Law* find_law(const std::string& name) {
  for (const Law& law : laws())
    if (law.name == name) return &law;
  return nullptr;
}

const Law* find_law(int id) {
  for (const Law& law : laws())
    if (law.id == id) return &law;
  return nullptr;
}

std::string law_names() {
  std::string names;
  for (std::size_t k = 0; k < laws().size(); k++)
    names += (k == 0 ? "" : k + 1 == laws().size() ? " or " : ", ") + laws()[k].name;
  return names;
}

const Law& law_in_use(LAMMPS_NS::LAMMPS* lmp, const char* who) {
  const Law* law = find_law(settings().law);
  if (!law) {
    const std::string line = std::string("vielto: ") + who +
                             " needs 'pair_style gran model vielto ...' (or another law of this package) before it";
    stop_all(lmp, line.c_str());
  }
  return *law;
}

}  // namespace vielto

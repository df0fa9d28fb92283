// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/condition.h"

#include <fmt/format.h>

namespace vielto {

std::string conditions_text(const Observation& row) {
  std::string text;
  for (const NamedCondition& c : kConditions)
    if (row.*c.member) text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", c.name, *(row.*c.member));
  return text;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Kinds of withheld cases: none, no effect; known, one effect at a stated level; removed, its group is taken from the
// diagnoser; sham, another group is; pair, two effects; prior, one at a strength drawn from its prior.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vielto::gap {

enum class CaseKind { none, known, removed, sham, pair, prior };

inline std::string text_of(CaseKind kind) {
  switch (kind) {
    case CaseKind::none:
      return "none";
    case CaseKind::known:
      return "known";
    case CaseKind::removed:
      return "removed";
    case CaseKind::sham:
      return "sham";
    case CaseKind::pair:
      return "pair";
    case CaseKind::prior:
      break;
  }
  return "prior";
}

// Nothing for another word.
inline std::optional<CaseKind> case_kind_of(std::string_view text) {
  for (const CaseKind kind :
       {CaseKind::none, CaseKind::known, CaseKind::removed, CaseKind::sham, CaseKind::pair, CaseKind::prior})
    if (text == text_of(kind)) return kind;
  return std::nullopt;
}

}  // namespace vielto::gap

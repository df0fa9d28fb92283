// SPDX-License-Identifier: GPL-2.0-or-later
// What an answer (diagnosis.json) says of a gap: no_gap, nothing beyond what u and the seeds explain; named, one cause
// or two; ambiguous, one of a group of causes that act alike; unknown, something that the library has not.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vielto::gap {

enum class Verdict { no_gap, named, ambiguous, unknown };

inline std::string text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_gap:
      return "no_gap";
    case Verdict::named:
      return "named";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::unknown:
      break;
  }
  return "unknown";
}

// Nothing for another word.
inline std::optional<Verdict> verdict_of(std::string_view text) {
  for (const Verdict verdict : {Verdict::no_gap, Verdict::named, Verdict::ambiguous, Verdict::unknown})
    if (text == text_of(verdict)) return verdict;
  return std::nullopt;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/par_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace vielto {
namespace {

// No parameter of a run is larger or, but for 0, smaller than these: beyond them it is a slip, and steps cannot be
// counted any more.
constexpr double kLeastSize = 1e-15, kMostSize = 1e15;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Takes `word` and the blank after it off the text's beginning.
bool take(std::string& text, const std::string& word) {
  if (text.rfind(word + " ", 0) != 0) return false;
  text = trimmed(text.substr(word.size()));
  return true;
}

std::vector<std::string> choices(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> list;
  for (std::string word; in >> word;)
    if (word != "or") list.push_back(word.back() == ',' ? word.substr(0, word.size() - 1) : word);
  return list;
}

bool is_name(const std::string& text) {
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

// "0.006 m", or "0.006" of what has no unit
std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() || unit == "1" || unit == "-" ? number : number + " " + unit;
}

}  // namespace

std::optional<double> parameter_number(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

ParRange::Bound ParRange::bound(const std::string& text, bool included) {
  Bound made;
  made.included = included;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    Term term;
    term.text = trimmed(part);
    std::istringstream words(term.text);
    std::string first, rest;
    words >> first >> rest;
    const std::optional<double> factor = parameter_number(first);
    term.factor = factor.value_or(1);
    term.name = factor ? rest : first;
    std::string more;
    if (term.name == "to" || (!factor && !rest.empty()) || (!term.name.empty() && !is_name(term.name)) ||
        words >> more || first.empty())
      throw std::invalid_argument(text);
    made.terms.push_back(term);
  }
  if (made.terms.empty()) throw std::invalid_argument(text);
  return made;
}

ParRange ParRange::parse(const std::string& text) {
  ParRange range;
  std::string rest = trimmed(text);
  if (rest.empty() || rest == "-") return range;
  if (rest.find(" or ") != std::string::npos) {
    range.kind_ = Kind::words;
    range.words_ = choices(rest);
    return range;
  }
  range.kind_ = Kind::number;
  if (rest == "any" || rest == "law") return range;
  range.whole_ = take(rest, "whole");
  if (take(rest, ">=")) {
    range.low_ = bound(rest, true);
    if (rest.find(" to ") != std::string::npos) throw std::invalid_argument(text);
    return range;
  }
  const bool above = take(rest, ">");
  const auto to = rest.find(" to ");
  if (to == std::string::npos && !above) throw std::invalid_argument(text);
  range.low_ = bound(rest.substr(0, to), !above);
  if (to == std::string::npos) return range;
  std::string high = trimmed(rest.substr(to + 4));
  const bool below = take(high, "<");
  range.high_ = bound(high, !below);
  return range;
}

std::vector<std::string> ParRange::depends_on() const {
  std::vector<std::string> names;
  for (const Bound* b : {&low_, &high_})
    for (const Term& t : b->terms)
      if (!t.name.empty()) names.push_back(t.name);
  return names;
}

// Of bounds that are several parts the one that holds; nullptr if none is known.
const ParRange::Term* ParRange::tightest(const Bound& bound, bool upper, const Lookup& lookup, double& value) {
  const Term* found = nullptr;
  for (const Term& term : bound.terms) {
    const std::optional<double> of = term.name.empty() ? std::optional<double>(1) : lookup(term.name);
    if (!of) continue;
    const double now = term.factor * *of;
    if (!found || (upper ? now < value : now > value)) {
      found = &term;
      value = now;
    }
  }
  return found;
}

std::optional<std::string> ParRange::refusal(const std::string& value, const std::string& unit,
                                             const Lookup& lookup) const {
  if (kind_ == Kind::text) return std::nullopt;
  if (kind_ == Kind::words) {
    if (std::find(words_.begin(), words_.end(), value) != words_.end()) return std::nullopt;
    std::vector<std::string> most(words_.begin(), words_.end() - 1);
    return fmt::format("{} or {}", fmt::join(most, ", "), words_.back());
  }
  const std::optional<double> number = parameter_number(value);
  if (!number) {
    const char* hint = value.find(',') != std::string::npos   ? "with a decimal point, "
                       : value.find('%') != std::string::npos ? "as a part of 1, "
                                                              : "";
    return fmt::format("a number ({}{})", hint, unit.empty() ? "1" : unit);
  }
  if (*number != 0 && !(std::fabs(*number) >= kLeastSize && std::fabs(*number) <= kMostSize))
    return fmt::format("a number from {:g} to {:g} in size ({})", kLeastSize, kMostSize, unit.empty() ? "1" : unit);
  double least = 0, most = 0;
  const Term* low = tightest(low_, false, lookup, least);
  const Term* high = tightest(high_, true, lookup, most);
  const bool too_low = low && (low_.included ? *number < least : *number <= least);
  const bool too_high = high && (high_.included ? *number > most : *number >= most);
  const bool broken = whole_ && *number != std::floor(*number);
  if (!too_low && !too_high && !broken) return std::nullopt;
  const auto said = [&](const Term& term, double bound) {
    return term.name.empty() ? term.text
                             : fmt::format("{} ({})", term.text, with_unit(fmt::format("{:.6g}", bound), unit));
  };
  std::string text = whole_ ? "a whole number " : "";
  if (low && high && low_.included && high_.included)
    return fmt::format("{}{}{} to {}", text, whole_ ? "from " : "", said(*low, least), said(*high, most));
  if (low) text += (low_.included ? ">= " : "> ") + said(*low, least);
  if (low && high) text += " and ";
  if (high) text += (high_.included ? "at most " : "< ") + said(*high, most);
  return text;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The values that a parameter may take: the range field of a parameter file's line (par_file.h).
//   > 0                          0 to 0.5                     > 0 to 0.05 (0 left out)     0 to < 90 (90 left out)
//   whole >= 1                   off or on                    plain, rough or mixed        any (a number)
//   > 0 to 0.1 boxWidth, 0.2 boxHeight    at most the smallest of these parts of other parameters
//   law                          a number, and the contact law's own range holds
//   -                            any text
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vielto {

class ParRange {
 public:
  // Value of another parameter, for bounds that are parts of it; nothing if it is not known (yet).
  using Lookup = std::function<std::optional<double>(const std::string& name)>;

  // Errors: std::invalid_argument if the text is no range.
  static ParRange parse(const std::string& text);

  // Why the value is refused: what to give instead, "a whole number >= 1"; nothing if it is good. A bound that is part
  // of an unknown parameter does not hold anything back. `unit`: of the bounds, said beside them.
  std::optional<std::string> refusal(const std::string& value, const std::string& unit, const Lookup& lookup) const;

  bool is_number() const { return kind_ == Kind::number; }
  const std::vector<std::string>& words() const { return words_; }
  // Names of the parameters that bounds are parts of.
  std::vector<std::string> depends_on() const;

 private:
  enum class Kind { text, number, words };
  struct Term {
    double factor = 1;
    std::string name;  // empty: the factor is the bound
    std::string text;
  };
  struct Bound {
    std::vector<Term> terms;  // none: no bound
    bool included = true;
  };
  static Bound bound(const std::string& text, bool included);
  static const Term* tightest(const Bound& bound, bool upper, const Lookup& lookup, double& value);

  Kind kind_ = Kind::text;
  bool whole_ = false;
  Bound low_, high_;
  std::vector<std::string> words_;
};

// A finite decimal number that fills the whole text, as LIGGGHTS reads one: no blanks, no comma, no hexadecimal digits.
std::optional<double> parameter_number(const std::string& text);

}  // namespace vielto

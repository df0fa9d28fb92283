// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/observation_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <utility>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/csv.h"
#include "core/rig_table.h"

namespace vielto {
namespace {

// Columns before the conditions; wall and material come after them.
constexpr std::size_t kFirst = 7;
const std::string kHeader = [] {
  std::string text = "test,role,apparatus,observable,value,u,unit";
  for (const NamedCondition& c : kConditions) text += std::string(",") + c.name;
  return text + ",wall,material";
}();
const std::string kCovarianceHeader = "test_a,observable_a,test_b,observable_b,covariance";

using Key = std::pair<std::string, std::string>;

// One row of a table that is being read or written, with what is needed to say where a fault is.
struct Place {
  const std::string& path;
  int line;

  [[noreturn]] void refuse(const std::string& column, const std::string& what, const std::string& mend) const {
    throw BadInput(path, line, column, what, mend);
  }
  void name(const std::string& column, const std::string& text) const {
    if (text.find_first_of(",\"") != std::string::npos || !is_plain_utf8(text))
      refuse(column, "holds a comma, a quote, a control character or a byte that is not UTF-8",
             "use a plain UTF-8 name");
    if (!text.empty() && (text.front() == ' ' || text.back() == ' '))
      refuse(column, fmt::format("'{}' has a space at its edge", text), "remove the space");
  }
  double number(const std::string& column, std::string_view field) const {
    const auto value = finite_number(field);
    if (!value)
      refuse(column, fmt::format("'{}' is not a finite number", field), "write a decimal number, such as 0.5");
    return *value;
  }
};

[[noreturn]] void refuse_role(std::string_view text, const Place& place) {
  place.refuse("role", fmt::format("'{}' is no role", text), "write 'fit' or 'check'");
}

// Checks that need the whole table: keys once, rows of one test under the same conditions.
class TableCheck {
 public:
  void add(const Observation& row, const Place& place) {
    for (const auto& [column, text] : {std::pair<const char*, const std::string&>{"test", row.test},
                                       {"apparatus", row.apparatus},
                                       {"observable", row.observable},
                                       {"unit", row.unit},
                                       {"wall", row.wall},
                                       {"material", row.material}})
      place.name(column, text);
    if (row.test.empty()) place.refuse("test", "is empty", "name the test");
    if (!role_of(text_of(row.role))) refuse_role(text_of(row.role), place);
    const auto unit = observable_unit(row.apparatus, row.observable);
    if (!unit) refuse_observable(row, place);
    if (row.unit != *unit)
      place.refuse("unit", fmt::format("'{}' is not the unit of {}", row.unit, row.observable),
                   fmt::format("state the value in '{}'", *unit));
    if (!std::isfinite(row.value)) place.refuse("value", "is not finite", "state a finite value");
    if (!(row.u * row.u > 0) || !(row.u > 0) || !std::isfinite(row.u * row.u))
      place.refuse("u", fmt::format("{} is no standard uncertainty", row.u), "state one above 0");
    possible(row, place);
    for (const NamedCondition& c : kConditions) {
      const auto& value = row.*c.member;
      if (value && !(*value >= c.low && *value <= c.high))
        place.refuse(c.name, fmt::format("{} is out of range", *value),
                     fmt::format("state a value from {} to {}", c.low, c.high));
    }
    add_to_test(row, place);
  }

 private:
  // What no error of measurement gives: a slope over 90 degrees; a value surely below zero where the table of rigs has
  // one sign
  void possible(const Observation& row, const Place& place) const {
    if (row.unit == "deg" && !(std::fabs(row.value) < 90))
      place.refuse("value", fmt::format("{} is {} degrees", row.observable, row.value), "state an angle below 90");
    const NamedObservable* const named = find_observable(row.apparatus, row.observable);
    if (named && !named->any_sign && row.value < -4 * row.u)
      place.refuse("value", fmt::format("{} is {}, which is surely below 0", row.observable, row.value),
                   "turn its sign");
  }
  void refuse_observable(const Observation& row, const Place& place) const {
    std::vector<std::string> names;
    for (const NamedObservable& o : observables_of(row.apparatus)) names.push_back(o.name);
    if (names.empty())
      place.refuse("apparatus", fmt::format("'{}' is no apparatus", row.apparatus),
                   fmt::format("write one of {}", apparatus_names()));
    place.refuse("observable", fmt::format("'{}' is no observable of {}", row.observable, row.apparatus),
                 fmt::format("write one of {}", fmt::join(names, ", ")));
  }

  void add_to_test(const Observation& row, const Place& place) {
    const auto [seen, is_new] = lines_.emplace(Key(row.test, row.observable), place.line);
    if (!is_new)
      place.refuse("observable",
                   fmt::format("test '{}' states {} twice (first in line {})", row.test, row.observable, seen->second),
                   "name the repeats as tests of their own");
    const auto [first, is_first] = tests_.emplace(row.test, std::pair(row, place.line));
    if (is_first) return;
    const auto& other = first->second.first;
    const auto other_line = first->second.second;  // no binding: a lambda below takes it
    const auto same = [&](const char* column, bool equal) {
      if (!equal)
        place.refuse(column, fmt::format("differs from line {} of the same test '{}'", other_line, row.test),
                     "give the rows of one test the same conditions, or two names");
    };
    for (const NamedCondition& c : kConditions) same(c.name, row.*c.member == other.*c.member);
    same("wall", row.wall == other.wall);
    same("material", row.material == other.material);
  }

  std::map<Key, int> lines_;
  std::map<std::string, std::pair<Observation, int>> tests_;
};

// Calls `use(place, fields)` for each row below the header; refuses another header and rows of another length.
template <class Use>
void read_rows(const std::string& path, const std::string& header, Use use) {
  std::ifstream in;
  std::string line = open_table(in, path);
  expect_header(path, line, header);
  std::vector<std::string_view> names, fields;
  split_fields(header, names);
  int number = 1;
  while (std::getline(in, line)) {
    const Place place{path, ++number};
    split_fields(line, fields);
    if (fields.size() != names.size())
      throw BadInput(path, number, fmt::format("has {} fields instead of {}", fields.size(), names.size()),
                     "write one value a column, empty where not applicable, without blank lines");
    use(place, fields);
  }
  if (number == 1) throw BadInput(path, 0, "holds no row below its header", "add at least one row");
}

Observation parsed(const Place& place, const std::vector<std::string_view>& f) {
  Observation row;
  row.test = f[0];
  const std::optional<Role> role = role_of(f[1]);
  if (!role) refuse_role(f[1], place);
  row.role = *role;
  row.apparatus = f[2];
  row.observable = f[3];
  row.value = place.number("value", f[4]);
  row.u = place.number("u", f[5]);
  row.unit = f[6];
  std::size_t column = kFirst;
  for (const NamedCondition& c : kConditions) {
    const std::string_view field = f[column++];
    if (!field.empty()) row.*c.member = place.number(c.name, field);
  }
  row.wall = f[column];
  row.material = f[column + 1];
  return row;
}

}  // namespace

const char* text_of(Role role) {
  switch (role) {
    case Role::fit:
      return "fit";
    case Role::check:
      return "check";
    case Role::reference:
      break;
  }
  return "reference";
}

std::optional<Role> role_of(std::string_view text) {
  for (const Role role : {Role::fit, Role::check})
    if (text == text_of(role)) return role;
  return std::nullopt;
}

Observation TestLabel::row(const std::string& apparatus, const std::string& material,
                           const std::string& its_wall) const {
  Observation row;
  row.test = test;
  row.role = role;
  row.apparatus = apparatus;
  row.moisture = moisture;
  row.wall = wall.empty() ? its_wall : wall;
  row.material = material;
  return row;
}

std::optional<std::string> observable_unit(const std::string& apparatus, const std::string& observable) {
  const NamedObservable* found = find_observable(apparatus, observable);
  return found ? std::optional(found->unit) : std::nullopt;
}

Observation with_value(Observation row, const std::string& observable, double value, double u) {
  row.observable = observable;
  row.unit = observable_unit(row.apparatus, observable).value();
  row.value = value;
  row.u = u;
  return row;
}

std::vector<Observation> read_observations(const std::string& path) {
  std::vector<Observation> rows;
  TableCheck check;
  read_rows(path, kHeader, [&](const Place& place, const std::vector<std::string_view>& f) {
    rows.push_back(parsed(place, f));
    check.add(rows.back(), place);
  });
  return rows;
}

void for_each_test(const std::string& path, const std::function<void(const std::vector<NumberedObservation>&)>& use) {
  std::vector<NumberedObservation> test;
  std::vector<std::size_t> hashes;  // of the names of all tests
  TableCheck check;
  const auto finish = [&] {
    if (test.empty()) return;
    hashes.push_back(std::hash<std::string>()(test.front().row.test));
    use(test);
    test.clear();
    check = TableCheck();
  };
  read_rows(path, kHeader, [&](const Place& place, const std::vector<std::string_view>& f) {
    if (!test.empty() && test.front().row.test != f[0]) finish();
    test.push_back({parsed(place, f), place.line});
    check.add(test.back().row, place);
  });
  finish();

  std::sort(hashes.begin(), hashes.end());
  const auto twice = std::adjacent_find(hashes.begin(), hashes.end());
  if (twice == hashes.end()) return;
  std::map<std::string, int> last;  // line, of the tests with this hash
  read_rows(path, kHeader, [&](const Place& place, const std::vector<std::string_view>& f) {
    const std::string name(f[0]);
    if (std::hash<std::string>()(name) != *twice) return;
    const auto [seen, is_new] = last.emplace(name, place.line);
    if (!is_new && seen->second != place.line - 1)
      place.refuse("test", fmt::format("'{}' stands in line {} too, with other tests between", name, seen->second),
                   "keep the rows of a test together in a table this long, and name repeats as tests of their own");
    seen->second = place.line;
  });
}

void write_observations(const std::string& path, const std::vector<Observation>& rows) {
  if (rows.empty()) throw BadInput(path, 0, "would hold no row", "state at least one observation");
  TableCheck check;
  std::string text = kHeader + "\n";
  int line = 1;
  for (const Observation& row : rows) {
    check.add(row, Place{path, ++line});
    text += fmt::format("{},{},{},{},{},{},{}", row.test, text_of(row.role), row.apparatus, row.observable,
                        number_text(row.value), number_text(row.u), row.unit);
    for (const NamedCondition& c : kConditions) text += "," + (row.*c.member ? number_text(*(row.*c.member)) : "");
    text += fmt::format(",{},{}\n", row.wall, row.material);
  }
  write_whole_file(path, text);
}

std::vector<Covariance> read_covariances(const std::string& path, const std::vector<Observation>& rows) {
  std::map<Key, double> u;
  for (const Observation& row : rows) u[Key(row.test, row.observable)] = row.u;
  std::map<std::pair<Key, Key>, int> lines;
  std::vector<Covariance> covariances;
  read_rows(path, kCovarianceHeader, [&](const Place& place, const std::vector<std::string_view>& f) {
    const Key a{f[0], f[1]}, b{f[2], f[3]};
    for (const auto& [key, column] : {std::pair(a, "test_a"), std::pair(b, "test_b")})
      if (u.count(key) == 0)
        place.refuse(column, fmt::format("test '{}' has no {} in the observation table", key.first, key.second),
                     "name a row of the table");
    if (a == b) place.refuse("test_b", "is the row itself", "state a row's own variance as its u");
    if (const auto [seen, is_new] = lines.emplace(std::minmax(a, b), place.line); !is_new)
      place.refuse("test_b", fmt::format("pairs the same rows as line {}", seen->second), "keep one of the two");
    const double covariance = place.number("covariance", f[4]);
    const double limit = u[a] * u[b];
    // Rounded decimals may overshoot a full correlation in the last digit.
    if (std::fabs(covariance) > limit * (1 + 1e-9))
      place.refuse("covariance", fmt::format("{} is more than the product of both u, {}", covariance, limit),
                   "state a correlation between -1 and 1");
    covariances.push_back({a.first, a.second, b.first, b.second, covariance});
  });
  return covariances;
}

}  // namespace vielto

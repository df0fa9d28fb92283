// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/csv.h"
#include "core/statistics.h"
#include "equation/weights.h"

namespace vielto {
namespace {

struct NameColumn {
  const char* name;
  std::string Observation::*member;
};
constexpr NameColumn kNames[] = {{"wall", &Observation::wall}, {"material", &Observation::material}};

std::vector<std::string> condition_columns() {
  std::vector<std::string> names;
  for (const NamedCondition& c : kConditions) names.emplace_back(c.name);
  for (const NameColumn& c : kNames) names.emplace_back(c.name);
  return names;
}

// "speed 0.48 fill 0.1 material hulled_millet": the stated conditions.
std::string conditions(const Observation& row, const std::set<std::string>& ignored) {
  std::string text;
  for (const NamedCondition& c : kConditions)
    if (ignored.count(c.name) == 0 && row.*c.member) text += fmt::format(" {} {:.6g}", c.name, *(row.*c.member));
  for (const NameColumn& c : kNames)
    if (ignored.count(c.name) == 0 && !(row.*c.member).empty()) text += fmt::format(" {} {}", c.name, row.*c.member);
  return text;
}

using Rows = std::vector<int>;

// Row indices by apparatus, observable and conditions.
std::map<std::string, Rows> by_conditions(const ReducedTable& table, const std::set<std::string>& ignored) {
  std::map<std::string, Rows> groups;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Observation& row = table.rows[i];
    groups[row.apparatus + " " + row.observable + conditions(row, ignored)].push_back(static_cast<int>(i));
  }
  return groups;
}

// The rows of each table that make one pair.
using Match = std::pair<Rows, Rows>;

std::vector<Match> match(const ReducedTable& a, const ReducedTable& b, Rows rows_a, Rows rows_b) {
  std::vector<Match> matches;
  for (auto i = rows_a.begin(); i != rows_a.end();) {
    const auto j = std::find_if(rows_b.begin(), rows_b.end(), [&](int k) { return b.rows[k].test == a.rows[*i].test; });
    if (j == rows_b.end()) {
      ++i;
      continue;
    }
    matches.push_back({{*i}, {*j}});
    rows_b.erase(j);
    i = rows_a.erase(i);
  }
  if (!rows_a.empty() && !rows_b.empty()) matches.push_back({rows_a, rows_b});
  return matches;
}

// Mean of rows as a row of the map from the table to the pairs.
Observation mean_row(const ReducedTable& table, const Rows& rows, int pair, std::vector<Eigen::Triplet<double>>& map) {
  Observation mean = table.rows[rows.front()];
  mean.value = 0;
  for (const int i : rows) {
    mean.value += table.rows[i].value / static_cast<double>(rows.size());
    map.emplace_back(pair, i, 1.0 / static_cast<double>(rows.size()));
  }
  return mean;
}

Eigen::SparseMatrix<double> covariance_of_means(const ReducedTable& table, std::size_t pairs,
                                                const std::vector<Eigen::Triplet<double>>& map) {
  Eigen::SparseMatrix<double> t(static_cast<int>(pairs), static_cast<int>(table.rows.size()));
  t.setFromTriplets(map.begin(), map.end());
  return t * table.covariance * t.transpose();
}

std::vector<std::string> without_partner(const ReducedTable& table, const std::vector<bool>& paired) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (!paired[i]) names.push_back(table.rows[i].test + " " + table.rows[i].observable);
  return names;
}

std::vector<GapSummary> summarise(const std::vector<ComparedPair>& pairs) {
  std::vector<GapSummary> summaries;
  for (const ComparedPair& p : pairs) {
    auto s = std::find_if(summaries.begin(), summaries.end(), [&](const GapSummary& g) {
      return g.apparatus == p.a.apparatus && g.observable == p.a.observable;
    });
    if (s == summaries.end()) {
      summaries.push_back({p.a.apparatus, p.a.observable});
      s = summaries.end() - 1;
    }
    ++s->pairs;
    s->mean_gap += p.gap;
    s->rms_gap += p.gap * p.gap;
    s->max_gap = std::max(s->max_gap, std::fabs(p.gap));
    s->mean_z += p.z;
    s->max_z = std::max(s->max_z, std::fabs(p.z));
  }
  for (GapSummary& s : summaries) {
    s.mean_gap /= s.pairs;
    s.rms_gap = std::sqrt(s.rms_gap / s.pairs);
    s.mean_z /= s.pairs;
  }
  return summaries;
}

}  // namespace

Comparison compare(const ReducedTable& a, const ReducedTable& b, const std::set<std::string>& ignored) {
  for (const std::string& name : ignored) {
    const auto is = [&](const auto& column) { return name == column.name; };
    if (!condition_member(name) && std::none_of(std::begin(kNames), std::end(kNames), is))
      throw BadInput("--ignore", 0, fmt::format("'{}' is no condition", name),
                     fmt::format("choose from {}", fmt::join(condition_columns(), ", ")));
  }
  const auto groups_a = by_conditions(a, ignored), groups_b = by_conditions(b, ignored);
  std::vector<Match> matches;
  for (const auto& [key, rows] : groups_a)
    if (const auto partner = groups_b.find(key); partner != groups_b.end())
      for (const Match& m : match(a, b, rows, partner->second)) matches.push_back(m);
  if (matches.empty())
    throw BadInput(b.path, 0, fmt::format("has no row under the conditions of a row of {}", a.path),
                   "leave out conditions that differ with --ignore");
  std::sort(matches.begin(), matches.end());

  Comparison result;
  std::vector<bool> paired_a(a.rows.size()), paired_b(b.rows.size());
  std::vector<Eigen::Triplet<double>> map_a, map_b;
  for (const Match& m : matches) {
    const int pair = static_cast<int>(result.pairs.size());
    ComparedPair p;
    p.a = mean_row(a, m.first, pair, map_a);
    p.b = mean_row(b, m.second, pair, map_b);
    p.rows_a = static_cast<int>(m.first.size());
    p.rows_b = static_cast<int>(m.second.size());
    result.pairs.push_back(p);
    for (const int i : m.first) paired_a[i] = true;
    for (const int i : m.second) paired_b[i] = true;
  }
  const auto va = covariance_of_means(a, matches.size(), map_a), vb = covariance_of_means(b, matches.size(), map_b);
  const Eigen::SparseMatrix<double> v = va + vb;
  Eigen::VectorXd d(result.pairs.size());
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    ComparedPair& p = result.pairs[i];
    const int k = static_cast<int>(i);
    p.a.u = std::sqrt(va.coeff(k, k));
    p.b.u = std::sqrt(vb.coeff(k, k));
    d[k] = p.b.value - p.a.value;
    p.gap = p.b.value / p.a.value - 1;
    p.z = d[k] / std::sqrt(v.coeff(k, k));
  }
  try {
    result.chi2 = Weights::correlated(v).whiten(d).squaredNorm();
    result.chi2_exceedance = chi2_exceedance(*result.chi2, static_cast<double>(d.size()));
  } catch (const std::invalid_argument&) {
    // Rows that repeat one datum in both tables have z, but no common chi2.
  }
  result.only_a = without_partner(a, paired_a);
  result.only_b = without_partner(b, paired_b);
  result.summaries = summarise(result.pairs);
  return result;
}

std::string comparison_csv(const Comparison& comparison) {
  std::string text =
      fmt::format("apparatus,observable,unit,{},test_a,rows_a,value_a,u_a,test_b,rows_b,value_b,u_b,relative_gap,z\n",
                  fmt::join(condition_columns(), ","));
  for (const ComparedPair& p : comparison.pairs) {
    text += fmt::format("{},{},{}", p.a.apparatus, p.a.observable, p.a.unit);
    for (const NamedCondition& c : kConditions) text += "," + (p.a.*c.member ? number_text(*(p.a.*c.member)) : "");
    text += fmt::format(",{},{},{},{},{},{},{},{},{},{},{},{}\n", p.a.wall, p.a.material, p.a.test, p.rows_a,
                        number_text(p.a.value), number_text(p.a.u), p.b.test, p.rows_b, number_text(p.b.value),
                        number_text(p.b.u), number_text(p.gap), number_text(p.z));
  }
  return text;
}

std::string comparison_text(const Comparison& comparison) {
  std::string text = fmt::format("{:<24}{:<22}{:>11}{:>10}{:>11}{:>10}{:>10}{:>8}\n", "test", "observable", "A", "u",
                                 "B", "u", "B/A - 1", "z");
  for (const ComparedPair& p : comparison.pairs) {
    const std::string test = p.a.test == p.b.test ? p.a.test : p.a.test + " / " + p.b.test;
    const std::string means = p.rows_a + p.rows_b > 2 ? fmt::format("  means of {} and {}", p.rows_a, p.rows_b) : "";
    text +=
        fmt::format("{:<24}{:<22}{:>11.4g}{:>10.2g}{:>11.4g}{:>10.2g}{:>+8.1f} %{:>+8.2f}{}{}\n", test, p.a.observable,
                    p.a.value, p.a.u, p.b.value, p.b.u, 100 * p.gap, p.z, conditions(p.a, {}), means);
  }
  text += "\n";
  for (const GapSummary& s : comparison.summaries)
    text += fmt::format(
        "{} {}: {} pairs, gap mean {:+.1f} %, rms {:.1f} %, largest {:.1f} %; z mean {:+.2f}, largest "
        "{:.2f}\n",
        s.apparatus, s.observable, s.pairs, 100 * s.mean_gap, 100 * s.rms_gap, 100 * s.max_gap, s.mean_z, s.max_z);
  if (comparison.chi2)
    text += fmt::format("chi2 {:.4g} for {} pairs (p = {:.2g})\n", *comparison.chi2, comparison.pairs.size(),
                        comparison.chi2_exceedance);
  else
    text += "no common chi2: the covariance of the differences is not positive definite\n";
  if (!comparison.only_a.empty()) text += fmt::format("only in A: {}\n", fmt::join(comparison.only_a, ", "));
  if (!comparison.only_b.empty()) text += fmt::format("only in B: {}\n", fmt::join(comparison.only_b, ", "));
  return text;
}

}  // namespace vielto

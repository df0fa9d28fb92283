// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/repeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core/condition.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// What the repeats cannot exclude yet: three times the library's scatter, with the weight of three degrees of freedom.
constexpr double kAssumedTimesLibrary = 3;
constexpr int kAssumedDegrees = 3;

std::string place_of(const Observation& row, bool with_role) {
  return fmt::format("{},{},{},{},{},{}", row.apparatus, row.observable, conditions_text(row), row.wall, row.material,
                     with_role ? text_of(row.role) : "");
}

// Row numbers of each group, in the order of their first rows.
std::vector<std::vector<Index>> groups_of(const std::vector<Observation>& rows, bool with_role) {
  std::map<std::string, std::size_t> number;
  std::vector<std::vector<Index>> groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [at, is_new] = number.emplace(place_of(rows[i], with_role), groups.size());
    if (is_new) groups.emplace_back();
    groups[at->second].push_back(static_cast<Index>(i));
  }
  return groups;
}

bool above_zero(const std::vector<Observation>& rows, const std::vector<Index>& group) {
  return std::all_of(group.begin(), group.end(), [&](Index i) { return rows[static_cast<std::size_t>(i)].value > 0; });
}

// How much wider than normal the limits of a scatter known to so many degrees of freedom are, squared.
double widening(int degrees) {
  constexpr double kQuantile = 0.995;
  const double t = boost::math::quantile(boost::math::students_t(degrees), kQuantile);
  return std::pow(t / boost::math::quantile(boost::math::normal(), kQuantile), 2);
}

}  // namespace

Averaged averaged(const ReducedTable& table) {
  Averaged result{table, {}};
  result.table.rows.clear();
  result.table.lines.clear();
  const auto groups = groups_of(table.rows, true);
  MatrixXd map = MatrixXd::Zero(static_cast<Index>(groups.size()), static_cast<Index>(table.rows.size()));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::size_t first = static_cast<std::size_t>(groups[g].front());
    const double k = static_cast<double>(groups[g].size());
    const bool logarithmic = above_zero(table.rows, groups[g]);
    double sum = 0;
    for (const Index i : groups[g]) {
      const double value = table.rows[static_cast<std::size_t>(i)].value;
      sum += (logarithmic ? std::log(value) : value) / k;
      map(static_cast<Index>(g), i) = 1 / k;
    }
    Observation mean = table.rows[first];
    if (groups[g].size() > 1) mean.value = logarithmic ? std::exp(sum) : sum;
    result.table.rows.push_back(mean);
    result.table.lines.push_back(table.lines[first]);
    result.count.push_back(static_cast<int>(groups[g].size()));
  }
  const MatrixXd covariance = map * MatrixXd(table.covariance) * map.transpose();
  for (Index g = 0; g < covariance.rows(); ++g)
    result.table.rows[static_cast<std::size_t>(g)].u = std::sqrt(covariance(g, g));
  result.table.covariance = covariance.sparseView();
  return result;
}

void add_repeats(const ReducedTable& table, RepeatsOfObservable& repeats) {
  const MatrixXd u(table.covariance);
  for (const auto& group : groups_of(table.rows, false)) {
    if (group.size() < 2) continue;
    const bool logarithmic = above_zero(table.rows, group);
    const Index k = static_cast<Index>(group.size());
    VectorXd y(k), over = VectorXd::Ones(k);
    for (Index i = 0; i < k; ++i) {
      const double value = table.rows[static_cast<std::size_t>(group[static_cast<std::size_t>(i)])].value;
      y[i] = logarithmic ? std::log(value) : value;
      if (logarithmic) over[i] = 1 / value;
    }
    const MatrixXd noise = over.asDiagonal() * u(group, group) * over.asDiagonal();
    const Observation& row = table.rows[static_cast<std::size_t>(group.front())];
    Repeats& r = repeats[{row.apparatus, row.observable}];
    r.squares += (y.array() - y.mean()).square().sum();
    r.stated += noise.trace() - noise.sum() / static_cast<double>(k);
    r.degrees_of_freedom += static_cast<int>(k) - 1;
  }
}

namespace {

std::map<std::pair<std::string, std::string>, std::vector<Index>> rows_of_observables(const TableModel& model) {
  std::map<std::pair<std::string, std::string>, std::vector<Index>> rows;
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    if (model.rows[i].apparatus != "bench")
      rows[{model.rows[i].apparatus, model.rows[i].observable}].push_back(static_cast<Index>(i));
  return rows;
}

double unit_of(const TableModel& model, Index i) { return model.relative[i] > 0 ? model.baseline[i] : 1.0; }

// Of one run, relative where effects multiply, mean over rows.
double library_variance(const TableModel& model, const std::vector<Index>& rows) {
  double sum = 0;
  for (const Index i : rows) sum += model.seed(i, i) / std::pow(unit_of(model, i), 2);
  return sum / static_cast<double>(rows.size());
}

// What the repeats show, widened for few.
double shown_variance(const Repeats& r) {
  const int degrees = r.degrees_of_freedom;
  return degrees == 0 ? 0 : std::max(0.0, (widening(degrees + kAssumedDegrees) * r.squares - r.stated) / degrees);
}

}  // namespace

std::vector<Scatter> raise_scatter(TableModel& model, const RepeatsOfObservable& repeats) {
  std::vector<Scatter> taken;
  for (const auto& [name, own] : rows_of_observables(model)) {
    const auto found = repeats.find(name);
    if (found == repeats.end()) continue;
    const double library = library_variance(model, own), variance = shown_variance(found->second);
    if (variance <= library) continue;
    for (const Index i : own) model.seed(i, i) = std::max(model.seed(i, i), variance * std::pow(unit_of(model, i), 2));
    taken.push_back(
        {name.first, name.second, std::sqrt(variance), std::sqrt(library), found->second.degrees_of_freedom, false});
  }
  return taken;
}

std::vector<Scatter> set_scatter(TableModel& model, const std::vector<int>& count, const RepeatsOfObservable& repeats) {
  std::vector<Scatter> taken;
  for (const auto& [name, own] : rows_of_observables(model)) {
    const double library = library_variance(model, own);
    const auto found = repeats.find(name);
    const Repeats r = found == repeats.end() ? Repeats() : found->second;
    const int degrees = r.degrees_of_freedom;
    double variance = shown_variance(r);
    const double least =
        1.0 * kAssumedDegrees / (kAssumedDegrees + degrees) * kAssumedTimesLibrary * kAssumedTimesLibrary * library;
    const bool assumed = variance < least;
    variance = std::max(variance, least);
    for (const Index i : own)
      model.seed(i, i) = variance * std::pow(unit_of(model, i), 2) / count[static_cast<std::size_t>(i)];
    taken.push_back({name.first, name.second, std::sqrt(variance), std::sqrt(library), r.degrees_of_freedom, assumed});
  }
  return taken;
}

std::string text_of(const Scatter& s) {
  if (!s.assumed)
    return fmt::format(
        "{} {}: one run scatters by {:.2g} % beyond its u, from {} degrees of freedom (library {:.2g} %)", s.apparatus,
        s.observable, 100 * s.sd, s.degrees_of_freedom, 100 * s.library);
  // two single runs, 99 %
  const double change = 2.58 * std::sqrt(2.0) * 100;
  return fmt::format(
      "{} {}: {}; {:.2g} % beyond its u is assumed of one run, from three times the library's {:.2g} %. Between single "
      "runs that hides changes below {:.2g} %, with a scatter as the library's {:.2g} %: repeat tests",
      s.apparatus, s.observable,
      s.degrees_of_freedom == 0
          ? std::string("no test is repeated, so that the scatter of a run is not known")
          : fmt::format("repeats scatter little, but {} degrees of freedom exclude little", s.degrees_of_freedom),
      100 * s.sd, 100 * s.library, change * s.sd, change * s.library);
}

}  // namespace vielto::gap

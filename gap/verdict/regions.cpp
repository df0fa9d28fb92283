// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/condition.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Thirds of the distinct values of a condition among `rows`: index 0, 1, 2; nothing if there is one value or none.
std::map<double, int> thirds(const std::vector<Observation>& rows, std::optional<double> Observation::*condition) {
  std::set<double> values;
  for (const Observation& row : rows)
    if (row.*condition) values.insert(*(row.*condition));
  std::map<double, int> result;
  if (values.size() < 2) return result;
  int i = 0;
  const int n = static_cast<int>(values.size());
  for (const double v : values) result[v] = n == 2 ? 2 * i++ : std::min(2, 3 * i++ / n);
  return result;
}

}  // namespace

std::vector<Region> regions_of(const std::vector<Observation>& rows) {
  const char* const speed_names[] = {"slow", "middle speed", "fast"};
  const char* const third_names[] = {"low", "middle", "high"};
  const char* const fill_names[] = {"low fill", "middle fill", "high fill"};
  const auto speeds = thirds(rows, &Observation::speed), fills = thirds(rows, &Observation::fill);
  std::map<std::string, std::map<double, int>> others;  // tilt, normal_stress ...
  for (const NamedCondition& c : kConditions)
    if (c.member != &Observation::speed && c.member != &Observation::fill) others[c.name] = thirds(rows, c.member);
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::vector<Index>>> found;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto& regions = found[{rows[i].apparatus, rows[i].observable}];
    const Index index = static_cast<Index>(i);
    regions["all"].push_back(index);
    if (rows[i].speed && speeds.count(*rows[i].speed)) regions[speed_names[speeds.at(*rows[i].speed)]].push_back(index);
    if (rows[i].fill && fills.count(*rows[i].fill)) regions[fill_names[fills.at(*rows[i].fill)]].push_back(index);
    for (const auto& [name, parts] : others)
      if (const auto value = rows[i].*condition_member(name); value && parts.count(*value))
        regions[fmt::format("{} {}", third_names[parts.at(*value)], name)].push_back(index);
  }
  std::vector<Region> result;
  for (const auto& [name, regions] : found)
    for (const auto& [region, indices] : regions) {
      if (region != "all" && indices.size() == regions.at("all").size()) continue;  // the same rows again
      Region r;
      r.apparatus = name.first;
      r.observable = name.second;
      r.region = region;
      r.rows = indices;
      result.push_back(r);
    }
  return result;
}

std::vector<double> q_values(const std::vector<double>& p, bool dependent) {
  const std::size_t n = p.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  double factor = 1;
  if (dependent)
    for (std::size_t i = 2; i <= n; ++i) factor += 1 / static_cast<double>(i);
  std::vector<double> q(n);
  double least = 1;
  for (std::size_t rank = n; rank > 0; --rank) {
    const std::size_t i = order[rank - 1];
    least = std::min(least, p[i] * static_cast<double>(n) * factor / static_cast<double>(rank));
    q[i] = least;
  }
  return q;
}

Location locate(const TableModel& model) {
  Location location;
  location.regions = regions_of(model.rows);
  const VectorXd scale = model.scale.unaryExpr([](double x) { return x > 0 ? x : 1; });
  const VectorXd gap = -model.gap().cwiseQuotient(scale);  // model.gap() is measured less simulated
  const auto relative = [&](const MatrixXd& covariance) {
    return MatrixXd(scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal());
  };
  const MatrixXd v = relative(model.null_covariance());
  std::vector<std::pair<const char*, MatrixXd>> parts;
  for (const UncertaintySource& source : kUncertaintySources)
    if (source.part != &TableModel::reference || !model.reference.isZero(0))
      parts.emplace_back(source.name, relative(model.*source.part));
  MatrixXd weights = MatrixXd::Zero(model.size(), static_cast<Index>(location.regions.size()));
  std::vector<double> p;
  for (std::size_t r = 0; r < location.regions.size(); ++r) {
    Region& region = location.regions[r];
    const VectorXd w = v(region.rows, region.rows).llt().solve(VectorXd::Ones(static_cast<Index>(region.rows.size())));
    const double information = w.sum();
    const double mean = w.dot(gap(region.rows)) / information;
    region.relative_gap = model.logarithmic[region.rows.front()] > 0 ? std::expm1(mean) : mean;
    region.u = 1 / std::sqrt(information);
    region.z = mean / region.u;
    region.p = std::erfc(std::fabs(region.z) / std::sqrt(2.0));
    p.push_back(region.p);
    for (const auto& [name, part] : parts) {
      const double square = w.dot(part(region.rows, region.rows) * w);
      region.u_parts.emplace_back(name, std::sqrt(std::max(0.0, square)) / information);
    }
    for (std::size_t i = 0; i < region.rows.size(); ++i)
      weights(region.rows[i], static_cast<Index>(r)) = w[static_cast<Index>(i)] / std::sqrt(information);
  }
  const MatrixXd correlation = weights.transpose() * v * weights;
  for (Index a = 0; a < correlation.rows(); ++a)
    for (Index b = 0; b < a; ++b) location.dependent = location.dependent || std::fabs(correlation(a, b)) > 0.1;
  const std::vector<double> q = q_values(p, location.dependent);
  for (std::size_t r = 0; r < q.size(); ++r) location.regions[r].q = q[r];
  std::sort(location.regions.begin(), location.regions.end(),
            [](const Region& a, const Region& b) { return a.q != b.q ? a.q < b.q : std::fabs(a.z) > std::fabs(b.z); });
  return location;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/reduced_table.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <utility>

#include "core/bad_input.h"
#include "core/net_power.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

using Key = std::pair<std::string, std::string>;  // test, observable

}  // namespace

std::string covariance_file(const std::string& path) {
  const fs::path own = fs::path(path).replace_extension(".covariance.csv");
  if (fs::exists(own)) return own.string();
  const fs::path common = fs::path(path).parent_path() / "covariance.csv";
  return fs::exists(common) ? common.string() : "";
}

ReducedTable read_reduced_table(const std::string& path) {
  const std::vector<Observation> read = read_observations(path);
  std::map<Key, int> index;
  for (std::size_t i = 0; i < read.size(); ++i) index[{read[i].test, read[i].observable}] = static_cast<int>(i);
  const auto find = [&](const std::string& test, const char* observable) {
    const auto found = index.find({test, observable});
    return found == index.end() ? -1 : found->second;
  };

  ReducedTable table;
  table.path = path;
  const int n = static_cast<int>(read.size());
  std::vector<Eigen::Triplet<double>> map, covariance;
  const auto keep = [&](const Observation& row, int line) {
    table.rows.push_back(row);
    table.lines.push_back(line);
    return static_cast<int>(table.rows.size()) - 1;
  };
  for (int i = 0; i < n; ++i) {
    const Observation& row = read[i];
    const int line = i + 2;  // a table has a header and no blank lines
    if (row.observable == "power_idle") continue;
    if (row.observable == "power_loaded") {
      const int idle = find(row.test, "power_idle");
      if (idle < 0 && find(row.test, "power") >= 0) continue;
      if (idle < 0)
        throw BadInput(path, line, "observable", "power_loaded stands without power_idle",
                       "add the idling power of the test, or state its power");
      const int k = keep(net_power(path, line, row, read[idle]), line);
      map.emplace_back(k, i, 1);
      map.emplace_back(k, idle, -1);
      continue;
    }
    if (row.observable == "power" && find(row.test, "power_loaded") >= 0 && find(row.test, "power_idle") >= 0) continue;
    map.emplace_back(keep(row, line), i, 1);
  }

  for (int i = 0; i < n; ++i) covariance.emplace_back(i, i, read[i].u * read[i].u);
  table.covariance_path = covariance_file(path);
  if (!table.covariance_path.empty()) {
    for (const Covariance& c : read_covariances(table.covariance_path, read)) {
      const int a = index.at({c.test_a, c.observable_a}), b = index.at({c.test_b, c.observable_b});
      covariance.emplace_back(a, b, c.covariance);
      covariance.emplace_back(b, a, c.covariance);
    }
  }
  Eigen::SparseMatrix<double> v(n, n), t(static_cast<int>(table.rows.size()), n);
  v.setFromTriplets(covariance.begin(), covariance.end());
  t.setFromTriplets(map.begin(), map.end());
  table.covariance = t * v * t.transpose();
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double variance = table.covariance.coeff(static_cast<int>(i), static_cast<int>(i));
    if (!(variance > 0))
      throw BadInput(path, table.lines[i], "u", "the difference of loaded and idling power has no uncertainty left",
                     "correct the covariance of the two");
    table.rows[i].u = std::sqrt(variance);
  }
  return table;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/discrepancy.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto::gap {

double Discrepancy::correlation(double squared_distance) const {
  return common + (1 - common) * std::exp(-squared_distance / (2 * length * length));
}

constexpr double kPriorSpread = 0.2;  // of the half-normal prior of sd

Discrepancy estimate_discrepancy(const std::vector<LawDifference>& laws) {
  struct Node {
    Discrepancy value;
    double log_posterior;
  };
  std::vector<Node> nodes;
  double best = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i)
    for (const double common : {0.05, 0.35, 0.65, 0.95})
      for (const double length : {0.3, 0.7, 1.5}) {
        Discrepancy d;
        d.sd = 0.002 * std::pow(1.15, i);  // 0.2 % to 47 %, even in the logarithm
        d.common = common;
        d.length = length;
        double log_posterior = std::log(d.sd) - d.sd * d.sd / (2 * kPriorSpread * kPriorSpread);
        for (const LawDifference& law : laws) {
          Eigen::MatrixXd v = law.noise;
          for (Eigen::Index a = 0; a < v.rows(); ++a)
            for (Eigen::Index b = 0; b < v.cols(); ++b)
              v(a, b) += d.sd * d.sd * d.correlation((law.c[a] - law.c[b]).squaredNorm());
          v.diagonal().array() += 1e-10;
          const Eigen::LLT<Eigen::MatrixXd> factor(v);
          const Eigen::MatrixXd l = factor.matrixL();
          log_posterior -=
              0.5 * factor.matrixL().solve(law.difference).squaredNorm() + l.diagonal().array().log().sum();
        }
        best = std::max(best, log_posterior);
        nodes.push_back({d, log_posterior});
      }
  Discrepancy result;
  result.length = 0;
  result.laws = static_cast<int>(laws.size());
  double total = 0, variance = 0;
  for (const Node& node : nodes) {
    const double weight = std::exp(node.log_posterior - best);
    total += weight;
    variance += weight * node.value.sd * node.value.sd;
    result.common += weight * node.value.common;
    result.length += weight * node.value.length;
  }
  result.sd = std::sqrt(variance / total);
  result.common /= total;
  result.length /= total;
  return result;
}

const char* const kHeader = "apparatus,observable,sd,common,length,laws";

std::vector<DiscrepancyEntry> read_discrepancies(const std::string& path) {
  std::ifstream in;
  std::string line = open_table(in, path);
  expect_header(path, line, kHeader);
  std::vector<DiscrepancyEntry> entries;
  std::vector<std::string_view> f;
  for (int number = 2; std::getline(in, line); ++number) {
    split_fields(line, f);
    if (f.size() != 6) throw BadInput(path, number, fmt::format("has {} fields instead of 6", f.size()), kHeader);
    const auto value = [&](int column, const char* name, double low, double high) {
      const auto x = finite_number(f[column]);
      if (!x || *x < low || *x > high)
        throw BadInput(path, number, name, fmt::format("'{}' is out of range", f[column]),
                       fmt::format("state a number from {} to {}", low, high));
      return *x;
    };
    DiscrepancyEntry entry;
    entry.apparatus = f[0];
    entry.observable = f[1];
    for (const DiscrepancyEntry& other : entries)
      if (other.apparatus == entry.apparatus && other.observable == entry.observable)
        throw BadInput(path, number, "observable", fmt::format("{} {} is stated twice", f[0], f[1]), "state it once");
    entry.value.sd = value(2, "sd", 0, 10);
    entry.value.common = value(3, "common", 0, 1);
    entry.value.length = value(4, "length", 1e-3, 1e3);
    entry.value.laws = static_cast<int>(value(5, "laws", 0, 1e6));
    entries.push_back(entry);
  }
  return entries;
}

void write_discrepancies(const std::string& path, const std::vector<DiscrepancyEntry>& entries) {
  std::string text = std::string(kHeader) + "\n";
  for (const DiscrepancyEntry& e : entries)
    text += fmt::format("{},{},{:.4g},{:.3g},{:.3g},{}\n", e.apparatus, e.observable, e.value.sd, e.value.common,
                        e.value.length, e.value.laws);
  write_whole_file(path, text);
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/simulated.h"

#include <fmt/format.h>

#include <cmath>

#include "core/bad_input.h"
#include "core/condition.h"

namespace vielto::gap {
namespace {

constexpr double kBand = 1.959964;  // 95 % of a normal distribution

}  // namespace

std::vector<Observation> combinations(const std::string& apparatus, const std::string& observable,
                                      const std::map<std::string, std::vector<double>>& conditions) {
  const auto unit = observable_unit(apparatus, observable);
  if (!unit)
    throw BadInput("--observable " + observable, 0, fmt::format("is none of apparatus '{}'", apparatus),
                   "take one of doc/reference/observation_table.md");
  Observation row;
  row.role = Role::fit;
  row.apparatus = apparatus;
  row.observable = observable;
  row.unit = *unit;
  row.value = row.u = 1;  // neither counts
  std::vector<Observation> rows = {row};
  for (const auto& [name, values] : conditions) {
    if (values.empty()) continue;
    std::vector<Observation> more;
    for (const Observation& at : rows)
      for (const double value : values) {
        more.push_back(at);
        more.back().*condition_member(name) = value;
      }
    rows = std::move(more);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].test = fmt::format("{}", i + 1);
  return rows;
}

SimulatedValues simulated_values(const Inputs& inputs, const std::vector<Observation>& rows, EmulatorOptions options) {
  options.runs_per_observation = 0;  // the mean over seeds
  options.candidates = false;        // an effect may not reach the conditions asked for
  const auto n = static_cast<Eigen::Index>(rows.size());
  ReducedTable table{"the conditions asked for", "", rows, {}, {}};
  for (Eigen::Index i = 1; i <= n; ++i) table.lines.push_back(static_cast<int>(i));
  table.covariance.resize(n, n);
  table.covariance.setIdentity();
  const TableModel m =
      inputs.emulator.model(table, options, inputs.settings).in_logarithms(TableModel::Values::placeholders);
  SimulatedValues result{{}, m.outside, m.silent};
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool logarithmic = m.logarithmic[i] != 0;
    const auto from = [&](double x) { return logarithmic ? std::exp(x) : x; };
    const double middle = m.baseline[i] + m.family_shift[i];
    const double unit = logarithmic ? from(middle) : 1;
    const std::array<double, 3> variances = {m.emulator(i, i), m.family(i, i), m.discrepancy(i, i)};
    const double u = std::sqrt(variances[0] + variances[1] + variances[2]);
    SimulatedValue v;
    v.row = rows[static_cast<std::size_t>(i)];
    v.row.value = from(middle);
    v.row.u = u * unit;
    v.card = from(m.baseline[i]);
    v.low95 = from(middle - kBand * u);
    v.high95 = from(middle + kBand * u);
    for (std::size_t k = 0; k < variances.size(); ++k) v.parts[k] = std::sqrt(variances[k]) * unit;
    result.values.push_back(std::move(v));
  }
  return result;
}

std::string simulated_csv(const std::vector<SimulatedValue>& values) {
  std::string text = "apparatus,observable,unit";
  for (const NamedCondition& c : kConditions) text += fmt::format(",{}", c.name);
  text += ",card,value,u,low95,high95,u_emulator,u_calibration,u_contact_law\n";
  for (const SimulatedValue& v : values) {
    text += fmt::format("{},{},{}", v.row.apparatus, v.row.observable, v.row.unit);
    for (const NamedCondition& c : kConditions) text += v.row.*c.member ? fmt::format(",{}", *(v.row.*c.member)) : ",";
    text += fmt::format(",{:.6g},{:.6g},{:.4g},{:.6g},{:.6g}", v.card, v.row.value, v.row.u, v.low95, v.high95);
    for (const double part : v.parts) text += fmt::format(",{:.4g}", part);
    text += "\n";
  }
  return text;
}

}  // namespace vielto::gap

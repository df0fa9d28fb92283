// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/points.h"

#include <algorithm>
#include <cmath>

#include "core/condition.h"
#include "core/statistics.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using json = nlohmann::ordered_json;

constexpr double kNegligibleWeight = 1e-4;  // of a strength, against 1

struct Simulated {
  VectorXd mean, variance;
};

// The rows of a table, in logarithms where effects multiply, and the fit rows among them.
struct Rows {
  TableModel model;
  std::vector<Index> fit;

  explicit Rows(const TableModel& natural) : model(natural.in_logarithms(TableModel::Values::measured)) {
    for (Index i = 0; i < model.size(); ++i)
      if (model.rows[static_cast<std::size_t>(i)].role == Role::fit) fit.push_back(i);
  }

  std::vector<const EffectResponse*> responses(const std::vector<std::string>& names) const {
    std::vector<const EffectResponse*> effects;
    for (const std::string& name : names) effects.push_back(model.effect(name));
    return effects;
  }

  Simulated recalibrated(const std::vector<const EffectResponse*>& effects,
                         const std::vector<double>& strengths) const {
    const VectorXd mean = mean_at(model, effects, strengths);
    const MatrixXd c = covariance_at(model, effects, strengths);
    const MatrixXd cross = model.family(Eigen::all, fit);
    const MatrixXd gain = MatrixXd(c(fit, fit)).llt().solve(cross.transpose()).transpose();
    const VectorXd rest = VectorXd(model.observed(fit)) - VectorXd(mean(fit));
    return {mean + gain * rest, (c - model.noise - gain * cross.transpose()).diagonal().cwiseMax(0.0)};
  }

  Simulated recalibrated(const ModelEvidence& m) const {
    const auto effects = responses(m.effects);
    Simulated all{VectorXd::Zero(model.size()), VectorXd::Zero(model.size())};
    double sum = 0;
    for (const StrengthNode& node : m.posterior) {
      if (node.weight < kNegligibleWeight) continue;
      const Simulated s = recalibrated(effects, node.strengths);
      sum += node.weight;
      all.mean += node.weight * s.mean;
      all.variance += node.weight * (s.variance + s.mean.cwiseAbs2());
    }
    all.mean /= sum;
    all.variance = (all.variance / sum - all.mean.cwiseAbs2()).cwiseMax(0.0);
    return all;
  }

  Band95 band(Index i, double middle, double variance) const {
    const double half = kNormal975 * std::sqrt(variance);
    const auto natural = [&](double x) { return model.logarithmic[i] > 0 ? std::exp(x) : x; };
    return {natural(middle), natural(middle - half), natural(middle + half)};
  }

  // Root mean square over the fit rows of simulated over measured, less 1.
  double gap(const VectorXd& simulated) const {
    const VectorXd difference = simulated - model.observed;
    double sum = 0;
    for (const Index i : fit) {
      const double relative = model.logarithmic[i] > 0 ? std::expm1(difference[i])
                              : model.scale[i] > 0     ? difference[i] / model.scale[i]
                                                       : 0;
      sum += relative * relative;
    }
    return std::sqrt(sum / static_cast<double>(fit.size()));
  }
};

json band_json(const Band95& b) { return {{"value", b.value}, {"low95", b.low95}, {"high95", b.high95}}; }

}  // namespace

Points points_of(const TableModel& natural, const Diagnosis& d) {
  const Rows rows(natural);
  const TableModel& model = rows.model;
  const VectorXd before = model.baseline + model.family_shift;
  const VectorXd before_variance = (model.null_covariance() - model.noise).diagonal();
  const auto applied = d.applied();
  std::optional<Simulated> after;
  if (!applied.empty())
    after = rows.recalibrated(*d.model(applied.size() == 2 ? applied[0] + "+" + applied[1] : applied[0]));
  Points p;
  for (Index i = 0; i < model.size(); ++i) {
    const Observation& row = natural.rows[static_cast<std::size_t>(i)];
    ComparedRow point{row, {}, rows.band(i, before[i], before_variance[i]), {}};
    point.measured = {row.value, row.value - kNormal975 * row.u, row.value + kNormal975 * row.u};
    if (after) point.after = rows.band(i, after->mean[i], after->variance[i]);
    p.points.push_back(std::move(point));
  }
  p.gap_before = rows.gap(before);
  p.gap_recalibrated = rows.gap(rows.recalibrated({}, {}).mean);
  for (const ModelEvidence& m : d.models) {
    if (m.effects.size() != 1) continue;
    const auto effect = rows.responses(m.effects);
    const Interval strength = m.strength(0);
    p.effects.push_back(
        {m.effects[0], effect[0]->unit, strength, rows.gap(rows.recalibrated(effect, {strength.value}).mean)});
  }
  return p;
}

void add_points(json& diagnosis, const Points& p) {
  diagnosis["fit_gap"] = {{"before", p.gap_before}, {"recalibrated", p.gap_recalibrated}};
  for (json& entry : diagnosis["effects"])
    for (const EffectAlone& e : p.effects) {
      if (entry["name"] != e.name) continue;
      entry["strength"] = {
          {"value", e.strength.value}, {"low90", e.strength.low90}, {"high90", e.strength.high90}, {"unit", e.unit}};
      entry["gap_left"] = e.gap_left;
    }
  json& list = diagnosis["points"] = json::array();
  for (const ComparedRow& point : p.points) {
    json j = {{"test", point.row.test},
              {"role", text_of(point.row.role)},
              {"apparatus", point.row.apparatus},
              {"observable", point.row.observable},
              {"unit", point.row.unit}};
    for (const NamedCondition& c : kConditions)
      if (point.row.*c.member) j[c.name] = *(point.row.*c.member);
    j["measured"] = band_json(point.measured);
    j["before"] = band_json(point.before);
    if (point.after) j["after"] = band_json(*point.after);
    list.push_back(std::move(j));
  }
}

}  // namespace vielto::gap

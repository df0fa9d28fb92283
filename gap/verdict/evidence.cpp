// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/bad_input.h"
#include "core/pi.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Effects = std::vector<const EffectResponse*>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double log_sum(const std::vector<double>& logs) {
  const double best = *std::max_element(logs.begin(), logs.end());
  if (!std::isfinite(best)) return best;
  double sum = 0;
  for (const double x : logs) sum += std::exp(x - best);
  return best + std::log(sum);
}

// exp(x) over the sum of exp(x): they add up to 1 however large the logarithms are.
std::vector<double> parts_of_sum(const std::vector<double>& logs) {
  const double best = *std::max_element(logs.begin(), logs.end());
  std::vector<double> parts;
  double sum = 0;
  for (const double x : logs) sum += parts.emplace_back(std::exp(x - best));
  for (double& part : parts) part /= sum;
  return parts;
}

struct Box {
  double low, high;
};

// Midpoints of m equal cells.
double midpoint(const Box& box, int i, int m) { return box.low + (box.high - box.low) * (i + 0.5) / m; }

// Log density of every column of `deviations`.
VectorXd log_densities(const MatrixXd& deviations, const MatrixXd& covariance) {
  const Eigen::LLT<MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return VectorXd::Constant(deviations.cols(), -kInfinity);
  const MatrixXd whitened = factor.matrixL().solve(deviations);
  const double log_root = MatrixXd(factor.matrixL()).diagonal().array().log().sum();
  return (-0.5 * whitened.colwise().squaredNorm().transpose().array() - log_root -
          0.5 * static_cast<double>(covariance.rows()) * std::log(2 * kPi))
      .matrix();
}

std::vector<Effects> pairs_of(const Effects& effects) {
  std::vector<Effects> pairs;
  for (std::size_t a = 0; a < effects.size(); ++a)
    for (std::size_t b = a + 1; b < effects.size(); ++b) pairs.push_back({effects[a], effects[b]});
  return pairs;
}

Effects all_effects(const TableModel& model) {
  Effects effects;
  for (const EffectResponse& e : model.effects) effects.push_back(&e);
  return effects;
}

}  // namespace

std::string ModelEvidence::name() const {
  if (unknown) return "unknown";
  if (effects.empty()) return "no_gap";
  return effects.size() == 1 ? effects[0] : effects[0] + "+" + effects[1];
}

Interval ModelEvidence::strength(std::size_t effect) const {
  std::vector<std::pair<double, double>> nodes;
  for (const StrengthNode& node : posterior) nodes.emplace_back(node.strengths[effect], node.weight);
  std::sort(nodes.begin(), nodes.end());
  // Each distinct strength is the middle of a cell; the quantile lies in proportion within it.
  std::vector<std::pair<double, double>> cells;
  for (const auto& [s, w] : nodes) {
    if (cells.empty() || s > cells.back().first + 1e-12 * std::fabs(s))
      cells.emplace_back(s, w);
    else
      cells.back().second += w;
  }
  const auto quantile = [&](double p) {
    double sum = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (sum + cells[i].second >= p || i + 1 == cells.size()) {
        const double width = cells.size() < 2 ? 0
                             : i > 0          ? cells[i].first - cells[i - 1].first
                                              : cells[1].first - cells[0].first;
        const double part = cells[i].second > 0 ? std::clamp((p - sum) / cells[i].second, 0.0, 1.0) : 0.5;
        return cells[i].first + (part - 0.5) * width;
      }
      sum += cells[i].second;
    }
    return 0.0;
  };
  return {quantile(0.5), quantile(0.05), quantile(0.95)};
}

double log_normal_density(const VectorXd& deviation, const MatrixXd& covariance) {
  return log_densities(deviation, covariance)[0];
}

double chi_squared(const VectorXd& d, const MatrixXd& c, const TableModel& model) {
  const Eigen::LLT<MatrixXd> factor(c);
  const double x = factor.info() == Eigen::Success ? factor.matrixL().solve(d).squaredNorm()
                                                   : std::numeric_limits<double>::quiet_NaN();
  require_finite(x, "a distance in standard deviations", model);
  return x;
}

VectorXd mean_at(const TableModel& model, const Effects& effects, const std::vector<double>& strengths) {
  VectorXd mean = model.baseline + model.family_shift;
  VectorXd first;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const VectorXd r = effects[e]->response(strengths[e]);
    mean += r;
    if (e == 0)
      first = r;
    else
      mean += (model.relative.array() > 0).select(first.array() * r.array() / model.baseline.array(), 0).matrix();
  }
  return mean;
}

MatrixXd covariance_at(const TableModel& model, const Effects& effects, const std::vector<double>& strengths) {
  MatrixXd c = model.null_covariance();
  for (std::size_t e = 0; e < effects.size(); ++e) c += model.uncertain(*effects[e], strengths[e]);
  if (effects.size() == 2) {
    const VectorXd both = effects[0]->response(strengths[0]).cwiseProduct(effects[1]->response(strengths[1]));
    const VectorXd r = model.interaction * effects[0]->shape_error * effects[1]->shape_error * model.over_scale(both);
    c += r.asDiagonal() * model.shape_correlation * r.asDiagonal();
  }
  return c;
}

std::vector<UnknownNode> unknown_nodes(const TableModel& model, const Settings& settings) {
  constexpr int kAmplitudes = 9;
  const MatrixXd null = model.null_covariance();
  std::vector<UnknownNode> nodes;
  for (const UnknownShape& shape : model.unknown) {
    if (!(shape.weight > 0)) continue;
    for (int i = 0; i < kAmplitudes; ++i) {
      const double amplitude = settings.unknown_low * std::pow(settings.unknown_high / settings.unknown_low,
                                                               static_cast<double>(i) / (kAmplitudes - 1));
      nodes.push_back({null + shape.covariance(amplitude), std::log(shape.weight / kAmplitudes)});
    }
  }
  return nodes;
}

ModelEvidence no_gap_evidence(const TableModel& model) {
  ModelEvidence m;
  m.log_evidence = log_normal_density(model.gap(), model.null_covariance());
  return m;
}

ModelEvidence unknown_evidence(const TableModel& model, const Settings& settings) {
  ModelEvidence m;
  m.unknown = true;
  std::vector<double> logs;
  for (const UnknownNode& node : unknown_nodes(model, settings))
    logs.push_back(log_normal_density(model.gap(), node.covariance) + node.log_weight);
  m.log_evidence = log_sum(logs);
  return m;
}

ModelEvidence effect_evidence(const TableModel& model, const Effects& effects) {
  ModelEvidence m;
  for (const EffectResponse* e : effects) m.effects.push_back(e->name);
  const std::size_t dimensions = effects.size();
  const int cells = dimensions == 1 ? 64 : 16;
  std::vector<Box> box;
  double log_prior = 0;
  for (const EffectResponse* e : effects) {
    box.push_back({e->low, e->high});
    log_prior -= std::log(e->high - e->low);
  }
  // Beyond a drop of 15 in the logarithm nothing counts; the box closes in on the rest until it is well resolved.
  constexpr double kDrop = 15;
  for (int level = 0;; ++level) {
    std::vector<std::vector<double>> nodes;
    std::vector<double> logs;
    std::vector<int> index(dimensions, 0);
    for (bool more = true; more;) {
      std::vector<double> s(dimensions);
      for (std::size_t d = 0; d < dimensions; ++d) s[d] = midpoint(box[d], index[d], cells);
      logs.push_back(log_normal_density(model.observed - mean_at(model, effects, s), covariance_at(model, effects, s)));
      nodes.push_back(s);
      more = false;
      for (std::size_t d = 0; d < dimensions && !more; ++d) {
        more = ++index[d] < cells;
        if (!more) index[d] = 0;
      }
    }
    const double best = *std::max_element(logs.begin(), logs.end());
    bool closed_in = false;
    std::vector<Box> next = box;
    for (std::size_t d = 0; d < dimensions; ++d) {
      const double width = (box[d].high - box[d].low) / cells;
      double low = kInfinity, high = -kInfinity;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (logs[i] < best - kDrop) continue;
        low = std::min(low, nodes[i][d]);
        high = std::max(high, nodes[i][d]);
      }
      next[d] = {std::max(box[d].low, low - 1.5 * width), std::min(box[d].high, high + 1.5 * width)};
      closed_in = closed_in || next[d].high - next[d].low < 0.6 * (box[d].high - box[d].low);
    }
    if (closed_in && level < 8) {
      box = next;
      continue;
    }
    double log_cell = log_prior;
    for (const Box& b : box) log_cell += std::log((b.high - b.low) / cells);
    m.log_evidence = log_sum(logs) + log_cell;
    const std::vector<double> parts = parts_of_sum(logs);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (parts[i] > std::exp(-kDrop)) m.posterior.push_back({nodes[i], parts[i]});
    return m;
  }
}

void require_finite(double value, const std::string& what, const TableModel& model) {
  if (std::isfinite(value)) return;
  throw BadInput(model.source, 0, fmt::format("{} is not finite: no verdict can rest on it", what),
                 "look for values, u or shared errors that no measurement has");
}

void set_probabilities(std::vector<ModelEvidence>& models, const TableModel& model, const Settings& settings) {
  const double singles = static_cast<double>(model.effects.size());
  const double pairs = singles * (singles - 1) / 2;
  // Kinds of models that cannot be here (no pair of one effect) leave their share to the others.
  double prior_sum = settings.prior_no_gap + settings.prior_unknown;
  if (singles > 0) prior_sum += settings.prior_single;
  if (pairs > 0) prior_sum += settings.prior_pair;
  std::vector<double> logs;
  for (const ModelEvidence& m : models) {
    require_finite(m.log_evidence, "the evidence of " + m.name(), model);
    const double prior = m.unknown               ? settings.prior_unknown
                         : m.effects.empty()     ? settings.prior_no_gap
                         : m.effects.size() == 1 ? settings.prior_single / singles
                                                 : settings.prior_pair / pairs;
    logs.push_back(m.log_evidence + std::log(prior / prior_sum));
  }
  const std::vector<double> parts = parts_of_sum(logs);
  for (std::size_t i = 0; i < models.size(); ++i) models[i].probability = parts[i];
}

std::vector<ModelEvidence> all_evidence(const TableModel& model, const Settings& settings, int best_singles) {
  std::vector<ModelEvidence> models = {no_gap_evidence(model), unknown_evidence(model, settings)};
  Effects effects = all_effects(model);
  std::vector<double> single(effects.size());
  for (std::size_t e = 0; e < effects.size(); ++e) {
    models.push_back(effect_evidence(model, {effects[e]}));
    single[e] = models.back().log_evidence;
  }
  if (best_singles > 0 && static_cast<std::size_t>(best_singles) < effects.size()) {
    std::vector<std::size_t> order(effects.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return single[a] > single[b]; });
    order.resize(static_cast<std::size_t>(best_singles));
    std::sort(order.begin(), order.end());
    Effects kept;
    for (const std::size_t i : order) kept.push_back(effects[i]);
    effects = kept;
  }
  for (const Effects& pair : pairs_of(effects)) models.push_back(effect_evidence(model, pair));
  set_probabilities(models, model, settings);
  return models;
}

VectorXd largest_log_odds(const TableModel& model, const Settings& settings, const MatrixXd& tables) {
  const VectorXd mean = model.baseline + model.family_shift;
  const VectorXd none = log_densities(tables.colwise() - mean, model.null_covariance());
  VectorXd best = VectorXd::Constant(tables.cols(), -kInfinity);
  // Log of the mean over the nodes of a model, each node with the logarithm of its weight.
  const auto add_model = [&](const std::vector<std::pair<VectorXd, double>>& nodes) {
    for (Index b = 0; b < tables.cols(); ++b) {
      std::vector<double> logs;
      for (const auto& [log_density, log_weight] : nodes) logs.push_back(log_density[b] + log_weight);
      best[b] = std::max(best[b], log_sum(logs) - none[b]);
    }
  };
  std::vector<std::pair<VectorXd, double>> nodes;
  for (const UnknownNode& node : unknown_nodes(model, settings))
    nodes.emplace_back(log_densities(tables.colwise() - mean, node.covariance), node.log_weight);
  add_model(nodes);

  // Nodes in the middle of cells that grow with the distance from 0, where tables without a gap lie; weight: the cell's
  // part of the range.
  const auto strengths = [](const EffectResponse& e, int steps) {
    std::vector<std::pair<double, double>> result;
    for (const double end : {e.low, e.high})
      for (int i = 0; end != 0 && i < steps; ++i) {
        const double inner = end * std::pow(static_cast<double>(i) / steps, 2);
        const double outer = end * std::pow(static_cast<double>(i + 1) / steps, 2);
        result.emplace_back((inner + outer) / 2, std::log(std::fabs(outer - inner) / (e.high - e.low)));
      }
    return result;
  };
  const Effects effects = all_effects(model);
  for (const EffectResponse* e : effects) {
    nodes.clear();
    for (const auto& [s, log_weight] : strengths(*e, 16))
      nodes.emplace_back(log_densities(tables.colwise() - mean_at(model, {e}, {s}), covariance_at(model, {e}, {s})),
                         log_weight);
    add_model(nodes);
  }
  for (const Effects& pair : pairs_of(effects)) {
    nodes.clear();
    for (const auto& [s, log_s] : strengths(*pair[0], 5))
      for (const auto& [t, log_t] : strengths(*pair[1], 5))
        nodes.emplace_back(
            log_densities(tables.colwise() - mean_at(model, pair, {s, t}), covariance_at(model, pair, {s, t})),
            log_s + log_t);
    add_model(nodes);
  }
  return best;
}

}  // namespace vielto::gap

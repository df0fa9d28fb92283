// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bad_input.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Values = std::vector<const LibraryValue*>;

constexpr double kLeastVariance = 1e-14;

std::string text_of(const Point& p) {
  std::string text = fmt::format("{:.6g}", p.t);
  for (const double c : p.c) text += fmt::format(" {:.6g}", c);
  for (const double z : p.z) text += fmt::format(" {:.6g}", z);
  return text;
}

VectorXd means_of(const Means& means) {
  VectorXd v(means.size());
  Index i = 0;
  for (const auto& group : means) v[i++] = group.second.mean();
  return v;
}

// A gauge that an effect adds to is as sure in millimetres whatever it shows.
bool added_to(const Channel& channel, const std::vector<Effect>& effects) {
  if (channel.apparatus != "bench") return false;
  for (const Effect& e : effects)
    for (const Transform& t : e.transforms)
      if (t.operation == Operation::add && t.acts_on(channel.apparatus, channel.observable)) return true;
  return false;
}

// Names, whether it is relative, walls and materials.
Channel described(const Values& values, const std::vector<Effect>& effects) {
  Channel channel;
  channel.sample = values.front()->row;
  channel.apparatus = channel.sample.apparatus;
  channel.observable = channel.sample.observable;
  channel.relative = !added_to(channel, effects);
  for (const LibraryValue* v : values) {
    channel.relative = channel.relative && v->row.value > 0;
    if (!v->row.wall.empty()) channel.walls.insert(v->row.wall);
    if (!v->row.material.empty()) channel.materials.insert(v->row.material);
  }
  return channel;
}

void add_conditions(Channel& channel, const Values& values, const std::string& folder) {
  for (const NamedCondition& c : kConditions) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const LibraryValue* v : values) {
      const auto& x = v->row.*c.member;
      if (x.has_value() != (channel.sample.*c.member).has_value())
        throw BadInput(
            folder, 0,
            fmt::format("some rows of {} {} state {}, others do not", channel.apparatus, channel.observable, c.name),
            "state it in all or none");
      if (x) low = std::min(low, *x), high = std::max(high, *x);
    }
    if (high - low > 1e-9 * std::max(std::fabs(low), std::fabs(high))) {
      channel.varying.push_back(c);
      channel.low.push_back(low);
      channel.high.push_back(high);
      channel.logarithmic.push_back(low > 0);
    }
  }
}

// The runs of a channel by what they are: baseline, each effect, other calibrated parameters.
struct SortedRuns {
  Means baseline, parameters;
  std::map<std::string, Means> by_effect;
};

SortedRuns sorted(const Channel& channel, const Library& library, const Values& values,
                  const std::vector<Effect>& effects, const ParameterScale& scale) {
  SortedRuns runs;
  for (const LibraryValue* v : values) {
    const Run& run = library.runs[v->run];
    Point p = channel.point(v->row);
    const double y = channel.smoothed(v->row.value);
    if (run.baseline()) {
      add_to(runs.baseline, p, y);
    } else if (run.effects.empty()) {
      p.z = scale.in_units(run.parameters);
      add_to(runs.parameters, p, y);
    } else if (!run.varies_several()) {
      const auto& [name, strength] = *run.effects.begin();
      const auto effect =
          std::find_if(effects.begin(), effects.end(), [&, &n = name](const Effect& e) { return e.name == n; });
      p.t = strength / largest_strength(*effect);
      add_to(runs.by_effect[name], p, y);
    }
  }
  return runs;
}

double root_mean_square_of_baseline(const Library& library, const Values& values) {
  double squares = 0;
  int count = 0;
  for (const LibraryValue* v : values)
    if (library.runs[v->run].baseline()) squares += v->row.value * v->row.value, ++count;
  return std::sqrt(squares / std::max(count, 1));
}

Smooth smooth_of(GaussianProcess::Form form, std::vector<Point> points, const VectorXd& v, const MatrixXd& noise) {
  return {GaussianProcess(form, points, v, noise), points, noise};
}

// The logarithm of the seed variance varies by 2/(k-1) for k seeds, and is low by 1/(k-1) (mean of ln chi^2, to first
// order).
Smooth log_seed_variance(const Means& baseline) {
  const Index sites = static_cast<Index>(baseline.size());
  VectorXd log_variance(sites), its_noise(sites);
  Index i = 0;
  for (const auto& [key, group] : baseline) {
    double sum = 0;
    for (const double v : group.values) sum += std::pow(v - group.mean(), 2);
    const double k = static_cast<double>(group.values.size());
    log_variance[i] = std::log(std::max(sum / std::max(k - 1, 1.0), kLeastVariance)) + 1 / std::max(k - 1, 1.0);
    its_noise[i++] = 2 / std::max(k - 1, 1.0);
  }
  return smooth_of(GaussianProcess::Form::level, points_of(baseline), log_variance, MatrixXd(its_noise.asDiagonal()));
}

// Variance of the mean of the runs at each point.
VectorXd noise_of_means(const Channel& channel, const Means& means) {
  VectorXd noise = VectorXd::Constant(static_cast<Index>(means.size()), kLeastVariance);
  if (!channel.log_seed_variance) return noise;
  const VectorXd log_v = channel.log_seed_variance->process.at(points_of(means)).mean;
  Index g = 0;
  for (const auto& group : means) noise[g] = std::exp(log_v[g]) / static_cast<double>(group.second.values.size()), ++g;
  return noise;
}

// A response as differences from the smoothed baseline, whose error they share.
Smooth response_of(const Channel& channel, GaussianProcess::Form form, const Means& means) {
  const std::vector<Point> points = points_of(means);
  const GaussianProcess::Prediction base = channel.level.process.at(points);
  return smooth_of(form, points, means_of(means) - base.mean,
                   MatrixXd(noise_of_means(channel, means).asDiagonal()) + base.covariance);
}

}  // namespace

double largest_strength(const Effect& effect) { return std::max(-effect.prior_low, effect.prior_high); }

double Mean::mean() const {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

void add_to(Means& means, const Point& point, double value) {
  means.try_emplace(text_of(point), Mean{point, {}}).first->second.values.push_back(value);
}

std::vector<Point> points_of(const Means& means) {
  std::vector<Point> points;
  for (const auto& group : means) points.push_back(group.second.point);
  return points;
}

ParameterScale::ParameterScale(const Library& library)
    : nominal(library.nominal), spread(VectorXd::Zero(library.nominal.size())) {
  for (const Run& run : library.runs) spread = spread.cwiseMax((run.parameters - nominal).cwiseAbs());
  spread = spread.unaryExpr([](double x) { return x > 0 ? x : 1; }).eval();
}

VectorXd ParameterScale::in_units(const VectorXd& parameters) const {
  return (parameters - nominal).cwiseQuotient(spread);
}

double Channel::coordinate(std::size_t k, double value) const {
  const auto mapped = [&](double x) { return logarithmic[k] ? std::log(std::max(x, 1e-300)) : x; };
  return (mapped(value) - mapped(low[k])) / (mapped(high[k]) - mapped(low[k]));
}

Point Channel::point(const Observation& row) const {
  Point p;
  p.c.resize(static_cast<Index>(varying.size()));
  for (std::size_t k = 0; k < varying.size(); ++k)
    p.c[static_cast<Index>(k)] = coordinate(k, *(row.*varying[k].member));
  return p;
}

double Channel::value(double smoothed) const { return relative ? std::exp(smoothed) : smoothed; }

double Channel::smoothed(double value) const { return relative ? std::log(value) : value; }

Channel make_channel(const Library& library, const Values& values, const std::vector<Effect>& effects,
                     const ParameterScale& scale) {
  Channel channel = described(values, effects);
  add_conditions(channel, values, library.folder);
  channel.size = root_mean_square_of_baseline(library, values);
  const SortedRuns runs = sorted(channel, library, values, effects, scale);
  if (channel.apparatus != "bench") channel.log_seed_variance = log_seed_variance(runs.baseline);
  channel.level = smooth_of(GaussianProcess::Form::level, points_of(runs.baseline), means_of(runs.baseline),
                            MatrixXd(noise_of_means(channel, runs.baseline).asDiagonal()));
  for (const auto& [name, means] : runs.by_effect)
    channel.responses.emplace(name, response_of(channel, GaussianProcess::Form::response, means));
  if (!runs.parameters.empty())
    channel.parameters = response_of(channel, GaussianProcess::Form::parameters, runs.parameters);
  return channel;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bad_input.h"
#include "gap/emulator/measured_noise.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStrengthSteps = 24;  // on either side of 0

// Strengths over the prior range, the steps growing with the distance from 0.
VectorXd strengths_of(const Effect& effect) {
  std::vector<double> s;
  for (int i = kStrengthSteps; i > 0 && effect.prior_low < 0; --i)
    s.push_back(effect.prior_low * std::pow(static_cast<double>(i) / kStrengthSteps, 2));
  s.push_back(0);
  for (int i = 1; i <= kStrengthSteps && effect.prior_high > 0; ++i)
    s.push_back(effect.prior_high * std::pow(static_cast<double>(i) / kStrengthSteps, 2));
  return Eigen::Map<VectorXd>(s.data(), static_cast<Index>(s.size()));
}

double largest_strength(const Effect& effect) { return std::max(-effect.prior_low, effect.prior_high); }

std::string text_of(const Point& p) {
  std::string text = fmt::format("{:.6g}", p.t);
  for (const double c : p.c) text += fmt::format(" {:.6g}", c);
  for (const double z : p.z) text += fmt::format(" {:.6g}", z);
  return text;
}

// Runs at the same point, averaged.
struct Mean {
  Point point;
  std::vector<double> values;
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
};

VectorXd means_of(const std::map<std::string, Mean>& groups) {
  VectorXd v(groups.size());
  Index i = 0;
  for (const auto& group : groups) v[i++] = group.second.mean();
  return v;
}

std::vector<Point> points_of(const std::map<std::string, Mean>& groups) {
  std::vector<Point> points;
  for (const auto& group : groups) points.push_back(group.second.point);
  return points;
}

}  // namespace

double Emulator::Channel::coordinate(std::size_t k, double value) const {
  const auto mapped = [&](double x) { return logarithmic[k] ? std::log(std::max(x, 1e-300)) : x; };
  return (mapped(value) - mapped(low[k])) / (mapped(high[k]) - mapped(low[k]));
}

Point Emulator::Channel::point(const Observation& row) const {
  Point p;
  p.c.resize(static_cast<Index>(varying.size()));
  for (std::size_t k = 0; k < varying.size(); ++k)
    p.c[static_cast<Index>(k)] = coordinate(k, *(row.*varying[k].member));
  return p;
}

double Emulator::Channel::value(double smoothed) const { return relative ? std::exp(smoothed) : smoothed; }

Emulator::Emulator(const Library& library, const std::vector<Effect>& effects,
                   std::vector<DiscrepancyEntry> discrepancies)
    : folder_(library.folder),
      effects_(effects),
      discrepancies_(std::move(discrepancies)),
      parameter_names_(library.parameter_names),
      nominal_(library.nominal),
      family_(library.family) {
  // Parameters count in units of the spread of the runs that vary them.
  spread_ = VectorXd::Zero(nominal_.size());
  for (const Run& run : library.runs) spread_ = spread_.cwiseMax((run.parameters - nominal_).cwiseAbs());
  spread_ = spread_.unaryExpr([](double x) { return x > 0 ? x : 1; });
  std::map<std::pair<std::string, std::string>, std::vector<const LibraryValue*>> by_observable;
  for (const LibraryValue& value : library.values)
    by_observable[{value.row.apparatus, value.row.observable}].push_back(&value);
  for (const auto& [name, values] : by_observable) channels_.push_back(make_channel(library, values));
}

Emulator::Channel Emulator::make_channel(const Library& library, const std::vector<const LibraryValue*>& values) const {
  Channel channel;
  channel.sample = values.front()->row;
  channel.apparatus = channel.sample.apparatus;
  channel.observable = channel.sample.observable;
  channel.relative = true;
  for (const LibraryValue* v : values) {
    channel.relative = channel.relative && v->row.value > 0;
    if (!v->row.wall.empty()) channel.walls.insert(v->row.wall);
    if (!v->row.material.empty()) channel.materials.insert(v->row.material);
  }
  for (const NamedCondition& c : kConditions) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const LibraryValue* v : values) {
      const auto& x = v->row.*c.member;
      if (x.has_value() != (channel.sample.*c.member).has_value())
        throw BadInput(
            folder_, 0,
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
  const auto smoothed = [&](double y) { return channel.relative ? std::log(y) : y; };

  std::map<std::string, Mean> baseline;
  double squares = 0;
  int count = 0;
  for (const LibraryValue* v : values) {
    if (!library.runs[v->run].baseline) continue;
    const Point p = channel.point(v->row);
    Mean& group = baseline.try_emplace(text_of(p), Mean{p, {}}).first->second;
    group.values.push_back(smoothed(v->row.value));
    squares += v->row.value * v->row.value;
    ++count;
  }
  channel.size = std::sqrt(squares / std::max(count, 1));

  // Seed variance: its logarithm varies by 2/(k-1) for k seeds, and is low by 1/(k-1) (mean of ln chi^2, to first
  // order).
  const Index sites = static_cast<Index>(baseline.size());
  VectorXd log_variance(sites), its_noise(sites);
  bool noisy = channel.apparatus != "bench";
  Index i = 0;
  for (const auto& [key, group] : baseline) {
    double sum = 0;
    for (const double v : group.values) sum += std::pow(v - group.mean(), 2);
    const double k = static_cast<double>(group.values.size());
    log_variance[i] = std::log(std::max(sum / std::max(k - 1, 1.0), 1e-14)) + 1 / std::max(k - 1, 1.0);
    its_noise[i++] = 2 / std::max(k - 1, 1.0);
  }
  const auto make = [](GaussianProcess::Form form, std::vector<Point> points, const VectorXd& v,
                       const MatrixXd& noise) {
    return Smooth{GaussianProcess(form, points, v, noise), points, noise};
  };
  if (noisy)
    channel.log_seed_variance =
        make(GaussianProcess::Form::level, points_of(baseline), log_variance, MatrixXd(its_noise.asDiagonal()));
  // Noise of the mean of the runs at each point.
  const auto mean_noise = [&](const std::map<std::string, Mean>& groups) {
    VectorXd noise = VectorXd::Constant(static_cast<Index>(groups.size()), 1e-14);
    if (noisy) {
      const VectorXd log_v = channel.log_seed_variance->process.at(points_of(groups)).mean;
      Index g = 0;
      for (const auto& group : groups)
        noise[g] = std::exp(log_v[g]) / static_cast<double>(group.second.values.size()), ++g;
    }
    return noise;
  };
  channel.level = make(GaussianProcess::Form::level, points_of(baseline), means_of(baseline),
                       MatrixXd(mean_noise(baseline).asDiagonal()));

  // Responses, as differences from the smoothed baseline, whose error they share.
  const auto response = [&](GaussianProcess::Form form, const std::map<std::string, Mean>& groups) {
    const std::vector<Point> points = points_of(groups);
    const GaussianProcess::Prediction base = channel.level.process.at(points);
    return make(form, points, means_of(groups) - base.mean,
                MatrixXd(mean_noise(groups).asDiagonal()) + base.covariance);
  };
  std::map<std::string, std::map<std::string, Mean>> by_effect;
  std::map<std::string, Mean> parameters;
  for (const LibraryValue* v : values) {
    const Run& run = library.runs[v->run];
    if (run.baseline) continue;
    Point p = channel.point(v->row);
    if (run.effect == "none") {
      p.z = (run.parameters - nominal_).cwiseQuotient(spread_);
      parameters.try_emplace(text_of(p), Mean{p, {}}).first->second.values.push_back(smoothed(v->row.value));
    } else {
      const auto effect =
          std::find_if(effects_.begin(), effects_.end(), [&](const Effect& e) { return e.name == run.effect; });
      p.t = run.strength / largest_strength(*effect);
      by_effect[run.effect].try_emplace(text_of(p), Mean{p, {}}).first->second.values.push_back(smoothed(v->row.value));
    }
  }
  for (const auto& [name, groups] : by_effect)
    channel.responses.emplace(name, response(GaussianProcess::Form::response, groups));
  if (!parameters.empty()) channel.parameters = response(GaussianProcess::Form::parameters, parameters);
  return channel;
}

Emulator Emulator::redrawn(std::mt19937_64& random) const {
  Emulator other = *this;
  std::normal_distribution<double> normal;
  const auto redraw = [&](Smooth& smooth) {
    VectorXd z(smooth.noise.rows());
    for (double& x : z) x = normal(random);
    MatrixXd noise = smooth.noise;
    noise.diagonal().array() += 1e-15;
    const MatrixXd l = noise.llt().matrixL();
    smooth.process = smooth.process.with_values(smooth.process.at(smooth.points).mean + l * z);
  };
  for (Channel& channel : other.channels_) {
    if (!channel.log_seed_variance) continue;
    redraw(channel.level);
    for (auto& entry : channel.responses) redraw(entry.second);
    if (channel.parameters) redraw(*channel.parameters);
  }
  return other;
}

const Emulator::Channel& Emulator::channel_of(const ReducedTable& table, std::size_t row) const {
  const Observation& r = table.rows[row];
  for (const Channel& channel : channels_)
    if (channel.apparatus == r.apparatus && channel.observable == r.observable) return channel;
  throw BadInput(table.path, table.lines[row], "observable",
                 fmt::format("the library {} lacks {} {}", folder_, r.apparatus, r.observable),
                 "add its runs to the library or remove the row");
}

void Emulator::check_row(const Channel& channel, const ReducedTable& table, std::size_t i,
                         const EmulatorOptions& options, std::vector<std::string>& outside,
                         std::vector<std::string>& silent) const {
  const Observation& row = table.rows[i];
  const auto tell_silent = [&](const std::string& column, const std::string& value) {
    if (options.ignored.count(column)) return;
    const std::string about = fmt::format("{} {}: {} ", channel.apparatus, channel.observable, column);
    for (const std::string& text : silent)
      if (text.compare(0, about.size(), about) == 0) return;
    silent.push_back(
        fmt::format("{}{} is not accounted for: no run of the library states one (--ignore {} if it does not matter)",
                    about, value, column));
  };
  const auto refuse = [&](const std::string& column, const std::string& what, const std::string& mend) {
    throw BadInput(table.path, table.lines[i], column, what, mend);
  };
  const auto label = [&](const char* column, const std::string& value, const std::set<std::string>& known) {
    if (options.ignored.count(column) || value.empty() || known.count(value)) return;
    if (known.empty()) return tell_silent(column, fmt::format("'{}'", value));
    refuse(column, fmt::format("the library has no runs for '{}'", value),
           fmt::format("use {}, or --ignore {}", fmt::join(known, " or "), column));
  };
  label("wall", row.wall, channel.walls);
  label("material", row.material, channel.materials);
  for (const NamedCondition& c : kConditions) {
    const auto k = std::find_if(channel.varying.begin(), channel.varying.end(),
                                [&](const NamedCondition& v) { return v.member == c.member; });
    const auto& stated = row.*c.member;
    if (k == channel.varying.end()) {
      const auto& fixed = channel.sample.*c.member;
      if (stated && !fixed) tell_silent(c.name, fmt::format("{}", *stated));
      if (fixed && stated && !options.ignored.count(c.name) &&
          std::fabs(*stated - *fixed) > 1e-6 * std::max(std::fabs(*fixed), 1e-12))
        refuse(c.name, fmt::format("{} is outside the library, which has {} only", *stated, *fixed),
               fmt::format("add runs there, or --ignore {}", c.name));
      continue;
    }
    if (!stated) refuse(c.name, "is empty, but the library depends on it", "state it");
    const double x = channel.coordinate(static_cast<std::size_t>(k - channel.varying.begin()), *stated);
    if (x < -1e-6 || x > 1 + 1e-6) {
      const std::size_t at = static_cast<std::size_t>(k - channel.varying.begin());
      const std::string what =
          fmt::format("{} is outside the library's {} to {}", *stated, channel.low[at], channel.high[at]);
      if (!options.extrapolate) refuse(c.name, what, "add runs there, or --extrapolate to be told all the same");
      outside.push_back(fmt::format("line {}: {} {}", table.lines[i], c.name, what));
    }
  }
}

void Emulator::fill_effect(const Channel& channel, const Effect& effect, const std::vector<Index>& rows,
                           TableModel& model, EffectResponse& response) const {
  const Transform* transform = effect.transform_of(channel.apparatus, channel.observable);
  const auto smooth = channel.responses.find(effect.name);
  const Index m = static_cast<Index>(rows.size());
  std::vector<Point> points;
  for (const Index i : rows) points.push_back(channel.point(model.rows[i]));
  for (Index k = 0; k < response.strengths.size(); ++k) {
    const double s = response.strengths[k];
    if (s == 0) continue;
    VectorXd change = VectorXd::Zero(m);
    MatrixXd covariance = MatrixXd::Zero(m, m);
    if (transform && transform->operation == Operation::shift) {
      // The difference of the baseline between two conditions: errors of both are correlated.
      std::vector<Point> both = points;
      for (const Index i : rows) {
        Observation shifted = model.rows[i];
        auto& condition = shifted.*condition_member(transform->condition);
        if (!condition)
          throw BadInput("test " + shifted.test, 0, fmt::format("has no {}", transform->condition), "state it");
        *condition *= 1 + transform->factor * s;
        both.push_back(channel.point(shifted));
      }
      const GaussianProcess::Prediction p = channel.level.process.at(both);
      const MatrixXd& c = p.covariance;
      change = p.mean.tail(m) - p.mean.head(m);
      covariance =
          c.topLeftCorner(m, m) + c.bottomRightCorner(m, m) - c.topRightCorner(m, m) - c.bottomLeftCorner(m, m);
    } else if (transform) {
      for (Index a = 0; a < m; ++a) {
        const double f = model.baseline[rows[a]];
        response.mean(rows[a], k) = transform->reading(model.rows[rows[a]], f, s).value - f;
      }
      continue;
    } else if (smooth != channel.responses.end()) {
      std::vector<Point> at = points;
      for (Point& p : at) p.t = s / largest_strength(effect);
      const GaussianProcess::Prediction p = smooth->second.process.at(at);
      change = p.mean;
      covariance = p.covariance;
    } else {
      return;
    }
    for (Index a = 0; a < m; ++a) {
      const double f = model.baseline[rows[a]];
      response.mean(rows[a], k) = channel.relative ? f * std::expm1(change[a]) : change[a];
      for (Index b = 0; b < m; ++b) {
        const double scale =
            channel.relative ? f * std::exp(change[a]) * model.baseline[rows[b]] * std::exp(change[b]) : 1;
        response.covariance[k](rows[a], rows[b]) = scale * covariance(a, b);
      }
    }
  }
}

TableModel Emulator::model(const ReducedTable& table, const EmulatorOptions& options, const Settings& settings) const {
  const Index n = static_cast<Index>(table.rows.size());
  TableModel model;
  model.rows = table.rows;
  model.observed.resize(n);
  model.source = table.path;
  model.noise = measured_noise(table);
  for (auto member : {&TableModel::baseline, &TableModel::family_shift, &TableModel::relative, &TableModel::scale,
                      &TableModel::logarithmic, &TableModel::unknown_scale})
    model.*member = VectorXd::Zero(n);
  for (auto member : {&TableModel::seed, &TableModel::emulator, &TableModel::family, &TableModel::discrepancy,
                      &TableModel::shape_correlation})
    model.*member = MatrixXd::Zero(n, n);
  const Index members = family_.weights.size();
  model.family_members = MatrixXd::Zero(n, members);
  model.family_weights = family_.weights;
  model.family_parameters = family_.parameters;

  std::map<const Channel*, std::vector<Index>> by_channel;
  for (Index i = 0; i < n; ++i) {
    const Channel& channel = channel_of(table, static_cast<std::size_t>(i));
    check_row(channel, table, static_cast<std::size_t>(i), options, model.outside, model.silent);
    by_channel[&channel].push_back(i);
    model.observed[i] = table.rows[i].value;
    model.relative[i] = channel.relative;
  }

  std::vector<Point> point(n);
  for (const auto& [channel, rows] : by_channel) {
    std::vector<Point> points;
    for (const Index i : rows) points.push_back(point[i] = channel->point(model.rows[i]));
    const GaussianProcess::Prediction level = channel->level.process.at(points);
    VectorXd seed_variance = VectorXd::Zero(level.mean.size());
    if (channel->log_seed_variance) seed_variance = channel->log_seed_variance->process.at(points).mean.array().exp();
    const auto discrepancy =
        std::find_if(discrepancies_.begin(), discrepancies_.end(), [c = channel](const DiscrepancyEntry& e) {
          return e.apparatus == c->apparatus && e.observable == c->observable;
        });
    if (options.use_discrepancy && !discrepancies_.empty() && discrepancy == discrepancies_.end() &&
        channel->apparatus != "bench")
      throw BadInput(folder_ + "/discrepancy.csv", 0,
                     fmt::format("lacks {} {}", channel->apparatus, channel->observable),
                     "add its law discrepancy (vielto gap discrepancy)");
    const bool with_discrepancy = options.use_discrepancy && discrepancy != discrepancies_.end();
    const Index m = static_cast<Index>(rows.size());
    VectorXd size(m);
    for (Index a = 0; a < m; ++a) {
      const Index i = rows[a];
      model.baseline[i] = channel->value(level.mean[a]);
      model.scale[i] = size[a] = channel->relative ? model.baseline[i] : channel->size;
      const double unit = channel->relative ? model.baseline[i] : 1;
      if (options.runs_per_observation > 0)
        model.seed(i, i) = seed_variance[a] * unit * unit / options.runs_per_observation;
    }
    for (Index a = 0; a < m; ++a)
      for (Index b = 0; b < m; ++b) {
        const double unit = channel->relative ? size[a] * size[b] : 1;
        model.emulator(rows[a], rows[b]) = unit * level.covariance(a, b);
        const double distance = (points[a].c - points[b].c).squaredNorm();
        if (with_discrepancy) {
          const Discrepancy& d = discrepancy->value;
          model.discrepancy(rows[a], rows[b]) = size[a] * size[b] * d.sd * d.sd * d.correlation(distance);
        }
        model.shape_correlation(rows[a], rows[b]) = distance < 1e-12 ? 1 : 0.5;
      }

    if (members > 0 && channel->parameters) {
      MatrixXd uncertain = MatrixXd::Zero(m, m);
      for (Index k = 0; k < members; ++k) {
        std::vector<Point> at = points;
        const VectorXd z = (family_.parameters.row(k).transpose() - nominal_).cwiseQuotient(spread_);
        for (Point& p : at) p.z = z;
        const GaussianProcess::Prediction p = channel->parameters->process.at(at);
        uncertain += family_.weights[k] * p.covariance;
        for (Index a = 0; a < m; ++a)
          model.family_members(rows[a], k) = channel->relative ? size[a] * std::expm1(p.mean[a]) : p.mean[a];
      }
      for (Index a = 0; a < m; ++a)
        for (Index b = 0; b < m; ++b)
          model.family(rows[a], rows[b]) += (channel->relative ? size[a] * size[b] : 1) * uncertain(a, b);
    }
  }
  raise_to_resolution(model.rows, model.scale, model.noise, model.notes);
  for (std::string& text : contradictions(model.rows, model.noise, model.seed.diagonal()))
    model.notes.push_back(std::move(text));
  if (members > 0) {
    model.family_shift = model.family_members * family_.weights;
    const MatrixXd centred = model.family_members.colwise() - model.family_shift;
    model.family += centred * family_.weights.asDiagonal() * centred.transpose();
  } else {
    model.notes.push_back("the library has no calibrated family: what recalibration could absorb is not known");
  }
  if (discrepancies_.empty() || !options.use_discrepancy)
    model.notes.push_back("no law discrepancy is given: false alarms are more frequent than stated");

  const auto refuse_known = [](const std::string& name, const std::string& what, const std::string& mend) {
    throw BadInput("--known " + name, 0, what, mend);
  };
  for (const auto& [name, strength] : options.known) {
    const auto effect =
        std::find_if(effects_.begin(), effects_.end(), [n = name](const Effect& e) { return e.name == n; });
    if (effect == effects_.end()) refuse_known(name, "is no effect", "name one of the effects' folder");
    if (strength < effect->prior_low || strength > effect->prior_high)
      refuse_known(name,
                   fmt::format("{} is outside its range of {} to {}", strength, effect->prior_low, effect->prior_high),
                   "state a strength within it");
  }
  for (const Effect& effect : effects_) {
    if (!options.candidates && options.known.count(effect.name) == 0) continue;
    EffectResponse response;
    response.name = effect.name;
    response.unit = effect.unit;
    response.kind = effect.kind;
    response.low = effect.prior_low;
    response.high = effect.prior_high;
    response.shape_error = effect.shape_error;
    response.strengths = strengths_of(effect);
    response.mean = MatrixXd::Zero(n, response.strengths.size());
    response.covariance.assign(static_cast<std::size_t>(response.strengths.size()), MatrixXd::Zero(n, n));
    bool known = true;
    for (const auto& [channel, rows] : by_channel) {
      if (effect.acts_on_rig(channel->apparatus) && !effect.transform_of(channel->apparatus, channel->observable) &&
          channel->responses.count(effect.name) == 0)
        known = false;
    }
    if (!known) {
      if (options.known.count(effect.name))
        refuse_known(effect.name, "the library has no runs with it for all the table's observables", "add them");
      model.notes.push_back(fmt::format(
          "{} is no candidate: the library has no runs with it for all the table's observables", effect.name));
      continue;
    }
    for (const auto& [channel, rows] : by_channel) fill_effect(*channel, effect, rows, model, response);
    if (response.mean.isZero(0)) continue;  // acts on nothing in this table
    model.effects.push_back(std::move(response));
  }

  for (const auto& [name, strength] : options.known) {
    if (!model.effect(name)) continue;  // acts on nothing here
    model = model.with_known(name, strength);
    model.notes.push_back(fmt::format("{} at strength {} is part of the baseline", name, strength));
  }

  // An unnamed gap: as large as the effects are at each row; smooth, or a level and a trend with each condition.
  for (const EffectResponse& e : model.effects)
    model.unknown_scale += ((e.response(e.low / 2).cwiseAbs2() + e.response(e.high / 2).cwiseAbs2()) / 2);
  model.unknown_scale =
      (model.unknown_scale / std::max<double>(1, static_cast<double>(model.effects.size()))).cwiseSqrt();
  model.unknown_scale = model.unknown_scale.cwiseMax(settings.unknown_floor * model.scale.cwiseAbs());
  MatrixXd smooth = MatrixXd::Zero(n, n), trend = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      if (model.rows[i].apparatus != model.rows[j].apparatus) continue;
      smooth(i, j) = trend(i, j) = 0.2;
      if (model.rows[i].observable != model.rows[j].observable) continue;
      const double distance = (point[i].c - point[j].c).squaredNorm();
      smooth(i, j) += 0.3 + 0.3 * std::exp(-distance / (2 * 0.5 * 0.5)) + (distance < 1e-12 ? 0.2 : 0);
      // level and slopes of one size at the ends of the range, where c is 0 or 1
      const double slopes = (2 * point[i].c.array() - 1).matrix().dot((2 * point[j].c.array() - 1).matrix());
      trend(i, j) += 0.8 * (1 + slopes) / (1 + static_cast<double>(point[i].c.size()));
    }
  model.unknown_shapes = {smooth, trend};
  // settings.interaction is the part for two effects of the usual shape error
  if (settings.shape_error > 0) model.interaction = settings.interaction / std::pow(settings.shape_error, 2);
  return model;
}

std::map<std::pair<std::string, std::string>, LawDifference> Emulator::differences(
    const ReducedTable& law, const EmulatorOptions& options) const {
  std::map<std::pair<std::string, std::string>, std::map<std::string, Mean>> groups;
  std::vector<std::string> outside, silent;
  for (std::size_t i = 0; i < law.rows.size(); ++i) {
    const Channel& channel = channel_of(law, i);
    if (!channel.log_seed_variance) continue;
    check_row(channel, law, i, options, outside, silent);
    const Point p = channel.point(law.rows[i]);
    groups[{channel.apparatus, channel.observable}]
        .try_emplace(text_of(p), Mean{p, {}})
        .first->second.values.push_back(law.rows[i].value);
  }
  std::map<std::pair<std::string, std::string>, LawDifference> result;
  for (const auto& [name, means] : groups) {
    const Channel& channel = *std::find_if(channels_.begin(), channels_.end(), [&, &key = name](const Channel& c) {
      return c.apparatus == key.first && c.observable == key.second;
    });
    const std::vector<Point> points = points_of(means);
    const GaussianProcess::Prediction level = channel.level.process.at(points);
    const VectorXd log_variance = channel.log_seed_variance->process.at(points).mean;
    LawDifference d;
    d.difference.resize(static_cast<Index>(points.size()));
    d.noise = channel.relative ? level.covariance : MatrixXd(level.covariance / (channel.size * channel.size));
    Index i = 0;
    for (const auto& entry : means) {
      const double base = channel.value(level.mean[i]), size = channel.relative ? base : channel.size;
      d.c.push_back(points[i].c);
      d.difference[i] = (entry.second.mean() - base) / size;
      d.noise(i, i) += std::exp(log_variance[i]) / (channel.relative ? 1 : size * size) /
                       static_cast<double>(entry.second.values.size());
      ++i;
    }
    result.emplace(name, std::move(d));
  }
  return result;
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bad_input.h"
#include "core/rig_table.h"
#include "gap/emulator/channel_response.h"
#include "gap/emulator/measured_noise.h"
#include "gap/emulator/unknown_gap.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool is_fitful(const Observation& row) {
  const NamedObservable* o = find_observable(row.apparatus, row.observable);
  return o && o->fitful;
}

[[noreturn]] void refuse_known(const std::string& name, const std::string& what, const std::string& mend) {
  throw BadInput("--known " + name, 0, what, mend);
}

}  // namespace

Emulator::Emulator(const Library& library, const std::vector<Effect>& effects,
                   std::vector<DiscrepancyEntry> discrepancies)
    : folder_(library.folder),
      effects_(effects),
      discrepancies_(std::move(discrepancies)),
      parameter_names_(library.parameter_names),
      scale_(library),
      family_(library.family) {
  std::map<std::pair<std::string, std::string>, std::vector<const LibraryValue*>> by_observable;
  for (const LibraryValue& value : library.values)
    by_observable[{value.row.apparatus, value.row.observable}].push_back(&value);
  for (const auto& [name, values] : by_observable) channels_.push_back(make_channel(library, values, effects_, scale_));
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

const Channel& Emulator::channel_of(const ReducedTable& table, std::size_t row) const {
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
  if (is_fitful(row))
    refuse("observable", row.observable + " comes and goes with single grains: no diagnosis may rest on it",
           "leave the row out");
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

TableModel Emulator::empty_model(const ReducedTable& table) const {
  const Index n = static_cast<Index>(table.rows.size());
  TableModel model;
  model.source = table.path;
  model.rows = table.rows;
  model.observed.resize(n);
  for (Index i = 0; i < n; ++i) model.observed[i] = table.rows[static_cast<std::size_t>(i)].value;
  model.noise = measured_noise(table);
  for (auto member : {&TableModel::baseline, &TableModel::family_shift, &TableModel::relative, &TableModel::scale,
                      &TableModel::logarithmic})
    model.*member = VectorXd::Zero(n);
  for (auto member : {&TableModel::seed, &TableModel::emulator, &TableModel::family, &TableModel::discrepancy,
                      &TableModel::shape_correlation, &TableModel::reference})
    model.*member = MatrixXd::Zero(n, n);
  model.family_members = MatrixXd::Zero(n, family_.weights.size());
  model.family_weights = family_.weights;
  model.family_parameters = family_.parameters;
  return model;
}

Emulator::RowsOfChannel Emulator::matched(const ReducedTable& table, const EmulatorOptions& options,
                                          TableModel& model) const {
  RowsOfChannel rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Channel& channel = channel_of(table, i);
    check_row(channel, table, i, options, model.outside, model.silent);
    rows[&channel].push_back(static_cast<Index>(i));
    model.relative[static_cast<Index>(i)] = channel.relative;
  }
  return rows;
}

const Discrepancy* Emulator::discrepancy_of(const Channel& channel, const EmulatorOptions& options) const {
  if (!options.use_discrepancy || discrepancies_.empty()) return nullptr;
  for (const DiscrepancyEntry& e : discrepancies_)
    if (e.apparatus == channel.apparatus && e.observable == channel.observable) return &e.value;
  if (channel.apparatus == "bench") return nullptr;
  throw BadInput(folder_ + "/discrepancy.csv", 0, fmt::format("lacks {} {}", channel.apparatus, channel.observable),
                 "add its law discrepancy (vielto gap discrepancy)");
}

void Emulator::fill_baseline(const Channel& channel, const std::vector<Index>& rows, const EmulatorOptions& options,
                             TableModel& model) const {
  const Index m = static_cast<Index>(rows.size());
  std::vector<Point> points;
  for (const Index i : rows) points.push_back(channel.point(model.rows[static_cast<std::size_t>(i)]));
  const GaussianProcess::Prediction level = channel.level.process.at(points);
  VectorXd seed_variance = VectorXd::Zero(m), size(m);
  if (channel.log_seed_variance) seed_variance = channel.log_seed_variance->process.at(points).mean.array().exp();
  for (Index a = 0; a < m; ++a) {
    const Index i = rows[a];
    model.baseline[i] = channel.value(level.mean[a]);
    model.scale[i] = size[a] = channel.relative ? model.baseline[i] : channel.size;
    const double unit = channel.relative ? model.baseline[i] : 1;
    if (options.runs_per_observation > 0)
      model.seed(i, i) = seed_variance[a] * unit * unit / options.runs_per_observation;
  }
  const Discrepancy* discrepancy = discrepancy_of(channel, options);
  for (Index a = 0; a < m; ++a)
    for (Index b = 0; b < m; ++b) {
      const double unit = channel.relative ? size[a] * size[b] : 1;
      model.emulator(rows[a], rows[b]) = unit * level.covariance(a, b);
      const double distance = (points[a].c - points[b].c).squaredNorm();
      if (discrepancy)
        model.discrepancy(rows[a], rows[b]) =
            size[a] * size[b] * discrepancy->sd * discrepancy->sd * discrepancy->correlation(distance);
      model.shape_correlation(rows[a], rows[b]) = distance < 1e-12 ? 1 : 0.5;
    }
}

void Emulator::fill_family(const Channel& channel, const std::vector<Index>& rows, TableModel& model) const {
  if (family_.weights.size() == 0 || !channel.parameters) return;
  const Index m = static_cast<Index>(rows.size());
  std::vector<Point> at;
  for (const Index i : rows) at.push_back(channel.point(model.rows[static_cast<std::size_t>(i)]));
  const VectorXd size = model.scale(rows);
  MatrixXd uncertain = MatrixXd::Zero(m, m);
  for (Index k = 0; k < family_.weights.size(); ++k) {
    const VectorXd z = scale_.in_units(family_.parameters.row(k).transpose());
    for (Point& p : at) p.z = z;
    const GaussianProcess::Prediction p = channel.parameters->process.at(at);
    uncertain += family_.weights[k] * p.covariance;
    for (Index a = 0; a < m; ++a)
      model.family_members(rows[a], k) = channel.relative ? size[a] * std::expm1(p.mean[a]) : p.mean[a];
  }
  for (Index a = 0; a < m; ++a)
    for (Index b = 0; b < m; ++b)
      model.family(rows[a], rows[b]) += (channel.relative ? size[a] * size[b] : 1) * uncertain(a, b);
}

void Emulator::integrate_family(TableModel& model) const {
  if (family_.weights.size() == 0) {
    model.notes.push_back("the library has no calibrated family: what recalibration could absorb is not known");
    return;
  }
  model.family_shift = model.family_members * family_.weights;
  const MatrixXd centred = model.family_members.colwise() - model.family_shift;
  model.family += centred * family_.weights.asDiagonal() * centred.transpose();
}

void Emulator::check_known(const EmulatorOptions& options) const {
  for (const auto& [name, strength] : options.known) {
    const auto effect =
        std::find_if(effects_.begin(), effects_.end(), [n = name](const Effect& e) { return e.name == n; });
    if (effect == effects_.end()) refuse_known(name, "is no effect", "name one of the effects' folder");
    if (strength < effect->prior_low || strength > effect->prior_high)
      refuse_known(name,
                   fmt::format("{} is outside its range of {} to {}", strength, effect->prior_low, effect->prior_high),
                   "state a strength within it");
  }
}

void Emulator::add_effect(const Effect& effect, const RowsOfChannel& rows_of, const EmulatorOptions& options,
                          TableModel& model) const {
  for (const auto& [channel, rows] : rows_of) {
    if (is_known(*channel, effect)) continue;
    if (options.known.count(effect.name))
      refuse_known(effect.name, "the library has no runs with it for all the table's observables", "add them");
    model.notes.push_back(fmt::format(
        "{} is no candidate: the library has no runs with it for all the table's observables", effect.name));
    return;
  }
  EffectResponse response = empty_response(effect, model.size());
  for (const auto& [channel, rows] : rows_of) fill_response(*channel, effect, rows, model, response);
  if (!response.mean.isZero(0)) model.effects.push_back(std::move(response));  // else it acts on nothing in this table
}

TableModel Emulator::model(const ReducedTable& table, const EmulatorOptions& options, const Settings& settings) const {
  TableModel model = empty_model(table);
  const RowsOfChannel rows_of = matched(table, options, model);
  std::vector<VectorXd> conditions(table.rows.size());
  for (const auto& [channel, rows] : rows_of) {
    fill_baseline(*channel, rows, options, model);
    fill_family(*channel, rows, model);
    for (const Index i : rows)
      conditions[static_cast<std::size_t>(i)] = channel->point(table.rows[static_cast<std::size_t>(i)]).c;
  }
  raise_to_resolution(model.rows, model.scale, model.noise, model.notes);
  for (std::string& text : contradictions(model.rows, model.noise, model.seed.diagonal()))
    model.notes.push_back(std::move(text));
  integrate_family(model);
  if (discrepancies_.empty() || !options.use_discrepancy)
    model.notes.push_back("no law discrepancy is given: false alarms are more frequent than stated");
  check_known(options);
  for (const Effect& effect : effects_)
    if (options.candidates || options.known.count(effect.name)) add_effect(effect, rows_of, options, model);
  for (const auto& [name, strength] : options.known) {
    if (!model.effect(name)) continue;  // acts on nothing here
    model = model.with_known(name, strength);
    model.notes.push_back(fmt::format("{} at strength {} is part of the baseline", name, strength));
  }
  set_unknown_gap(model, conditions, settings);
  // settings.interaction is the part for two effects of the usual shape error
  if (settings.shape_error > 0) model.interaction = settings.interaction / std::pow(settings.shape_error, 2);
  return model;
}

std::map<std::pair<std::string, std::string>, LawDifference> Emulator::differences(
    const ReducedTable& law, const EmulatorOptions& options) const {
  std::map<std::pair<std::string, std::string>, Means> groups;
  std::vector<std::string> outside, silent;
  for (std::size_t i = 0; i < law.rows.size(); ++i) {
    const Channel& channel = channel_of(law, i);
    if (!channel.log_seed_variance || is_fitful(law.rows[i])) continue;
    check_row(channel, law, i, options, outside, silent);
    add_to(groups[{channel.apparatus, channel.observable}], channel.point(law.rows[i]), law.rows[i].value);
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

// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/test_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bad_input.h"
#include "core/condition.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Mean over the posterior of what a model predicts, and the covariance of that over its strengths.
struct Predicted {
  VectorXd response;
  MatrixXd covariance;
};

Predicted predicted(const TableModel& model, const ModelEvidence& evidence) {
  std::vector<const EffectResponse*> effects;
  for (const std::string& name : evidence.effects) effects.push_back(model.effect(name));
  Predicted p;
  p.response = VectorXd::Zero(model.size());
  p.covariance = MatrixXd::Zero(model.size(), model.size());
  std::vector<double> mean(effects.size(), 0.0);
  for (const StrengthNode& node : evidence.posterior) {
    const VectorXd r = mean_at(model, effects, node.strengths) - model.baseline - model.family_shift;
    p.response += node.weight * r;
    p.covariance += node.weight * r * r.transpose();
    for (std::size_t e = 0; e < effects.size(); ++e) mean[e] += node.weight * node.strengths[e];
  }
  p.covariance -= p.response * p.response.transpose();
  p.covariance += covariance_at(model, effects, mean) - model.null_covariance();
  return p;
}

double separation(const TableModel& model, const Predicted& a, const Predicted& b, Index rows) {
  const MatrixXd c = (model.null_covariance() + a.covariance + b.covariance).topLeftCorner(rows, rows);
  const VectorXd d = (a.response - b.response).head(rows);
  return std::sqrt(std::max(0.0, d.dot(c.llt().solve(d))));
}

}  // namespace

std::vector<CandidateTest> read_candidate_tests(const std::string& path) {
  const TomlTable file = TomlTable::read(path);
  file.only({"test", "reference", "repeat"});
  const toml::array* list = file.raw()["test"].as_array();
  if (!list || list->empty()) file.refuse("test", "is no list of tests", "write [[test]]");
  std::vector<CandidateTest> tests;
  for (const toml::node& node : *list) {
    if (!node.is_table()) file.refuse("test", "is no list of tests", "write [[test]]");
    const TomlTable t(path, *node.as_table());
    toml::table beside = t.raw();
    for (const NamedCondition& c : kConditions) beside.erase(c.name);
    TomlTable(path, beside).only({"name", "apparatus", "how", "hours", "row"});
    CandidateTest test;
    test.name = t.text("name");
    test.apparatus = t.text("apparatus");
    test.how = t.text("how");
    test.hours = t.number("hours", 0.01, 1e5);
    const toml::array* rows = t.raw()["row"].as_array();
    if (!rows || rows->empty())
      t.refuse("row", "is no list", "write row = [{observable = \"power\", relative_u = 0.02}]");
    for (const toml::node& entry : *rows) {
      if (!entry.is_table()) t.refuse("row", "is no list of tables", "write row = [{observable = ..., u = ...}]");
      const TomlTable r(path, *entry.as_table());
      toml::table own = r.raw();
      for (const NamedCondition& c : kConditions) own.erase(c.name);
      TomlTable(path, own).only({"observable", "u", "relative_u"});
      Observation row;
      row.test = test.name;
      row.role = Role::fit;
      row.apparatus = test.apparatus;
      row.observable = r.text("observable");
      const auto unit = observable_unit(row.apparatus, row.observable);
      if (!unit)
        r.refuse("observable", fmt::format("'{}' is none of {}", row.observable, row.apparatus),
                 "see doc/reference/observation_table.md");
      row.unit = *unit;
      if (r.has("u") == r.has("relative_u")) r.refuse("u", "or relative_u must be there, one of them", "state one");
      test.relative_u.push_back(r.has("relative_u"));
      row.u = r.number(r.has("u") ? "u" : "relative_u", 1e-12, 1e12);
      for (const NamedCondition& c : kConditions)
        if (r.has(c.name) || t.has(c.name)) row.*c.member = (r.has(c.name) ? r : t).number(c.name, -1e12, 1e12);
      test.rows.push_back(row);
    }
    tests.push_back(test);
  }
  return tests;
}

ReducedTable candidate_table(const std::string& path, const CandidateTest& test, const std::string& wall,
                             const std::string& material) {
  ReducedTable table;
  table.path = path + ": test " + test.name;
  table.rows = test.rows;
  for (Observation& row : table.rows) {
    row.wall = wall;
    row.material = material;
  }
  table.lines.assign(test.rows.size(), 0);
  const Index n = static_cast<Index>(test.rows.size());
  table.covariance.resize(n, n);
  for (Index i = 0; i < n; ++i) table.covariance.insert(i, i) = std::pow(test.rows[i].u, 2);
  return table;
}

namespace {

NextTest described(const CandidateTest& test) {
  NextTest next;
  next.name = test.name;
  next.apparatus = test.apparatus;
  next.how = test.how;
  next.hours = test.hours;
  return next;
}

// Means over the pairs of open models, weighted by what both are worth: how far apart they are now and with the test.
template <class Now, class Then>
void separate(NextTest& next, const std::vector<const ModelEvidence*>& open, Now now, Then then) {
  double weight = 0, most = -1;
  for (std::size_t a = 0; a < open.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const double w = open[a]->probability * open[b]->probability, before = now(a, b), after = then(a, b);
      next.separation_now += w * before;
      next.separation += w * after;
      weight += w;
      if (w * (after - before) > most) {
        most = w * (after - before);
        next.separates = open[b]->name() + " from " + open[a]->name();
      }
    }
  if (weight > 0) {
    next.separation_now /= weight;
    next.separation /= weight;
  }
  next.gain_per_hour = (next.separation - next.separation_now) / next.hours;
}

}  // namespace

NextTest judge_candidate(const TableModel& joint, Index present, const CandidateTest& test,
                         const std::vector<const ModelEvidence*>& open) {
  NextTest next = described(test);
  std::vector<Predicted> p;
  for (const ModelEvidence* m : open) p.push_back(predicted(joint, *m));
  separate(
      next, open, [&](std::size_t a, std::size_t b) { return separation(joint, p[a], p[b], present); },
      [&](std::size_t a, std::size_t b) { return separation(joint, p[a], p[b], joint.size()); });
  return next;
}

NextTest judge_for_unknown(const TableModel& joint, Index present, const CandidateTest& test) {
  const Index n = joint.size();
  const MatrixXd c = joint.null_covariance();
  MatrixXd z = MatrixXd::Zero(n, n);
  for (const UnknownShape& shape : joint.unknown) z += shape.weight * shape.covariance();
  VectorXd gap(n);
  const VectorXd now = joint.gap().head(present);
  gap.head(present) = now;
  gap.tail(n - present) =
      z.bottomLeftCorner(n - present, present) * (c + z).topLeftCorner(present, present).llt().solve(now);
  NextTest next = described(test);
  next.separates = "the gap from none";
  next.separation_now = std::sqrt(now.dot(c.topLeftCorner(present, present).llt().solve(now)));
  next.separation = std::sqrt(gap.dot(c.llt().solve(gap)));
  next.gain_per_hour = (next.separation - next.separation_now) / next.hours;
  return next;
}

std::optional<StateTest> read_state_test(const std::string& path, const std::string& name) {
  const TomlTable file = TomlTable::read(path);
  if (!file.has(name)) return std::nullopt;
  const TomlTable t = file.table(name);
  t.only({"how", "hours_each"});
  return StateTest{name, t.text("how"), t.number("hours_each", 0.01, 1e5)};
}

namespace {

// Only the effects that the model knows: the others cancel.
Predicted predicted_if_known(const TableModel& model, const ModelEvidence& evidence) {
  const bool known = std::all_of(evidence.effects.begin(), evidence.effects.end(),
                                 [&](const std::string& e) { return model.effect(e); });
  if (known) return predicted(model, evidence);
  return {VectorXd::Zero(model.size()), MatrixXd::Zero(model.size(), model.size())};
}

double from_none(const TableModel& model, const VectorXd& gap) {
  return std::sqrt(std::max(0.0, gap.dot(model.null_covariance().llt().solve(gap))));
}

}  // namespace

NextTest judge_state(const TableModel& now, const TableModel& then, const CandidateTest& test,
                     const std::vector<const ModelEvidence*>& open, bool unknown) {
  NextTest next = described(test);
  if (unknown) {
    next.separates = "the gap from none";
    next.separation_now = from_none(now, now.gap());
    next.separation = from_none(then, now.gap());
    next.gain_per_hour = (next.separation - next.separation_now) / next.hours;
    return next;
  }
  separate(
      next, open,
      [&](std::size_t a, std::size_t b) {
        return separation(now, predicted(now, *open[a]), predicted(now, *open[b]), now.size());
      },
      [&](std::size_t a, std::size_t b) {
        return separation(then, predicted_if_known(then, *open[a]), predicted_if_known(then, *open[b]), then.size());
      });
  return next;
}

}  // namespace vielto::gap

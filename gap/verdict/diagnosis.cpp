// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/statistics.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<const EffectResponse*> responses(const TableModel& model, const std::vector<std::string>& names) {
  std::vector<const EffectResponse*> effects;
  for (const std::string& name : names) effects.push_back(model.effect(name));
  return effects;
}

std::vector<double> median_strengths(const ModelEvidence& m) {
  std::vector<double> s;
  for (std::size_t e = 0; e < m.effects.size(); ++e) s.push_back(m.strength(e).value);
  return s;
}

// By the rivals' log odds, or because no gap alone leaves too much, in the whole table or in one observable: a gap that
// no rival resembles has no large odds.
bool is_gap(const TableModel& model, double log_odds, const Threshold& threshold, const Settings& settings) {
  if (log_odds > threshold.log_odds) return true;
  const Fit none = fit_of(model, ModelEvidence());
  return std::min(none.all, none.worst) < settings.misfit_probability;
}

bool explains(const Fit& fit, const Settings& settings) {
  return fit.all >= settings.misfit_probability && fit.worst >= settings.name_misfit_probability;
}

std::vector<Index> rows_with_role(const TableModel& model, Role role) {
  std::vector<Index> keep;
  for (std::size_t i = 0; i < model.rows.size(); ++i)
    if (model.rows[i].role == role) keep.push_back(static_cast<Index>(i));
  return keep;
}

// What would be said with other assumptions; the threshold stays.
std::vector<Sensitivity> sensitivity_of(const TableModel& fit, const Threshold& threshold, const Settings& settings) {
  std::vector<Sensitivity> sensitivity;
  const auto vary = [&](const std::string& change, const TableModel& changed, const Settings& other) {
    std::vector<ModelEvidence> models = all_evidence(changed, other, 5);
    const double log_odds = largest_log_odds(changed, other, changed.observed)[0];
    const Judgement verdict = judged(changed, models, is_gap(changed, log_odds, threshold, other), other);
    double rivals = 0;
    const ModelEvidence* top = nullptr;
    for (const ModelEvidence& m : models) {
      if (m.effects.empty() && !m.unknown) continue;
      rivals += m.probability;
      if (!top) top = &m;
    }
    sensitivity.push_back({change, verdict.verdict, top->name(), top->probability / rivals});
  };
  Settings other = settings;
  other.prior_unknown = settings.prior_unknown * 3;
  other.prior_no_gap = std::max(0.05, 1 - other.prior_unknown - other.prior_single - other.prior_pair);
  vary("unknown three times as probable", fit, other);
  other = settings;
  other.prior_pair = settings.prior_pair * 3;
  other.prior_no_gap = std::max(0.05, 1 - other.prior_unknown - other.prior_single - other.prior_pair);
  vary("pairs three times as probable", fit, other);
  TableModel changed = fit;
  for (EffectResponse& e : changed.effects) {
    e.low /= 2;
    e.high /= 2;
  }
  vary("half the prior range of every strength", changed, settings);
  changed = fit;
  for (EffectResponse& e : changed.effects) e.shape_error *= 0.8;
  vary("shape error 0.8 times", changed, settings);
  changed = fit;
  for (EffectResponse& e : changed.effects) e.shape_error *= 1.2;
  vary("shape error 1.2 times", changed, settings);
  if (!fit.discrepancy.isZero(0)) {
    changed = fit;
    changed.discrepancy *= 2.25;
    vary("law discrepancy 1.5 times", changed, settings);
    changed.discrepancy /= 2.25 * 2.25;
    vary("law discrepancy divided by 1.5", changed, settings);
  }
  return sensitivity;
}

// Of the named effects, together if they are two, or of each of a group by itself.
std::vector<NamedStrength> strengths_of(const Diagnosis& d, const TableModel& fit) {
  std::vector<NamedStrength> strengths;
  const auto add = [&](const ModelEvidence& m, std::size_t e) {
    strengths.push_back({m.effects[e], fit.effect(m.effects[e])->unit, m.strength(e)});
  };
  if (d.named.size() == 2) {
    const ModelEvidence* pair = d.model(d.named[0] + "+" + d.named[1]);
    add(*pair, 0);
    add(*pair, 1);
  }
  for (const std::string& name : d.named.size() == 1 ? d.named : d.group) add(*d.model(name), 0);
  return strengths;
}

}  // namespace

const ModelEvidence* Diagnosis::model(const std::string& name) const {
  for (const ModelEvidence& m : models)
    if (m.name() == name) return &m;
  return nullptr;
}

std::vector<std::string> Diagnosis::applied() const {
  if (verdict == Verdict::named) return named;
  if (verdict == Verdict::ambiguous && !group.empty()) return {group.front()};
  return {};
}

Judgement judged(const TableModel& model, std::vector<ModelEvidence>& models, bool gap_found,
                 const Settings& settings) {
  std::sort(models.begin(), models.end(),
            [](const ModelEvidence& a, const ModelEvidence& b) { return a.probability > b.probability; });
  Judgement v;
  const auto none = std::find_if(models.begin(), models.end(),
                                 [](const ModelEvidence& m) { return m.effects.empty() && !m.unknown; });
  if (!gap_found) {
    v.verdict = Verdict::no_gap;
    v.fit = fit_of(model, *none);
    return v;
  }
  double rivals = 0, singles = 0, unknown = 0;
  const ModelEvidence* best = nullptr;  // named model
  const ModelEvidence* best_pair = nullptr;
  std::map<std::string, double> with;  // probability of an effect, alone and in pairs
  for (const ModelEvidence& m : models) {
    if (m.unknown) unknown = m.probability;
    if (m.unknown || !m.effects.empty()) rivals += m.probability;
    if (m.effects.size() == 1) singles += m.probability;
    if (!m.effects.empty() && !best) best = &m;
    if (m.effects.size() == 2 && !best_pair) best_pair = &m;
    for (const std::string& e : m.effects) with[e] += m.probability;
  }
  if (best) v.fit = fit_of(model, *best);
  if (!best || unknown > settings.unknown_probability * rivals || !explains(v.fit, settings)) {
    v.verdict = Verdict::unknown;
    return v;
  }
  if (best->probability >= settings.name_probability * rivals) {
    v.verdict = Verdict::named;
    v.named = best->effects;
    return v;
  }
  for (const ModelEvidence& m : models) {
    if (m.effects.size() != 1 || (best_pair && m.probability <= best_pair->probability)) continue;
    if (with[m.effects[0]] >= settings.name_probability * rivals) {
      v.verdict = Verdict::named;
      v.named = m.effects;
      return v;
    }
  }
  v.verdict = Verdict::ambiguous;
  double sum = 0;
  for (const ModelEvidence& m : models) {
    if (m.effects.size() != 1 || sum >= settings.group_probability * singles) continue;
    v.group.push_back(m.effects[0]);
    sum += m.probability;
  }
  return v;
}

double absorbable_part(const TableModel& model, const VectorXd& gap) {
  const MatrixXd rest = model.null_covariance() - model.family;
  const VectorXd shift = model.family * (rest + model.family).llt().solve(gap);
  const Eigen::LLT<MatrixXd> factor(rest);
  const double all = gap.dot(factor.solve(gap));
  if (!(all > 0)) return 0;
  const VectorXd left = gap - shift;
  return std::clamp(1 - left.dot(factor.solve(left)) / all, 0.0, 1.0);
}

VectorXd recalibrated_parameters(const TableModel& values, const std::vector<std::string>& effects,
                                 const std::vector<double>& strengths) {
  const TableModel fit = values.in_logarithms(TableModel::Values::measured);
  const auto response = responses(fit, effects);
  const VectorXd rest = fit.observed - mean_at(fit, response, strengths) + fit.family_shift;
  // The members' own scatter leaves the covariance: it is what is asked for.
  const MatrixXd centred = fit.family_members.colwise() - fit.family_shift;
  const MatrixXd c =
      covariance_at(fit, response, strengths) - centred * fit.family_weights.asDiagonal() * centred.transpose();
  VectorXd logs(fit.family_weights.size());
  for (Index m = 0; m < logs.size(); ++m)
    logs[m] =
        std::log(std::max(fit.family_weights[m], 1e-300)) + log_normal_density(rest - fit.family_members.col(m), c);
  const VectorXd w = (logs.array() - logs.maxCoeff()).exp();
  return fit.family_parameters.transpose() * (w / w.sum());
}

const ModelEvidence* placebo_of(const Diagnosis& diagnosis, const Isolability& isolability) {
  std::set<std::string> own(diagnosis.group.begin(), diagnosis.group.end());
  const auto applied = diagnosis.applied();
  for (std::size_t e = 0; e < applied.size(); ++e)
    for (const std::string& member : isolability.group_of(applied[e], diagnosis.strengths[e].interval.value))
      own.insert(member);
  for (const ModelEvidence& m : diagnosis.models)
    if (m.effects.size() == 1 && own.count(m.effects[0]) == 0) return &m;
  return nullptr;
}

Shrink shrink_of(const CheckRows& rows, const SimulatedRows& before, const SimulatedRows& recalibrated,
                 const SimulatedRows& after, const SimulatedRows& placebo) {
  const Index n = rows.observed.size();
  const VectorXd measured_u2 = rows.noise.diagonal().cwiseQuotient(rows.observed.cwiseAbs2());
  std::map<std::string, std::vector<Index>> rows_of_test;
  for (Index i = 0; i < n; ++i) rows_of_test[rows.tests[static_cast<std::size_t>(i)]].push_back(i);
  std::vector<std::vector<Index>> tests;
  for (const auto& entry : rows_of_test) tests.push_back(entry.second);
  const auto gap = [&](const SimulatedRows& s) { return VectorXd(s.value.cwiseQuotient(rows.observed).array() - 1); };
  const auto mean_square = [&](const SimulatedRows& s) { return (gap(s).cwiseAbs2() - measured_u2).mean(); };
  const auto root = [](double square) { return std::sqrt(std::max(0.0, square)); };
  const auto closed = [&](double before2, double after2) {
    return before2 > 0 ? 1 - root(after2) / root(before2) : 0.0;
  };
  Shrink s;
  s.tests = static_cast<int>(tests.size());
  s.before = root(s.before2 = mean_square(before));
  s.recalibrated = root(s.recalibrated2 = mean_square(recalibrated));
  s.after = root(s.after2 = mean_square(after));
  s.placebo = root(s.placebo2 = mean_square(placebo));
  s.closed.value = closed(s.before2, s.after2);

  // Redrawn errors add their variance to the squares, and it is taken out again, so that the draws lie about the value.
  constexpr std::size_t kTestsToResample = 5;
  constexpr int kDraws = 4000;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const MatrixXd scaled =
      rows.observed.cwiseInverse().asDiagonal() * rows.noise * rows.observed.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scaled);
  const MatrixXd half = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const auto normals = [&] {
    VectorXd z(n);
    for (double& x : z) x = normal(random);
    return z;
  };
  const auto redrawn = [&](const SimulatedRows& v, const VectorXd& measured_error) {
    const VectorXd ratio = v.value.cwiseQuotient(rows.observed), own = v.u.cwiseQuotient(rows.observed);
    const VectorXd g = gap(v) - ratio.cwiseProduct(measured_error) + own.cwiseProduct(normals());
    return VectorXd(g.cwiseAbs2() - measured_u2 - ratio.cwiseAbs2().cwiseProduct(measured_u2) - own.cwiseAbs2());
  };
  std::uniform_int_distribution<std::size_t> pick(0, tests.size() - 1);
  std::vector<double> draws;
  for (int b = 0; b < kDraws; ++b) {
    const VectorXd error = half * normals();
    const VectorXd before2 = redrawn(before, error), after2 = redrawn(after, error);
    double sum_before = 0, sum_after = 0;
    for (std::size_t t = 0; t < tests.size(); ++t)
      for (const Index i : tests[tests.size() < kTestsToResample ? t : pick(random)]) {
        sum_before += before2[i];
        sum_after += after2[i];
      }
    draws.push_back(closed(sum_before, sum_after));
  }
  std::sort(draws.begin(), draws.end());
  s.closed.low90 = draws[kDraws / 20];
  s.closed.high90 = draws[kDraws - 1 - kDraws / 20];
  return s;
}

std::optional<Shrink> predicted_shrink(const TableModel& model, const Diagnosis& d, const Isolability& isolability) {
  const auto check = rows_with_role(model, Role::check);
  const auto applied = d.applied();
  if (check.empty() || applied.empty()) return std::nullopt;
  const TableModel fit = model.part(rows_with_role(model, Role::fit));
  // Recalibration: the shift of the family that the fit rows ask for, to first order.
  const auto simulated = [&](const std::vector<std::string>& effects, const std::vector<double>& strengths,
                             bool recalibrate) {
    VectorXd y = mean_at(model, responses(model, effects), strengths) - model.family_shift;
    if (recalibrate && model.family_weights.size() > 0) {
      const auto response = responses(fit, effects);
      const MatrixXd cross = (model.family)(Eigen::all, rows_with_role(model, Role::fit));
      const VectorXd rest = fit.observed - mean_at(fit, response, strengths);
      y += model.family_shift + cross * covariance_at(fit, response, strengths).llt().solve(rest);
    }
    return VectorXd(y(check));
  };
  std::string name = applied[0];
  if (applied.size() == 2) name += "+" + applied[1];
  const ModelEvidence* m = d.model(name);
  const ModelEvidence* placebo = placebo_of(d, isolability);
  CheckRows rows{model.observed(check), model.noise(check, check), {}};
  for (const Index i : check) rows.tests.push_back(model.rows[static_cast<std::size_t>(i)].test);
  if ((rows.observed.array() == 0).any()) return std::nullopt;
  const VectorXd u = VectorXd(model.emulator.diagonal()(check)).cwiseSqrt();
  const SimulatedRows recalibrated{simulated({}, {}, true), u};
  Shrink s = shrink_of(
      rows, {simulated({}, {}, false), u}, recalibrated, {simulated(applied, median_strengths(*m), true), u},
      placebo ? SimulatedRows{simulated(placebo->effects, median_strengths(*placebo), true), u} : recalibrated);
  if (placebo) s.placebo_name = placebo->name();
  return s;
}

Diagnosis diagnose(const TableModel& model, const Threshold& threshold, const Settings& settings) {
  const TableModel fit = model.part(rows_with_role(model, Role::fit)).in_logarithms(TableModel::Values::measured);
  Diagnosis d;
  d.fit_rows = static_cast<int>(fit.size());
  d.check_rows = static_cast<int>(model.size()) - d.fit_rows;
  d.notes = model.notes;
  for (const std::string& row : model.outside) d.notes.push_back("extrapolated: " + row);
  d.threshold = threshold;
  d.models = all_evidence(fit, settings);
  d.log_odds = largest_log_odds(fit, settings, fit.observed)[0];
  require_finite(d.log_odds, "the log odds of the best rival", fit);
  require_finite(threshold.log_odds, "the threshold", fit);
  const Judgement v = judged(fit, d.models, is_gap(fit, d.log_odds, threshold, settings), settings);
  d.verdict = v.verdict;
  d.named = v.named;
  d.group = v.group;
  d.fit = v.fit;
  d.strengths = strengths_of(d, fit);

  VectorXd gap = fit.gap();
  const auto applied = d.applied();
  if (!applied.empty()) {
    std::vector<double> s;
    for (std::size_t e = 0; e < applied.size(); ++e) s.push_back(d.strengths[e].interval.value);
    gap = mean_at(fit, responses(fit, applied), s) - fit.baseline - fit.family_shift;
  }
  d.absorbable = absorbable_part(fit, gap);
  d.where = locate(fit);
  d.trends = trends_of(fit);

  d.sensitivity = sensitivity_of(fit, threshold, settings);
  return d;
}

nlohmann::ordered_json shrink_json(const Shrink& s) {
  nlohmann::ordered_json j = {
      {"tests", s.tests},
      {"before", s.before},
      {"recalibrated", s.recalibrated},
      {"after", s.after},
      {"placebo", s.placebo},
      {"closed", {{"value", s.closed.value}, {"low90", s.closed.low90}, {"high90", s.closed.high90}}},
      {"mean_squares",
       {{"before", s.before2}, {"recalibrated", s.recalibrated2}, {"after", s.after2}, {"placebo", s.placebo2}}}};
  if (!s.placebo_name.empty()) j["placebo_effect"] = s.placebo_name;
  for (const SimulatedAgain& run : s.runs) {
    nlohmann::ordered_json row = {{"test", run.test}, {"observable", run.observable}};
    for (const SimulatedAgain::Value& v : run.values) row[text_of(v.variant)] = {{"value", v.value}, {"u", v.u}};
    j["runs"].push_back(std::move(row));
  }
  return j;
}

namespace {

nlohmann::ordered_json parts_json(const std::vector<std::pair<std::string, double>>& parts) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const auto& [name, u] : parts) j[name] = u;
  return j;
}

nlohmann::ordered_json next_json(const NextTest& t) {
  return {{"name", t.name},
          {"apparatus", t.apparatus},
          {"how", t.how},
          {"hours", t.hours},
          {"separates", t.separates},
          {"separation_now", t.separation_now},
          {"separation", t.separation},
          {"gain_per_hour", t.gain_per_hour}};
}

}  // namespace

nlohmann::ordered_json diagnosis_json(const Diagnosis& d, const nlohmann::ordered_json& provenance) {
  using json = nlohmann::ordered_json;
  json j = {{"schema", 1}, {"verdict", text_of(d.verdict)}, {"named", d.named}, {"group", d.group}};
  j["probabilities"] = json::object();
  j["strength"] = json::object();
  j["effects"] = json::array();
  for (const ModelEvidence& m : d.models) {
    j["probabilities"][m.name()] = m.probability;
    if (m.effects.size() == 1) j["effects"].push_back({{"name", m.effects[0]}, {"probability", m.probability}});
  }
  for (const NamedStrength& s : d.strengths)
    j["strength"][s.name] = {
        {"value", s.interval.value}, {"low90", s.interval.low90}, {"high90", s.interval.high90}, {"unit", s.unit}};
  j["absorbable_by_recalibration"] = d.absorbable;
  j["where"] = json::array();
  for (const Region& r : d.where.regions)
    j["where"].push_back({{"apparatus", r.apparatus},
                          {"observable", r.observable},
                          {"region", r.region},
                          {"z", r.z},
                          {"relative_gap", r.relative_gap},
                          {"q_value", r.q},
                          {"u", r.u},
                          {"u_parts", parts_json(r.u_parts)}});
  j["shrink"] = d.shrink ? shrink_json(*d.shrink) : json();
  j["next_test"] = d.next_tests.empty() ? json() : next_json(d.next_tests[0]);
  j["sentence"] = verdict_sentence(d);
  j["shrink_predicted"] = d.predicted ? shrink_json(*d.predicted) : json();
  j["next_tests"] = json::array();
  for (const NextTest& t : d.next_tests) j["next_tests"].push_back(next_json(t));
  j["trends"] = json::array();
  for (const Trend& t : d.trends)
    j["trends"].push_back({{"apparatus", t.apparatus},
                           {"observable", t.observable},
                           {"condition", t.condition},
                           {"exponent", t.exponent},
                           {"u", t.u},
                           {"z", t.z},
                           {"q_value", t.q},
                           {"u_parts", parts_json(t.u_parts)}});
  j["log_odds"] = {{"best_rival", d.log_odds},
                   {"threshold", d.threshold.log_odds},
                   {"threshold_low95", d.threshold.low95},
                   {"threshold_high95", d.threshold.high95},
                   {"draws", d.threshold.draws},
                   {"libraries", d.threshold.libraries}};
  j["fit_probability"] = d.fit.all;
  j["worst_fit"] = {{"apparatus", d.fit.apparatus}, {"observable", d.fit.observable}, {"probability", d.fit.worst}};
  j["sensitivity"] = json::array();
  for (const Sensitivity& s : d.sensitivity)
    j["sensitivity"].push_back(
        {{"change", s.change}, {"verdict", text_of(s.verdict)}, {"top", s.top}, {"probability", s.probability}});
  j["rows"] = {{"fit", d.fit_rows}, {"check", d.check_rows}};
  j["notes"] = d.notes;
  j["provenance"] = provenance;
  return j;
}

std::string verdict_sentence(const Diagnosis& d) {
  const std::string there = d.of_a_change ? "Something has changed" : "There is a gap";
  const std::string none = d.of_a_change ? "no change" : "no gap";
  const auto probability = [&](const std::string& name) {
    const ModelEvidence* m = d.model(name);
    return m ? 100 * m->probability : 0.0;
  };
  const auto strength = [&](std::size_t i) {
    const NamedStrength& s = d.strengths[i];
    return fmt::format("{} at strength {:.3g}{} (90 %: {:.3g} to {:.3g})", s.name, s.interval.value,
                       s.unit == "1" ? "" : " " + s.unit, s.interval.low90, s.interval.high90);
  };
  const ModelEvidence* nearest = nullptr;
  for (const ModelEvidence& m : d.models)
    if (!nearest && !m.effects.empty()) nearest = &m;
  if (d.verdict == Verdict::no_gap) {
    const std::string expected = d.of_a_change ? "what the reference state lets expect" : "the calibrated simulation";
    // The verdict goes by the threshold on the odds, the probability by the priors: the two need not agree.
    if (probability("no_gap") < 50)
      return fmt::format(
          "{} is shown: the measurement differs from {}, but no cause stands out more than chance lets one do in a "
          "hundred tables without any (probability of {} {:.0f} %).",
          d.of_a_change ? "No change" : "No gap", expected, none, probability("no_gap"));
    return fmt::format(
        "{}: the measurement agrees with {} within everything that is uncertain (probability of {} {:.0f} %).",
        d.of_a_change ? "No change" : "No gap", expected, none, probability("no_gap"));
  }
  if (d.verdict == Verdict::unknown) {
    std::string text = fmt::format(
        "{}, and none of the effects in the library nor any two of them explain it (unknown {:.0f} %, {} {:.0f} %).",
        there, probability("unknown"), none, probability("no_gap"));
    constexpr double kOff = 0.05;
    if (nearest && d.fit.worst < kOff)
      text += fmt::format(" Nearest is {}, which leaves the rows of {} {} off as one table in {:.0f} would.",
                          nearest->name(), d.fit.apparatus, d.fit.observable, 1 / std::max(d.fit.worst, 1e-9));
    return text;
  }
  if (d.verdict == Verdict::ambiguous) {
    constexpr std::size_t kSaid = 3;  // the whole group stands in the table below the sentence
    std::vector<std::string> rivals;
    for (std::size_t k = 0; k < std::min(kSaid, d.group.size()); ++k) {
      const std::string& name = d.group[k];
      double with_pairs = 0;
      for (const ModelEvidence& m : d.models)
        if (std::find(m.effects.begin(), m.effects.end(), name) != m.effects.end()) with_pairs += 100 * m.probability;
      rivals.push_back(fmt::format("{} {:.0f} % ({:.0f} % with its pairs)", name, probability(name), with_pairs));
    }
    if (d.group.size() > kSaid) rivals.push_back(fmt::format("{} others", d.group.size() - kSaid));
    return fmt::format("{}, and these data do not settle its cause: {}; unknown {:.0f} %, {} {:.0f} %.", there,
                       fmt::join(rivals, ", "), probability("unknown"), none, probability("no_gap"));
  }
  if (d.named.size() == 2)
    return fmt::format("{}, explained by two effects together: {}, and {} (probability {:.0f} %).", there, strength(0),
                       strength(1), probability(d.named[0] + "+" + d.named[1]));
  return fmt::format("{}, explained by {} (probability {:.0f} %).", there, strength(0), probability(d.named[0]));
}

}  // namespace vielto::gap

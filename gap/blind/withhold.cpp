// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/blind/withhold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/seal.h"
#include "core/sha256.h"
#include "gap/blind/case_kind.h"
#include "gap/blind/power_signal.h"
#include "gap/question/question.h"
#include "gap/question/sealed.h"
#include "gap/verdict/regions.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::VectorXd;
using json = nlohmann::ordered_json;

struct Plan {
  int no_effect_draws, truths_per_effect, draws, removed, sham, pairs, from_prior;
  double reachable;
  std::vector<std::pair<std::string, double>> levels;
  std::optional<PowerSignal> signal;  // without it errors of powers are Gaussian draws too
};

Plan read_plan(const std::string& path) {
  const TomlTable t = TomlTable::read(path);
  t.only({"no_effect_draws", "weak", "middle", "strong", "truths_per_effect", "draws", "removed", "sham", "pairs",
          "from_prior", "reachable", "power_signal"});
  const auto count = [&](const char* key) { return static_cast<int>(t.number(key, 0, 1e5)); };
  Plan p{count("no_effect_draws"),
         count("truths_per_effect"),
         count("draws"),
         count("removed"),
         count("sham"),
         count("pairs"),
         count("from_prior"),
         t.number("reachable", 0, 1),
         {},
         {}};
  for (const char* level : {"weak", "middle", "strong"}) p.levels.emplace_back(level, t.number(level, 0.1, 1e3));
  if (t.has("power_signal")) {
    const TomlTable signal = t.table("power_signal");
    signal.only({"rate", "duration", "correlation", "drift", "ripple", "step"});
    p.signal = PowerSignal{signal.number("rate", 0.01, 1e4),        signal.number("duration", 1, 1e5),
                           signal.number("correlation", 1e-3, 1e4), signal.number("drift", 0, 1),
                           signal.number("ripple", 0, 10),          signal.number("step", 0, 1e3)};
    const double samples = p.signal->rate * p.signal->duration;
    if (!(samples >= 2 && samples <= 1e6))
      signal.refuse("duration", fmt::format("times rate makes {:g} samples", samples), "state 2 to a million");
  }
  return p;
}

using Effects = std::vector<std::pair<std::string, double>>;  // names and strengths in the truth's own terms

struct Case {
  CaseKind kind = CaseKind::none;
  std::string level;  // weak, middle, strong; empty
  int truth = 0;
  Effects effects;
  std::vector<std::string> without;
  VectorXd observed;
};

class Maker {
 public:
  explicit Maker(const WithholdRequest& request)
      : request_(request), plan_(read_plan(request.plan)), library_(request.library), random_(request.seed) {
    table_ = read_reduced_table(request.tests);
    if (!table_.covariance_path.empty())
      throw BadInput(table_.covariance_path, 0, "is not carried into cases", "state tests with independent errors");
    options_.ignored = {request.ignored.begin(), request.ignored.end()};
    library_model_ = library_.emulator.model(table_, options_, library_.settings);
    for (const std::string& folder : request.truths) {
      InputFiles files = request.library.completed();
      files.library = folder;
      if (!request.truth_effects.empty()) files.effects = request.truth_effects;
      const Inputs truth(files);
      EmulatorOptions options = options_;
      options.use_discrepancy = false;
      truths_.push_back(truth.emulator.model(table_, options, truth.settings));
    }
    u_.resize(library_model_.size());
    for (Index i = 0; i < u_.size(); ++i) u_[i] = table_.rows[i].u;
  }

  void draw_reference() {
    if (fs::exists(request_.out)) throw BadInput(request_.out, 0, "is there already", "name a file to be made");
    write_observations(request_.out, rows_with(draw(0, {})));
  }

  WithholdResult make() {
    fit_ = rows_of(table_, Role::fit);
    read_isolability();
    for (int t = 0; t < static_cast<int>(truths_.size()); ++t)
      for (int d = 0; d < plan_.no_effect_draws; ++d) add({CaseKind::none, "", t, {}, {}, {}});
    std::vector<Case> strong;
    int next_truth = 0;
    for (const EffectResponse& e : candidates())
      for (const auto& [level, k] : plan_.levels)
        for (int t = 0; t < std::min<int>(plan_.truths_per_effect, static_cast<int>(truths_.size())); ++t) {
          const int truth = next_truth++ % static_cast<int>(truths_.size());
          for (int d = 0; d < plan_.draws; ++d) {
            const auto s = strength_for(truth, e.name, k, d % 2 == 1);
            if (!s) {
              unreachable_ += fmt::format("{},{},{},{}\n", e.name, level, name_of_truth(truth), k);
              ++result_.unreachable;
              continue;
            }
            const Case& made = add({CaseKind::known, level, truth, {{e.name, *s}}, {}, {}});
            if (level == "strong") strong.push_back(made);
          }
        }
    std::shuffle(strong.begin(), strong.end(), random_);
    for (std::size_t i = 0; i < strong.size() && static_cast<int>(i) < plan_.removed; ++i) {
      Case c = strong[i];
      c.kind = CaseKind::removed;
      c.without = group_of(c);
      add(c);
    }
    for (std::size_t i = 0; i < strong.size() && static_cast<int>(i) < plan_.sham; ++i) {
      Case c = strong[strong.size() - 1 - i];
      c.kind = CaseKind::sham;
      // the group of another effect, at its strength in another strong case,
      // which the true one does not belong to
      std::vector<std::vector<std::string>> others;
      for (const Case& other : strong)
        if (auto group = group_of(other); !contains(group, c.effects[0].first)) others.push_back(std::move(group));
      if (others.empty()) continue;
      c.without = others[std::uniform_int_distribution<std::size_t>(0, others.size() - 1)(random_)];
      add(c);
    }
    const auto any_effect = [&] {
      return candidates()[std::uniform_int_distribution<std::size_t>(0, candidates().size() - 1)(random_)];
    };
    const auto any_truth = [&] {
      return std::uniform_int_distribution<int>(0, static_cast<int>(truths_.size()) - 1)(random_);
    };
    for (int i = 0, tries = 0; i < plan_.pairs && tries < 100 * plan_.pairs; ++tries) {
      const int truth = any_truth();
      const std::string a = any_effect().name, b = any_effect().name;
      if (a == b) continue;
      const auto s = strength_for(truth, a, plan_.levels[1].second, false),
                 t = strength_for(truth, b, plan_.levels[1].second, false);
      if (!s || !t || contains(group_of(truth, a, *s), b) || contains(group_of(truth, b, *t), a)) continue;
      add({CaseKind::pair, "middle", truth, {{a, *s}, {b, *t}}, {}, {}});
      ++i;
    }
    for (int i = 0; i < plan_.from_prior; ++i) {
      const int truth = any_truth();
      const EffectResponse e = any_effect();
      const EffectResponse* own = truths_[truth].effect(e.name);
      if (!own) continue;
      const double s = std::uniform_real_distribution<double>(own->low, own->high)(random_);
      add({CaseKind::prior, "", truth, {{e.name, s}}, {}, {}});
    }
    write();
    return result_;
  }

 private:
  // What groups rest on: the seal must be of these rows, and of this reference.
  void read_isolability() {
    const json sealed = read_sealed(request_.isolability);
    std::string rows;
    if (request_.reference.empty()) {
      const TableModel fit = library_model_.part(fit_);
      rows = rows_fingerprint(fit.rows, fit.noise);
    } else {
      QuestionOptions asked;
      asked.files = request_.library;
      asked.table = request_.tests;
      asked.reference = request_.reference;
      asked.emulator = options_;
      question_.emplace(asked);
      rows = question_->fingerprint_of_rows();
    }
    if (sealed.value("rows", "") != rows)
      throw BadInput(request_.isolability, 0, fmt::format("was sealed for other rows than those of {}", request_.tests),
                     "seal those: vielto gap isolability");
    isolability_ = isolability_of_json(sealed, request_.isolability);
  }

  const std::vector<EffectResponse>& candidates() const {
    return question_ ? question_->model.effects : library_model_.effects;
  }

  // What can stand in for an effect at its strength, in the library's terms.
  std::vector<std::string> group_of(int truth, const std::string& effect, double strength) const {
    return isolability_.group_of(effect, library_strength(truth, effect, strength));
  }
  std::vector<std::string> group_of(const Case& c) const {
    return group_of(c.truth, c.effects[0].first, c.effects[0].second);
  }
  static bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  VectorXd change(const TableModel& model, const Effects& effects) const {
    VectorXd factor = VectorXd::Ones(model.size()), sum = VectorXd::Zero(model.size());
    for (const auto& [name, s] : effects) {
      const VectorXd r = model.effect(name)->response(s);
      sum += r;
      factor.array() *= 1 + r.array() / model.baseline.array();
    }
    return (model.relative.array() > 0).select((model.baseline.array() * (factor.array() - 1)), sum.array());
  }

  // The gap over u, by the protocol's definition of strength.
  double size_of(const VectorXd& gap) const {
    const VectorXd z = gap.cwiseQuotient(u_)(fit_).cwiseAbs();
    const double limit = z.maxCoeff() / 5;
    double sum = 0;
    int n = 0;
    for (const double x : z)
      if (x > limit) sum += x * x, ++n;
    return n > 0 ? std::sqrt(sum / n) : 0;
  }

  // The first strength on the reachable part of the prior with a gap of k u; on the other side of 0 if `negative` and
  // there is one.
  std::optional<double> strength_for(int truth, const std::string& name, double k, bool negative) const {
    const EffectResponse* e = truths_[truth].effect(name);
    if (!e) return std::nullopt;
    const double end = plan_.reachable * ((negative && e->low < 0) || e->high == 0 ? e->low : e->high);
    double before = 0;
    for (int i = 1; i <= 400; ++i) {
      const double s = end * i / 400;
      if (size_of(change(truths_[truth], {{name, s}})) < k) {
        before = s;
        continue;
      }
      double low = before, high = s;
      for (int j = 0; j < 40; ++j) {
        const double middle = (low + high) / 2;
        (size_of(change(truths_[truth], {{name, middle}})) < k ? low : high) = middle;
      }
      return (low + high) / 2;
    }
    return std::nullopt;
  }

  // The library's strength closest to the truth's noise-free change; of a reference the relative change.
  double library_strength(int truth, const std::string& name, double strength) const {
    VectorXd truth_change = change(truths_[truth], {{name, strength}});
    if (question_)
      truth_change.array() *= (library_model_.relative.array() > 0)
                                  .select(library_model_.baseline.array() / truths_[truth].baseline.array(), 1.0);
    const EffectResponse* e = library_model_.effect(name);
    double best = 0, least = 1e300;
    for (int i = 0; i <= 2000; ++i) {
      const double s = e->low + (e->high - e->low) * i / 2000;
      const double d = ((truth_change - e->response(s)).cwiseQuotient(u_))(fit_).squaredNorm();
      if (d < least) least = d, best = s;
    }
    return best;
  }

  // A measurement of a truth with its effects: one draw of the runs' scatter and of the rows' errors.
  VectorXd draw(int number, const Effects& effects) {
    const TableModel& truth = truths_[number];
    std::normal_distribution<double> normal;
    Eigen::MatrixXd covariance = truth.noise + truth.seed;
    const VectorXd free_of_noise = truth.baseline + change(truth, effects);
    VectorXd signal_error = VectorXd::Zero(truth.size());
    for (Index i = 0; plan_.signal && i < truth.size(); ++i) {
      const Observation& row = table_.rows[static_cast<std::size_t>(i)];
      if (row.observable != "power") continue;
      covariance(i, i) -= truth.noise(i, i);
      signal_error[i] = mean_error(*plan_.signal, free_of_noise[i], row.speed.value_or(0), u_[i], random_);
    }
    covariance.diagonal().array() += 1e-14 * covariance.diagonal().mean();
    VectorXd z(truth.size());
    for (double& x : z) x = normal(random_);
    return free_of_noise + signal_error + covariance.llt().matrixL() * z;
  }

  std::string name_of_truth(int truth) const { return fs::path(request_.truths[truth]).lexically_normal().filename(); }

  const Case& add(Case c) {
    if (c.observed.size() == 0) c.observed = draw(c.truth, c.effects);
    cases_.push_back(std::move(c));
    return cases_.back();
  }

  std::vector<Observation> rows_with(const VectorXd& values) const {
    std::vector<Observation> rows = table_.rows;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].value = values[static_cast<Index>(i)];
    return rows;
  }

  // Root mean square relative gap of the check rows to what is simulated with these effects, noise taken out.
  double check_gap(const VectorXd& observed, const Effects& effects) const {
    ReducedTable measured = table_;
    measured.rows = rows_with(observed);
    if (question_) measured = averaged(measured).table;
    const TableModel& model = question_ ? question_->model : library_model_;
    const VectorXd simulated = model.baseline + change(model, effects);
    double sum = 0;
    int n = 0;
    for (Index i = 0; i < simulated.size(); ++i) {
      const Observation& row = measured.rows[static_cast<std::size_t>(i)];
      if (row.role != Role::check) continue;
      sum += std::pow(simulated[i] / row.value - 1, 2) - std::pow(row.u / row.value, 2);
      ++n;
    }
    return n > 0 ? std::sqrt(std::max(0.0, sum / n)) : 0;
  }

  void write() {
    const fs::path out(request_.out), partial(request_.out + ".partial");
    if (fs::exists(out)) throw BadInput(out.string(), 0, "is there already", "withhold into a new folder");
    fs::remove_all(partial);
    fs::create_directories(partial / "truth");
    // The order says nothing about the kind.
    std::shuffle(cases_.begin(), cases_.end(), random_);
    std::string seals;
    int number = 0;
    for (const Case& c : cases_) {
      const std::string id = fmt::format("{:04}", ++number);
      fs::create_directories(partial / "cases" / id);
      write_observations((partial / "cases" / id / "observations.csv").string(), rows_with(c.observed));
      write_whole_file((partial / "cases" / id / "case.json").string(),
                       json({{"schema", 1}, {"without", c.without}}).dump(2) + "\n");
      const TableModel& truth = truths_[c.truth];
      const VectorXd moved = change(truth, c.effects);
      json j = {{"schema", 1},
                {"case", id},
                {"nonce", fmt::format("{:016x}", random_())},
                {"kind", text_of(c.kind)},
                {"level", c.level},
                {"base_truth", name_of_truth(c.truth)}};
      j["effects"] = json::object();
      Effects library_effects;
      for (const auto& [name, s] : c.effects) {
        const double own = library_strength(c.truth, name, s);
        library_effects.emplace_back(name, own);
        j["effects"][name] = {{"truth_strength", s},
                              {"strength", own},
                              {"group", isolability_.group_of(name, own)},
                              {"detectable", isolability_.detectable(name, own)}};
      }
      j["removed"] = c.without;
      j["regions"] = json::array();
      std::vector<Observation> fit_rows;
      for (const Index i : fit_) fit_rows.push_back(table_.rows[i]);
      const VectorXd z = moved.cwiseQuotient(u_)(fit_);
      for (const Region& r : regions_of(fit_rows))
        if (std::sqrt(z(r.rows).squaredNorm() / static_cast<double>(r.rows.size())) > 2)
          j["regions"].push_back(r.apparatus + " " + r.observable + " " + r.region);
      j["check_before"] = check_gap(c.observed, {});
      j["check_true_effect"] = check_gap(c.observed, library_effects);
      const fs::path file = partial / "truth" / (id + ".json");
      write_whole_file(file.string(), j.dump(2) + "\n");
      seals += fmt::format("{}  truth/{}.json\n", sha256_of_file(file.string()), id);
    }
    write_whole_file((partial / "seals.sha256").string(), seals);
    write_whole_file((partial / "unreachable.csv").string(), "effect,strength,base_truth,k\n" + unreachable_);
    fs::rename(partial, out);
    result_.cases = number;
  }

  WithholdRequest request_;
  Plan plan_;
  Inputs library_;
  std::mt19937_64 random_;
  EmulatorOptions options_;
  ReducedTable table_;
  TableModel library_model_;
  std::vector<Index> fit_;
  std::vector<TableModel> truths_;
  Isolability isolability_;           // as sealed
  std::optional<Question> question_;  // with a reference
  VectorXd u_;
  std::vector<Case> cases_;
  std::string unreachable_;
  WithholdResult result_;
};

}  // namespace

WithholdResult withhold(const WithholdRequest& request) {
  if (request.truths.empty())
    throw BadInput("--truth", 0, "names no base truth", "name response libraries of other laws");
  if (!request.reference.empty() && request.truths.size() > 1)
    throw BadInput("--reference", 0, "is of one base truth", "name one --truth");
  return Maker(request).make();
}

void draw_reference(const WithholdRequest& request) {
  if (request.truths.size() != 1) throw BadInput("--draw-reference", 0, "is of one base truth", "name one --truth");
  Maker(request).draw_reference();
}

}  // namespace vielto::gap

// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the verdict on one observation table, and everything that stands beside it.
//
// Verdict, from the evidence of all models (evidence.h):
//   no_gap     the best rival's log odds stay below the bootstrap threshold, and what no gap leaves in the table or in
//              one observable (fit.h) is not rarer than misfit_probability: a gap that no rival resembles has no odds,
//              but it is one
//   unknown    the unnamed gap holds more than unknown_probability of the rivals' probability, or the most probable
//              named model does not fit: what it leaves is rarer than misfit_probability in the table, or rarer than
//              name_misfit_probability in one observable
//   named      one model holds name_probability of the rivals' probability; or one effect does, alone and in pairs
//              together, and alone it is more probable than any pair
//   ambiguous  else; the group is the smallest set of single effects that holds group_probability of the singles'
// Absorbable by recalibration: with g the gap (of the named effect, else the observed one), A the covariance of the
// family and N = C(0) - A, the shift the family would take is h = A (A + N)^-1 g and the part absorbed 1 - (g-h)' N^-1
// (g-h) / g' N^-1 g.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gap/answer/variant.h"
#include "gap/answer/verdict.h"
#include "gap/verdict/evidence.h"
#include "gap/verdict/fit.h"
#include "gap/verdict/isolability.h"
#include "gap/verdict/regions.h"
#include "gap/verdict/test_design.h"
#include "gap/verdict/threshold.h"
#include "gap/verdict/trends.h"

namespace vielto::gap {

struct NamedStrength {
  std::string name, unit;
  Interval interval;
};

// What the runs of a proof say at one check row: value and standard uncertainty of each variant but the placebo.
struct SimulatedAgain {
  std::string test, observable;
  struct Value {
    Variant variant = Variant::before;
    double value = 0, u = 0;
  };
  std::vector<Value> values;
};

// Root-mean-square relative gaps over the check rows with the measurement noise taken out.
struct Shrink {
  int tests = 0;
  double before = 0, recalibrated = 0, after = 0, placebo = 0;
  // Their squares before those below 0 (noise larger than the gap) are set to 0.
  double before2 = 0, recalibrated2 = 0, after2 = 0, placebo2 = 0;
  Interval closed;  // 1 - after/before
  std::string placebo_name;
  std::vector<SimulatedAgain> runs;  // of a measured shrink
};

// The measured side of a shrink: values, their covariance, and the test of each row.
struct CheckRows {
  Eigen::VectorXd observed;
  Eigen::MatrixXd noise;
  std::vector<std::string> tests;
};

// Simulated values of the check rows and the standard uncertainty of each.
struct SimulatedRows {
  Eigen::VectorXd value, u;
};

struct Sensitivity {
  std::string change;
  Verdict verdict = Verdict::no_gap;
  std::string top;
  double probability = 0;  // of top among the rivals
};

struct Diagnosis {
  Verdict verdict = Verdict::no_gap;
  std::vector<std::string> named, group;
  std::vector<ModelEvidence> models;  // most probable first
  std::vector<NamedStrength> strengths;
  double absorbable = 0;
  Location where;
  std::vector<Trend> trends;
  Threshold threshold;
  double log_odds = 0;              // of the best rival
  Fit fit;                          // of the most probable named model (or of no gap)
  std::optional<Shrink> shrink;     // measured by re-simulation
  std::optional<Shrink> predicted;  // by the emulator, before it
  std::vector<NextTest> next_tests;
  std::vector<Sensitivity> sensitivity;
  std::vector<std::string> notes;
  int fit_rows = 0, check_rows = 0;
  bool of_a_change = false;  // against a reference state: what has changed, not why the simulation is off

  const ModelEvidence* model(const std::string& name) const;
  // The effects the after runs are made with: the named ones or the best of the group; none for no_gap and unknown.
  std::vector<std::string> applied() const;
};

struct Judgement {
  Verdict verdict = Verdict::no_gap;
  std::vector<std::string> named, group;
  Fit fit;
};

// `models` with probabilities, sorted by them; `gap_found`: the log odds exceed the threshold.
Judgement judged(const TableModel& model, std::vector<ModelEvidence>& models, bool gap_found, const Settings& settings);

double absorbable_part(const TableModel& model, const Eigen::VectorXd& gap);

// `model` holds all rows of the table, their role decides.
Diagnosis diagnose(const TableModel& model, const Threshold& threshold, const Settings& settings);

// Mean parameters of the calibrated family given the fit rows, under the effects at their strengths.
Eigen::VectorXd recalibrated_parameters(const TableModel& fit, const std::vector<std::string>& effects,
                                        const std::vector<double>& strengths);

// The best single effect from outside the diagnosis' own and their groups at
// the estimated strengths.
const ModelEvidence* placebo_of(const Diagnosis& diagnosis, const Isolability& isolability);

// The shrink from simulated values of the check rows, all in the order of `rows`. The interval of `closed` redraws the
// noise of measurement and simulations, and from five tests on which tests there are: fewer say nothing about others.
Shrink shrink_of(const CheckRows& rows, const SimulatedRows& before, const SimulatedRows& recalibrated,
                 const SimulatedRows& after, const SimulatedRows& placebo);

// What the emulator expects of the re-simulation; nothing without check rows or for no_gap and unknown.
std::optional<Shrink> predicted_shrink(const TableModel& model, const Diagnosis& diagnosis,
                                       const Isolability& isolability);

nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis, const nlohmann::ordered_json& provenance);
nlohmann::ordered_json shrink_json(const Shrink& shrink);
// The verdict for a person.
std::string verdict_sentence(const Diagnosis& diagnosis);

}  // namespace vielto::gap

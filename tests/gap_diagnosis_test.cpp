// SPDX-License-Identifier: GPL-2.0-or-later
// The diagnosis on toy rigs with a known truth: the right name, the right strength, few false alarms.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

#include "diagnosis.h"
#include "gap_toy.h"
#include "inputs.h"

namespace {

namespace fs = std::filesystem;
using namespace vielto;
using namespace vielto::gap;

InputFiles toy_files(const fs::path& library) {
  return {library.string(), VIELTO_SOURCE_DIR "/gap/effects", VIELTO_SOURCE_DIR "/gap/diagnosis.toml"};
}

// One library for all tests of the suite.
class GapDiagnosis : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("gap_diagnosis_{}", getpid());
    fs::remove_all(folder_);
    toy::write_library(folder_ / "library", toy::effects_with_runs(), 0, 7);
    toy::write_discrepancy(folder_ / "library");
    inputs_ = std::make_unique<Inputs>(toy_files(folder_ / "library"));
    std::mt19937_64 random(1);
    const TableModel fit = fit_model(model(toy::measured({}, random)));
    threshold_ = bootstrap_threshold(inputs_->emulator, fit, inputs_->settings, 1, [&](const Emulator& e) {
      return fit_model(e.model(table(toy::measured({}, random)), {}, inputs_->settings));
    });
  }
  static void TearDownTestSuite() {
    inputs_.reset();
    fs::remove_all(folder_);
  }
  static ReducedTable table(const std::vector<Observation>& rows) {
    const std::string path = (folder_ / "table.csv").string();
    write_observations(path, rows);
    return read_reduced_table(path);
  }
  static TableModel model(const std::vector<Observation>& rows, bool with_discrepancy = true) {
    EmulatorOptions options;
    options.use_discrepancy = with_discrepancy;
    return inputs_->emulator.model(table(rows), options, inputs_->settings);
  }
  static TableModel fit_model(const TableModel& m) {
    std::vector<Eigen::Index> keep;
    for (std::size_t i = 0; i < m.rows.size(); ++i)
      if (m.rows[i].role == "fit") keep.push_back(static_cast<Eigen::Index>(i));
    return m.part(keep);
  }

  static fs::path folder_;
  static std::unique_ptr<Inputs> inputs_;
  static Threshold threshold_;
};
fs::path GapDiagnosis::folder_;
std::unique_ptr<Inputs> GapDiagnosis::inputs_;
Threshold GapDiagnosis::threshold_;


TEST_F(GapDiagnosis, Explore) {
  for (const double law : {0.0, 1.0}) for (const double eta : {0.25, 0.1}) {
  std::mt19937_64 random(5);
  const std::map<std::string, double> truths = {
      {"cohesion", 40000}, {"shape", 0.3}, {"wall_friction", 9}, {"dissipation", 0.25}, {"sensor_gain", 0.12}, {"",0}};
  for (const auto& [name, strength] : truths) {
    std::map<std::string,int> verdicts; double ratio=0; int covered=0, n=0; double fit=0;
    for (int draw=0; draw<25; ++draw) {
    toy::State state;
    if (strength!=0) state.effects[name] = strength;
    state.law = law;
    TableModel m = model(toy::measured(state, random));
    for (auto& e : m.effects) e.shape_error *= eta/0.25;
    const Diagnosis d = diagnose(m, threshold_, inputs_->settings);
    verdicts[d.verdict + " " + fmt::format("{}", fmt::join(d.named, "+"))]++;
    fit += d.fit_probability/25;
    if (strength != 0) if (const ModelEvidence* e = d.model(name)) { auto i = e->strength(0); ratio += i.value/strength; covered += i.low90<=strength && strength<=i.high90; ++n; }
    }
    fmt::print("law {} eta {} {} {}: ratio {:.3f} covered {}/{} fit {:.2f};", law, eta, name, strength, ratio/std::max(n,1), covered, n, fit);
    for (auto& [v,c] : verdicts) fmt::print(" [{}] {}", v, c);
    fmt::print("\n");
  }}
}

}  // namespace

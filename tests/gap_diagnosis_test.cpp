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

TEST_F(GapDiagnosis, FindsEachEffectAndItsStrength) {
  std::mt19937_64 random(5);
  const std::map<std::string, double> truths = {
      {"cohesion", 40000}, {"shape", 0.3}, {"wall_friction", 9}, {"dissipation", 0.3}, {"sensor_gain", 0.12}};
  for (const auto& [name, strength] : truths) {
    toy::State state;
    state.effects[name] = strength;
    state.law = 1;
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis d = diagnose(model(toy::measured(state, random)), threshold_, inputs_->settings);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::string top;
    for (int i = 0; i < 5; ++i) top += fmt::format(" {} {:.3f}", d.models[i].name(), d.models[i].probability);
    double sum = 0;
    for (const ModelEvidence& m : d.models) sum += m.probability;
    EXPECT_NEAR(sum, 1, 1e-12);
    fmt::print("{} {}: {} [{}] odds {:.1f} threshold {:.2f} fit {:.3f} {:.1f} s absorbable {:.2f};{}\n", name, strength,
               d.verdict, fmt::join(d.named, "+"), d.log_odds, threshold_.log_odds, d.fit_probability, seconds, d.absorbable, top);
    for (const NamedStrength& s : d.strengths)
      fmt::print("   {} {:.4g} ({:.4g} to {:.4g})\n", s.name, s.interval.value, s.interval.low90, s.interval.high90);
  }
}

}  // namespace

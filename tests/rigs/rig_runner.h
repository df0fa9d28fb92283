// SPDX-License-Identifier: GPL-2.0-or-later
// Runs a rig through its own command line, in its own folder, with coarse soft grains that make a run of seconds.
//   Rig rig("shearbox");                      // a temporary folder, removed at the end
//   rig.must("a", coarse_shear);              // run folder a in it
//   Table rows = rig.csv("a/shear.csv");
#pragma once

#include <cmath>

#include "tests/engine/liggghts_runner.h"

namespace vielto_test {

// Grains of 6 mm under a tenth of the booklet's stress, as soft as that allows.
const std::string coarse_shear =
    "-var grainDiameter 0.006 -var youngsModulus 1e6 -var wall_youngsModulus 1e6 -var normalStress 1961 "
    "-var settleTime 0.12 -var loadTime 0.06 -var maxPlateError 0.5 -var maxOverlap 0.5 -var shearVelocity 0.1 "
    "-var displacement 0.004 ";
// Grains of 5 mm, lifted fast.
const std::string coarse_heap =
    "-var grainDiameter 0.005 -var youngsModulus 2e4 -var wall_youngsModulus 2e4 -var liftSpeed 0.2 "
    "-var maxOverlap 0.5 -var settleTime 0.2 ";

class Rig : public Liggghts {
 public:
  explicit Rig(const std::string& name) : name_(name) {}

  // The first -var of a name counts, so `more` goes before `options`.
  std::string command_of(const std::string& run, const std::string& options, const std::string& more = "",
                         int ranks = 1, Program program = Program::ours) const {
    return fmt::format("cd '{}/cases/{}' && PATH='{}':$PATH {} -log none -in in.{} -var run '{}' {} {}",
                       VIELTO_SOURCE_DIR, name_, VIELTO_BIN_DIR, command(ranks, program), name_,
                       (folder / run).string(), more, options);
  }
  Outcome rig(const std::string& run, const std::string& options, const std::string& more = "", int ranks = 1,
              Program program = Program::ours) {
    return shell(command_of(run, options, more, ranks, program));
  }
  // Demands success and a whole run folder.
  void must(const std::string& run, const std::string& options, const std::string& more = "", int ranks = 1,
            Program program = Program::ours) {
    const Outcome outcome = rig(run, options, more, ranks, program);
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    ASSERT_TRUE(std::filesystem::exists(folder / run / "run.json")) << outcome.text;
    ASSERT_FALSE(std::filesystem::exists(folder / (run + ".partial")));
  }
  Outcome vielto(const std::string& arguments) {
    return shell(fmt::format("cd '{}' && '{}/vielto' {}", folder.string(), VIELTO_BIN_DIR, arguments));
  }

 private:
  std::string name_;
};

// An option that a rig refuses with one line that holds the words; `rig` where a test is of several.
struct Refusal {
  std::string name, option;
  std::vector<std::string> words;
  std::string rig = {};
};
inline void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.option; }
inline std::string name_of(const testing::TestParamInfo<Refusal>& refusal) { return refusal.param.name; }

}  // namespace vielto_test

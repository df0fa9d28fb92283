// SPDX-License-Identifier: GPL-2.0-or-later
// Runs cases/mixer through its own command line, in its own folder, with coarse grains that make a run of seconds.
//   Mixer mixer;                              // a temporary folder, removed at the end
//   mixer.must("a", coarse);                  // run folder a in it
//   Table rows = mixer.csv("a/torque.csv");
#pragma once

#include <cmath>

#include "rig_runner.h"

namespace vielto_test {

// Grains of 16 mm, soft (a long time step), at the highest speed of the booklet; overlap and torque of so coarse a
// grain nipped in a clearance of 1 mm are not what these tests are about. A slice of four paddles holds some 360
// grains, of two 180.
const std::string four =
    "-var grainDiameter 0.016 -var youngsModulus 2e5 -var wall_youngsModulus 2e5 -var speed 1.58 -var settleTime 0.35 "
    "-var maxOverlap 0.5 -var maxTorque 0 -var turns 0.3 ";
const std::string two = "-var slicePaddles 2 " + four;

class Mixer : public Rig {
 public:
  Mixer() : Rig("mixer") {}

  // Starts a run and sends it a signal as soon as its record has a row beyond the step of its first restart file.
  Outcome break_off(const std::string& name, const std::string& options, const std::string& signal = "KILL") {
    const std::string wait =
        "step() { ls $d/restart 2>/dev/null | sort -n | head -1 | cut -d. -f1; }; "
        "last() { tail -n 1 $d/torque.csv | cut -d, -f1; }; "
        "until [ -n \"$(step)\" ] && [ $(last) -gt $(step) ]; do kill -0 $p || exit 99; sleep 0.02; done; ";
    return shell(fmt::format("d='{}.partial'; {} & p=$!; {} kill -{} $p; wait $p", (folder / name).string(),
                             command_of(name, options), wait, signal));
  }

  void must_break_off(const std::string& name, const std::string& options) {
    const Outcome outcome = break_off(name, options);
    ASSERT_EQ(outcome.status, 128 + 9) << outcome.text;
    ASSERT_TRUE(std::filesystem::exists(folder / (name + ".partial/torque.csv")));
    ASSERT_FALSE(std::filesystem::exists(folder / name));
  }

  // Value of a line `# key=value` of a record.
  std::string header(const std::string& name, const std::string& key) const {
    std::istringstream in(read(name + "/torque.csv"));
    const std::string start = "# " + key + "=";
    for (std::string line; std::getline(in, line);)
      if (line.rfind(start, 0) == 0) return line.substr(start.size());
    ADD_FAILURE() << name << " has no line # " << key << "=";
    return "";
  }
};

inline double rotor(const Table& rows, std::size_t k) {
  return rows.at(k, "paddles_Nm") + rows.at(k, "stems_Nm") + rows.at(k, "shaft_Nm");
}

// Root mean square over rows [first, last) of a column.
inline double rms(const Table& rows, const std::string& column, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t k = first; k < last; k++) sum += std::pow(rows.at(k, column), 2);
  return std::sqrt(sum / static_cast<double>(last - first));
}

}  // namespace vielto_test

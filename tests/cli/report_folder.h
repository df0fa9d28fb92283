// SPDX-License-Identifier: GPL-2.0-or-later
// Folders of which `vielto report` makes a page: a run, a fit, a shear box, a diagnosis.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/command_test.h"
#include "tests/rigs/synthetic_record.h"

namespace vielto_test {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kSource = VIELTO_SOURCE_DIR;
const std::string kVielto = "'" VIELTO_BIN_DIR "/vielto'";

class Report : public CommandTest {
 protected:
  int run(const std::string& command) { return CommandTest::run("env -u DISPLAY " + command); }
  int report(const std::string& arguments) { return run(kVielto + " report " + arguments); }

  // A finished run: its record, what `vielto post` makes of it, and what `liggghts` writes about itself.
  void make_run(const std::string& name, double speed = 1.21) {
    SyntheticRecord record;
    record.noise = 0.02;
    record.speed = speed;
    record.write(folder_ / name);
    ASSERT_EQ(run(kVielto + " post " + name), 0) << err_;
    write(
        name + "/run.json",
        R"({"status": "complete", "command": "liggghts -in in.mixer -var seed 7", "parameters": {"seed": "7", "fill": "0.15"},
      "versions": {"vielto": "0.1.0"}, "hashes": {"mixer.par": "499b6742"}})");
  }
  void make_fit(const std::string& name) {
    fs::create_directories(folder_ / name);
    fs::copy_file(kSource / "cases/mixer/results/thesis_equation.observations.csv", folder_ / name / "grid.csv");
    ASSERT_EQ(run(kVielto + " fit " + name + "/grid.csv --bulk-density 825 --bulk-cohesion 6175 --out " + name +
                  "/equation.json"),
              0)
        << err_;
  }
  void make_shear_box(const std::string& name) {
    std::string rows = "# schema=1\n# rig=shearbox\ntime_s,displacement_m,shear_force_N,plate_force_N\n";
    for (int i = 1; i <= 40; ++i) {
      const double t = 0.01 * i;
      rows += std::to_string(t) + "," + std::to_string(0.05 * t) + "," + std::to_string(30 * (1 - std::exp(-10 * t))) +
              ",70.6\n";
    }
    write(name + "/shear.csv", rows);
    write(name + "/post/shear.json",
          R"({"schema": 1, "shear_stress_peak_Pa": 8333.3, "notes": ["</script><script>alert(1)</script>"]})");
  }

  void make_diagnosis(const std::string& name, bool with_points = true) {
    json d = json::parse(content(kSource / "findings/wheat_walls/diagnosis.json"));
    d["verdict"] = "named";
    d["named"] = {"drive_loss"};
    d["group"] = json::array();
    d["sentence"] = "There is a gap, explained by drive_loss.";
    d["next_test"]["name"] = "weigh_the_load";
    d["reference"] = {{"table", "as_delivered.csv"},
                      {"rows", 6},
                      {"chi2_probability", 0.4},
                      {"transfer", 0.2},
                      {"scatter",
                       {{{"apparatus", "mixer"},
                         {"observable", "power"},
                         {"sd", 0.071},
                         {"degrees_of_freedom", 3},
                         {"assumed", true},
                         {"library", 0.034}}}}};
    d.erase("points");
    d["shrink"]["runs"] = {{{"test", "t_0.10_3"},
                            {"observable", "power"},
                            {"before", {{"value", 3.9}, {"u", 0.1}}},
                            {"after", {{"value", 3.1}, {"u", 0.1}}}}};
    const auto band = [](double value) {
      return json{{"value", value}, {"low95", 0.9 * value}, {"high95", 1.1 * value}};
    };
    if (with_points)
      for (const double fill : {0.1, 0.15, 0.2, 0.25})
        for (const double speed : {1, 2, 3, 4}) {
          const double measured = 10 * fill * speed;
          d["points"].push_back({{"test", "t_" + std::to_string(fill).substr(0, 4) + "_" + std::to_string(int(speed))},
                                 {"role", "fit"},
                                 {"apparatus", "mixer"},
                                 {"observable", "power"},
                                 {"unit", "W"},
                                 {"speed", speed},
                                 {"fill", fill},
                                 {"measured", band(measured)},
                                 {"before", band(measured * (1 + 0.1 * speed))},
                                 {"after", band(measured)}});
        }
    write(name + "/diagnosis.json", d.dump());
  }
};

}  // namespace vielto_test

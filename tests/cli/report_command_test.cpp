// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto report` through its command line: what the page and the files beside it hold, what is refused.
// What a browser makes of the page: report_browser_test.cpp.
#include <algorithm>
#include <array>
#include <sstream>

#include "tests/cli/report_folder.h"

namespace {

using namespace vielto_test;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

// The points of one series of a plot's CSV.
std::vector<std::array<double, 2>> series(const fs::path& path, const std::string& name) {
  std::vector<std::array<double, 2>> points;
  std::istringstream in(content(path));
  for (std::string line; std::getline(in, line);)
    if (line.rfind(name + ",", 0) == 0) {
      std::array<double, 2> point{};
      EXPECT_EQ(std::sscanf(line.c_str() + name.size() + 1, "%lf,%lf", &point[0], &point[1]), 2) << line;
      points.push_back(point);
    }
  return points;
}

// Expected from the generator's own numbers, not from the program: 4 paddles of 0.15 N m, stems 0.1 and shaft 0.05 in a
// slice of 4 of 22 paddles; power 2 pi n T.
TEST_F(Report, OfOneRunHoldsItsNumbersPlotsAndProvenance) {
  make_run("run");
  ASSERT_EQ(report("run"), 0) << err_;
  const fs::path out = folder_ / "run/report";
  const double torque = (4 * 0.15 + 0.1 + 0.05) * 22 / 4;
  double mean = 0;
  const auto points = series(out / "torque_over_time.csv", "torque");
  ASSERT_EQ(points.size(), 720u);  // ten turns of 72 phases
  for (const auto& p : points) mean += p[1] / 720;
  EXPECT_NEAR(mean, torque, 0.02 * 22 / 4 / std::sqrt(720.0) * 4);  // four standard errors of white noise
  EXPECT_NEAR(points.back()[0], 10 / 1.21 * (1 - 0.5 / 720), 1e-6);
  const auto phases = series(out / "torque_over_phase.csv", "rotor");
  ASSERT_EQ(phases.size(), 72u);
  double of_phases = 0;
  for (const auto& p : phases) of_phases += p[1] / 72;
  EXPECT_NEAR(of_phases, torque, 0.02);
  const auto power = series(out / "power_over_speed.csv", "l = 0.15");
  ASSERT_EQ(power.size(), 1u);
  EXPECT_NEAR(power[0][1], 2 * std::acos(-1.0) * 1.21 * torque, 0.2);
  // The published equation at its fastest speed, from the definitions: N_PC C_h L^3 n.
  const double n = 1.58, cohesion = 0.114 * 0.114 * n * n * 825 / 6175, froude = 0.114 * n * n / 9.81;
  const double published =
      15.68 * std::pow(0.15, 1.04) * std::pow(cohesion, 0.1) * std::pow(froude, -0.25) * 6175 * std::pow(0.114, 3) * n;
  const auto line = series(out / "power_over_speed.csv", "l = 0.15; published equation");
  ASSERT_FALSE(line.empty());
  EXPECT_NEAR(line.back()[0], n, 1e-12);
  EXPECT_NEAR(line.back()[1], published, 1e-6 * published);

  for (const char* plot : {"power_over_speed", "power_over_fill", "parity", "torque_over_time", "torque_over_phase"}) {
    const std::string svg = content(out / (std::string(plot) + ".svg"));
    EXPECT_EQ(svg.rfind("<svg", 0), 0u) << plot;
    EXPECT_GT(count(svg, "<path"), 5u) << plot;
  }
  const std::string page = content(out / "report.html");
  for (const char* part : {"Mixing power", "liggghts -in in.mixer -var seed 7", "499b6742", "version of vielto",
                           "Provisional", "post/power.json"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_NE(err_.find("no picture of run"), std::string::npos) << err_;
  EXPECT_EQ(count(page, "src=\"http"), 0u);
  EXPECT_FALSE(fs::exists(folder_ / "run/report.partial"));
  ASSERT_EQ(report("run"), 0) << err_;  // over the old report
}

TEST_F(Report, OfACampaignListsItsRuns) {
  make_run("grid/slow", 0.48);
  make_run("grid/fast", 1.58);
  ASSERT_EQ(report("grid"), 0) << err_;
  const std::string page = content(folder_ / "grid/report/report.html");
  EXPECT_EQ(count(page, "<details>"), 3u);  // each run, and the parameters of both
  EXPECT_NE(page.find("Runs evaluated"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "grid/report/slow_torque_over_time.svg"));
  EXPECT_TRUE(fs::exists(folder_ / "grid/report/fast_torque_over_phase.csv"));
  EXPECT_EQ(series(folder_ / "grid/report/power_over_speed.csv", "l = 0.15").size(), 2u);
}

TEST_F(Report, OfAFitShowsParityAndResidualsOverEveryGroup) {
  make_fit("equation");
  ASSERT_EQ(report("equation --out page"), 0) << err_;
  for (const char* group : {"speed", "l", "N_C", "Fr_M"})
    EXPECT_TRUE(fs::exists(folder_ / "page" / (std::string("equation_residuals_") + group + ".svg"))) << group;
  // The table is the booklet's equation itself, so the fit lies on it: 16 rows on the line of parity.
  const auto parity = series(folder_ / "page/equation_parity.csv", "rows fitted");
  ASSERT_EQ(parity.size(), 16u);
  for (const auto& p : parity) EXPECT_NEAR(p[1] / p[0], 1, 1e-4);
  const auto band = series(folder_ / "page/equation_parity.csv", "± 14.5 %");
  ASSERT_EQ(band.size(), 4u);
  EXPECT_NEAR(band[1][1] / band[1][0], 1.145, 1e-12);
  EXPECT_NEAR(band[3][1] / band[3][0], 0.855, 1e-12);
  const std::string page = content(folder_ / "page/report.html");
  EXPECT_NE(page.find("B2+B3"), std::string::npos);
  EXPECT_NE(page.find("not determined"), std::string::npos);
}

TEST_F(Report, OfAnotherRigDrawsItsColumnsByUnit) {
  make_shear_box("box");
  ASSERT_EQ(report("box"), 0) << err_;
  const fs::path out = folder_ / "box/report";
  const auto force = series(out / "shear_csv_N.csv", "shear_force_N");
  ASSERT_EQ(force.size(), 40u);
  EXPECT_NEAR(force.back()[0], 0.4, 1e-9);
  EXPECT_NEAR(force.back()[1], 30 * (1 - std::exp(-4.0)), 1e-4);
  const std::string page = content(out / "report.html");
  EXPECT_NE(page.find("shear_stress_peak_Pa"), std::string::npos);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);  // text from files is text
}

// Sixteen measured powers that the simulation overshoots by a share that grows with speed, closed by an effect.
TEST_F(Report, OfADiagnosisShowsVerdictMapAndBands) {
  make_diagnosis("answer");
  ASSERT_EQ(report("answer"), 0) << err_;
  const fs::path out = folder_ / "answer/report";
  const std::string page = content(out / "report.html");
  for (const char* part :
       {"<p class=\"verdict\">There is a gap, explained by drive loss", "Cause named", "with drive loss",
        "Map of the gap", "any other two together", "Next test", "weigh the load", "The reference state",
        "6 rows of as_delivered.csv", "<td>mixer power</td><td class=\"number\">7.1</td>", "repeats with 3 degrees"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  const auto simulated = series(out / "diagnosis_mixer_power_over_speed_fill_0_1.csv", "simulated");
  ASSERT_EQ(simulated.size(), 4u);
  EXPECT_DOUBLE_EQ(simulated[3][1], 10 * 0.1 * 4 * 1.4);
  // of the proof, told apart by test and observable
  const auto run = series(out / "diagnosis_mixer_power_over_speed_fill_0_1.csv", "run again with drive loss");
  ASSERT_EQ(run.size(), 1u);
  EXPECT_EQ(run[0], (std::array<double, 2>{3, 3.1}));
  EXPECT_TRUE(series(out / "diagnosis_mixer_power_over_speed_fill_0_2.csv", "run again").empty());
  const auto map = series(out / "diagnosis_mixer_power_gap_before.csv", "4");  // rows speed,fill,gap: those of speed 4
  ASSERT_EQ(map.size(), 4u);
  for (const auto& cell : map) EXPECT_NEAR(cell[1], 40, 1e-9);
  EXPECT_EQ(content(out / "diagnosis_mixer_power_over_speed_fill_0_1.svg").rfind("<svg", 0), 0u);
  // An answer without points, as older ones are, still makes a page; one without a verdict's numbers is refused.
  make_diagnosis("old", false);
  ASSERT_EQ(report("old"), 0) << err_;
  EXPECT_NE(content(folder_ / "old/report/report.html").find("has no points"), std::string::npos);
  write("bad/diagnosis.json", R"({"verdict": "named", "sentence": "", "probabilities": {}})");
  EXPECT_EQ(report("bad"), 2);
  EXPECT_NE(err_.find("bad/diagnosis.json: is no diagnosis"), std::string::npos) << err_;
  EXPECT_EQ(count(err_, "\n"), 1u) << err_;
  write("bad/diagnosis.json", R"({"verdict": "perhaps", "sentence": "", "probabilities": {}})");
  EXPECT_EQ(report("bad"), 2);
  EXPECT_NE(err_.find("bad/diagnosis.json: is no diagnosis (its verdict is 'perhaps')"), std::string::npos) << err_;
}

// Names from files are text wherever they stand: in the page, and in the data of its plots, which a script element
// holds.
TEST_F(Report, NamesThatWouldBeMarkupAreText) {
  make_diagnosis("answer");
  json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  const std::string name = "<!--<script>alert(1)</script>";
  for (auto& point : d["points"]) point["test"] = name + point["test"].get<std::string>();
  d["sentence"] = "There is a gap " + name;
  d["notes"] = {name};
  write("answer/diagnosis.json", d.dump());
  write("answer/" + std::string("<b>.csv"), "a,b\n1,2\n3,4\n");
  ASSERT_EQ(report("answer"), 0) << err_;
  const std::string page = content(folder_ / "answer/report/report.html");
  EXPECT_EQ(count(page, "<!--<script"), 0u);
  EXPECT_EQ(count(page, "alert(1)</script>"), 0u);
  EXPECT_EQ(count(page, "<b>"), 0u);
  EXPECT_GE(count(page, "&lt;script&gt;alert"), 1u);
  const std::string open = "id=\"plots\">";
  const auto from = page.find(open) + open.size();
  ASSERT_NE(page.find(open), std::string::npos);
  const std::string plots = page.substr(from, page.find('<', from) - from);
  EXPECT_EQ(page.compare(from + plots.size(), 9, "</script>"), 0);
  EXPECT_FALSE(json::parse(plots).empty());
}

// Whoever walks through JSON calls himself for each level: a million of them would leave no stack.
TEST_F(Report, RefusesJsonThatNestsTooDeep) {
  write("deep/result.json", std::string(1000000, '['));
  EXPECT_EQ(report("deep"), 2);
  EXPECT_NE(err_.find("deep/result.json: nests deeper than 100 levels"), std::string::npos) << err_;
  EXPECT_FALSE(fs::exists(folder_ / "deep/report"));
  write("deep/result.json", std::string(99, '[') + "1" + std::string(99, ']'));
  EXPECT_EQ(report("deep"), 0) << err_;
}

TEST_F(Report, RefusesInOneLineAndLeavesNothing) {
  make_run("run");
  fs::create_directories(folder_ / "empty");
  write("broken/torque.csv", content(folder_ / "run/torque.csv").substr(0, 3000));
  write("number/post/power.json", "{\"power_W\": ");
  fs::copy_file(folder_ / "run/torque.csv", folder_ / "number/torque.csv");
  write("table/shear.csv", "time_s,force_N\n1,2\n3\n");
  write("other/letter.txt", "mine");
  const std::map<std::string, std::string> cases = {{"nowhere", "is no folder"},
                                                    {"empty", "holds nothing to report"},
                                                    {"broken", "torque.csv, line "},
                                                    {"number", "power.json: is no JSON"},
                                                    {"table", "shear.csv, line 3: has 1 fields for 2 columns"},
                                                    {"run --out other", "other: exists and is no report"}};
  for (const auto& [arguments, reason] : cases) {
    EXPECT_EQ(report(arguments), 2) << arguments;
    EXPECT_EQ(count(err_, "\n"), 1u) << arguments << ": " << err_;
    EXPECT_NE(err_.find(reason), std::string::npos) << arguments << ": " << err_;
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    EXPECT_NE(entry.path().filename(), "report") << entry.path();
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
  }
  EXPECT_EQ(content(folder_ / "other/letter.txt"), "mine");
}

// A program installed without the plotting library (built without a network) says where to get it, and makes the rest.
TEST_F(Report, WithoutThePlottingLibraryAsksForIt) {
  make_run("run");
  fs::create_directories(folder_ / "install/bin");
  fs::create_directories(folder_ / "install/share/vielto/report");
  fs::copy_file(VIELTO_BIN_DIR "/vielto", folder_ / "install/bin/vielto");
  for (const char* file : {"page.css", "page.js", "shared.js", "svg.js"})
    fs::copy_file(kSource / "report/web" / file, folder_ / "install/share/vielto/report" / file);
  EXPECT_EQ(run("install/bin/vielto report run"), 2);
  EXPECT_NE(err_.find("scripts/get-echarts"), std::string::npos) << err_;
  EXPECT_FALSE(fs::exists(folder_ / "run/report"));
  ASSERT_EQ(run("install/bin/vielto report run --no-plots"), 0) << err_;
  EXPECT_NE(content(folder_ / "run/report/report.html").find("The plots were left out"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "run/report/parity.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "run/report/parity.svg"));
}

}  // namespace

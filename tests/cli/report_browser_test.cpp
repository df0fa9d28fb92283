// SPDX-License-Identifier: GPL-2.0-or-later
// What a browser makes of the pages of `vielto report`: four windows, phone and desktop, light and dark.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "tests/cli/report_folder.h"

namespace {

using namespace vielto_test;

class ReportInABrowser : public Report {
 protected:
  void SetUp() override {
    if (std::system("chromium --version >/dev/null 2>&1 && chromedriver --version >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "needs the packages of scripts/packages/browser.txt";
  }
  json look(const std::string& page) {
    EXPECT_EQ(run("/usr/bin/python3 '" + (kSource / "tests/cli/report_browser.py").string() + "' " + page + " shots"),
              0)
        << err_;
    return json::parse(content(folder_ / "out.txt"), nullptr, false);
  }
};

TEST_F(ReportInABrowser, OpensOfflineOnPhoneAndDesktopLightAndDark) {
  make_run("all/run");
  make_fit("all");
  make_shear_box("all");
  make_diagnosis("all");
  ASSERT_EQ(report("all"), 0) << err_;
  const json seen = look("all/report/report.html");
  ASSERT_EQ(seen.size(), 4u) << seen.dump();
  for (const auto& [window, page] : seen.items()) {
    EXPECT_TRUE(page["console"].empty()) << window << page["console"];
    EXPECT_TRUE(page["requests"].empty()) << window << page["requests"];
    EXPECT_EQ(page["page_loads"], 1) << window;  // the log of requests does record
    EXPECT_LE(page["opened"]["width"], page["window"]) << window;
    EXPECT_TRUE(page["opened"]["outside"].empty()) << window << page["opened"]["outside"];
    EXPECT_TRUE(page["opened"]["torn"].empty()) << window << page["opened"]["torn"];
    EXPECT_EQ(page["broken_pictures"], 0) << window;
    std::map<std::string, json> plots;
    for (const json& plot : page["opened"]["plots"]) plots[plot["name"]] = plot;
    for (const char* name : {"power_over_speed", "parity", "run_torque_over_time", "run_torque_over_phase",
                             "equation_parity", "equation_power_over_fill", "equation_residuals_N_C", "shear_csv_N",
                             "diagnosis_mixer_power_over_speed_fill_0_2", "diagnosis_mixer_power_gap_after"}) {
      ASSERT_TRUE(plots.count(name)) << name;
      EXPECT_GT(plots[name]["marks"], 8) << window << " " << name;
      EXPECT_GT(plots[name]["words"].size(), 6u) << window << " " << name;
    }
    const json& words = plots["parity"]["words"];
    EXPECT_NE(std::find(words.begin(), words.end(), "published equation / W"), words.end()) << window;
  }
  EXPECT_NE(seen["390 light"]["background"], seen["390 dark"]["background"]);
}

// The watch itself: a page that breaks every rule is seen to.
TEST_F(ReportInABrowser, ABadPageWouldBeSeen) {
  write("bad.html",
        "<!DOCTYPE html><title>bad</title><link rel=icon href='data:,'><main><div style='width:2000px'>wide</div>"
        "<p style='width:1px'>12 % of 3 ± 1</p>"
        "<img src='http://127.0.0.1:9/x.png'></main><script>console.error('oh');</script>");
  const json seen = look("bad.html");
  for (const auto& [window, page] : seen.items()) {
    EXPECT_GE(page["console"].size(), 1u) << window;
    EXPECT_EQ(page["requests"].size(), 1u) << window << page["requests"];
    EXPECT_FALSE(page["outside"].empty()) << window;
    EXPECT_EQ(page["torn"].size(), 2u) << window << page["torn"];
    EXPECT_EQ(page["broken_pictures"], 1) << window;
  }
}

}  // namespace

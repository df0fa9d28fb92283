// SPDX-License-Identifier: GPL-2.0-or-later
// yade/check through its command line: agreement of single contacts with Yade, and what it does with a difference and
// with bad input. Skipped where Yade is not installed; the command alone would install it.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace {

const std::string yade_folder = VIELTO_SOURCE_DIR "/yade";

struct Outcome {
  int status;
  std::string text;
};

class YadeCheck : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "vielto-test-XXXXXX").string();
    folder = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  Outcome check(const std::string& arguments) const {
    const std::string text = folder / "text";
    const int code = std::system(("'" + yade_folder + "/check' --liggghts '" VIELTO_BIN_DIR "/liggghts' --out '" +
                                  (folder / "out").string() + "' " + arguments + " > '" + text + "' 2>&1")
                                     .c_str());
    std::stringstream all;
    all << std::ifstream(text).rdbuf();
    return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, all.str()};
  }

  // The cases as they are, changed, as a file of the test.
  template <class Change>
  std::string changed_cases(Change change) const {
    std::ifstream in(yade_folder + "/contact/cases.json");
    nlohmann::json book = nlohmann::json::parse(in);
    for (nlohmann::json& c : book["cases"]) change(c);
    const std::string name = folder / "cases.json";
    std::ofstream(name) << book;
    return "--cases '" + name + "' ";
  }

  // One line, naming what is wrong.
  void refuses(const std::string& arguments, const std::string& what) const {
    const Outcome done = check(arguments);
    EXPECT_EQ(done.status, 2) << done.text;
    EXPECT_NE(done.text.find(what), std::string::npos) << done.text;
    EXPECT_EQ(std::count(done.text.begin(), done.text.end(), '\n'), 1) << done.text;
  }

  std::filesystem::path folder;
};

class YadeContact : public YadeCheck {
 protected:
  void SetUp() override {
    YadeCheck::SetUp();
    if (std::system("yade --version >/dev/null 2>&1 && /usr/bin/python3 -c 'import matplotlib' >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "Yade is not installed (scripts/install-packages yade)";
  }
};

// Relative limit 1e-6, far below the 0.1 % aimed at and above round-off and the turn of the normal.
TEST_F(YadeContact, AgreesInImpactsAndMoments) {
  const Outcome done = check(
      "--case normal_spheres --case oblique_wall_both --case oblique_spheres_unequal --case rolling_wall_cap_facet "
      "--case cohfrict_bond_tumbles --case cohfrict_bond_sheared --case cohfrict_wall_torn "
      "--case rolling_spheres_unequal --case twisting_wall_cap --case all_moments_spheres");
  EXPECT_EQ(done.status, 0) << done.text;
  for (const char* name : {"contact_check.csv", "contact_check.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
}

// One law differs in one setting that the mapping does not touch: found, unless the case explains it.
TEST_F(YadeContact, FindsADifferenceThatIsNotExplained) {
  const std::string cases = changed_cases([](nlohmann::json& c) { c.erase("differs"); });
  const Outcome done = check(cases + "--case printed_tension --case normal_spheres");
  EXPECT_EQ(done.status, 1) << done.text;
  EXPECT_NE(done.text.find("beyond the limit: printed_tension"), std::string::npos) << done.text;
}

TEST_F(YadeContact, ReportsAnEngineThatFails) {
  const std::string cases = changed_cases([](nlohmann::json& c) { c["springFactor"] = -1; });
  const Outcome done = check(cases + "--case normal_wall_box");
  EXPECT_EQ(done.status, 1) << done.text;
  EXPECT_NE(done.text.find("springFactor"), std::string::npos) << done.text;
}

TEST_F(YadeContact, RefusesAProgramThatIsNotThere) {
  refuses("--case normal_spheres --yade /no/yade", "no program '/no/yade'");
}

TEST_F(YadeCheck, RefusesBadInput) {
  refuses("--case nonsense", "no case 'nonsense'");
  refuses("--cases /no/such/file", "/no/such/file: No such file");
  std::ofstream(folder / "broken.json") << "{\n\"cases\": [,]\n}";
  refuses("--cases '" + (folder / "broken.json").string() + "'", "broken.json:2: no JSON");
  refuses(changed_cases([](nlohmann::json& c) { c.erase("step"); }), "normal_spheres: no entry 'step'");
  refuses(changed_cases([](nlohmann::json& c) { c["law"] = "Hertz"; }), "law 'Hertz'");
  refuses(changed_cases([](nlohmann::json& c) { c["materials"][1] = "cheese"; }), "no material 'cheese'");
  refuses(changed_cases([](nlohmann::json& c) { c["end"] = 0; }), "0 < step < end");
  refuses(changed_cases([](nlohmann::json& c) { c["wall"] = "ceiling"; }), "wall 'ceiling'");
}

TEST_F(YadeCheck, ListsTheCasesWithoutRunningThem) {
  const Outcome done = check("--list");
  EXPECT_EQ(done.status, 0);
  EXPECT_NE(done.text.find("twisting_wall_cap"), std::string::npos) << done.text;
}

}  // namespace

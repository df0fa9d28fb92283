// SPDX-License-Identifier: GPL-2.0-or-later
// vielto_laws through its command line: every law is stated whole, in both forms.
#include <gtest/gtest.h>
#include <stdio.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace {

struct Outcome {
  int status;
  std::string text;
};

Outcome run(const std::string& options) {
  FILE* pipe = popen((VIELTO_BIN_DIR "/vielto_laws " + options + " 2>&1").c_str(), "r");
  std::string text;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  const int code = pclose(pipe);
  return {WEXITSTATUS(code), text};
}

}  // namespace

TEST(LawPage, StatesEveryLawWhole) {
  const Outcome page = run(""), data = run("--json");
  ASSERT_EQ(page.status, 0);
  ASSERT_EQ(data.status, 0);
  const nlohmann::json laws = nlohmann::json::parse(data.text).at("laws");
  ASSERT_GE(laws.size(), 4u);
  std::set<std::string> names, models;
  for (const nlohmann::json& law : laws) {
    const std::string name = law.at("name");
    EXPECT_TRUE(names.insert(name).second) << name << " twice";
    EXPECT_TRUE(models.insert(law.at("models")).second) << law.at("models");
    for (const char* key : {"summary", "source", "header", "yade", "time_scale"})
      EXPECT_FALSE(law.at(key).get<std::string>().empty()) << name << " " << key;
    EXPECT_FALSE(law.at("properties").empty()) << name;
    EXPECT_NE(page.text.find("\n## " + name + "\n"), std::string::npos) << name;
    for (const nlohmann::json& property : law.at("properties")) {
      EXPECT_FALSE(property.at("grain").get<std::string>().empty()) << name << " " << property.at("name");
      EXPECT_EQ(property.at("wall").get<std::string>().empty(), property.at("of") == "all")
          << name << " " << property.at("name");
      EXPECT_NE(page.text.find("| `" + property.at("name").get<std::string>() + "`"), std::string::npos);
    }
  }
}

// Worked by hand: the elastic stiffness of equal spheres is E R in CohFrictPhys and c_n 2 E R in ViElTo.
TEST(LawPage, ShowsTheMappingAsAFormula) {
  const nlohmann::json laws = nlohmann::json::parse(run("--json").text).at("laws");
  std::map<std::string, std::string> young;
  for (const nlohmann::json& law : laws)
    for (const nlohmann::json& property : law.at("properties"))
      if (property.at("name") == "youngsModulus") young[law.at("name")] = property.at("wall");
  EXPECT_EQ(young.at("vielto"), "wall_youngsModulus");
  EXPECT_EQ(young.at("cohfrict"), "2*springFactor*wall_youngsModulus");
}

TEST(LawPage, RefusesAnotherOption) {
  const Outcome refused = run("--toml");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.text.find("vielto_laws --json"), std::string::npos);
}

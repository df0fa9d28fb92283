// SPDX-License-Identifier: GPL-2.0-or-later
// The table of rigs through the real command line: `vielto rigs`, and a rig of a user's own, which no program knows
// when it is compiled, in an observation table, an effect and the plan of a response library.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/command_test.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vielto_test::content;

const char* const kHopper = R"([hopper]
title = "steep hopper"
script = "in.hopper"
parameters = ["hopper.par"]
record = "hopper.csv"
result = "hopper.json"
conditions = {moisture = "wetness"}
work = "volume * seconds"
[hopper.observables]
outflow = ["kg/s", "mass flow"]
)";

class Rigs : public vielto_test::CommandTest {
 protected:
  void SetUp() override {
    write("own.toml", kHopper);
    write("in.hopper", "print hopper\n");
    write("hopper.par", "variable volume index 0.01 # m3 | - | a test\nvariable wetness index 0 # 1 | - | a test\n");
  }
  void expect_refused(const std::string& arguments, const std::string& why) {
    EXPECT_EQ(vielto(arguments), 2) << arguments;
    EXPECT_NE(err_.find(why), std::string::npos) << "expected: " << why << "\ngot: " << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  }
};

// Scripts, pages and programs rest on what this prints.
TEST_F(Rigs, TheTableIsPrintedAsJson) {
  ASSERT_EQ(vielto("rigs --json"), 0) << err_;
  const json table = json::parse(out_);
  EXPECT_EQ(table["schema"], 1);
  std::vector<std::string> rigs;
  for (const json& rig : table["apparatuses"])
    if (rig.contains("script")) {
      rigs.push_back(rig["name"]);
      const fs::path root = VIELTO_SOURCE_DIR;
      EXPECT_TRUE(fs::exists(root / rig["script"].get<std::string>())) << rig["script"];
      for (const json& file : rig["files"]) EXPECT_TRUE(fs::exists(root / file.get<std::string>())) << file;
      std::ifstream script(root / rig["script"].get<std::string>());
      std::ostringstream text;
      text << script.rdbuf();
      // what the table says of a script is in the script
      for (const auto& [condition, var] : rig["conditions"].items())
        EXPECT_NE(text.str().find(var.get<std::string>()), std::string::npos) << rig["name"] << " " << var;
    }
  for (const char* name : {"mixer", "shearbox", "repose", "drum"})
    EXPECT_EQ(std::count(rigs.begin(), rigs.end(), name), 1) << name;
  EXPECT_EQ(table["conditions"][0]["name"], "speed");
  EXPECT_EQ(table["observables"][0]["name"], "bulk_density");
}

TEST_F(Rigs, PeopleReadTheSameTable) {
  ASSERT_EQ(vielto("rigs"), 0);
  for (const char* text : {"mixer: ", "cases/mixer/in.mixer", "torque_ripple", "(-var normalStress)", "kg/m3"})
    EXPECT_NE(out_.find(text), std::string::npos) << text;
}

TEST_F(Rigs, AnOwnRigIsOneMore) {
  ASSERT_EQ(vielto("rigs --json --rigs own.toml"), 0) << err_;
  const json table = json::parse(out_);
  const json& own = table["apparatuses"].back();
  EXPECT_EQ(own["name"], "hopper");
  EXPECT_EQ(own["script"], "in.hopper");
  EXPECT_EQ(own["conditions"]["moisture"], "wetness");
  EXPECT_EQ(own["observables"][0]["unit"], "kg/s");
}

TEST_F(Rigs, AnOwnRigsTestsAreAnObservationTable) {
  const std::string rows =
      "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
      "material\n"
      "a,fit,hopper,outflow,{},0.1,kg/s,,,0.1,,,,,millet\n";
  write("a.csv", fmt::format(fmt::runtime(rows), 2));
  write("b.csv", fmt::format(fmt::runtime(rows), 3));
  ASSERT_EQ(vielto("compare a.csv b.csv --rigs own.toml"), 0) << err_;
  EXPECT_NE(out_.find("outflow"), std::string::npos);
  expect_refused("compare a.csv b.csv",
                 "a.csv, line 2, column apparatus: 'hopper' is no apparatus; write one of mixer");
}

TEST_F(Rigs, AnOwnRigIsPlannedWithAnEffectOfItsOwn) {
  write(
      "lib/effects/wet.toml",
      "name = \"wet\"\nkind = \"dem\"\nunit = \"1\"\nprior_low = 0\nprior_high = 0.2\nsource = \"a test of the rigs\"\n"
      "[[apply.var]]\nrigs = [\"hopper\"]\nname = \"volume\"\nrule = \"scale\"\nfactor = 1\n");
  fs::copy(fs::path(VIELTO_SOURCE_DIR) / "libraries/diagnosis.toml", folder_ / "lib/diagnosis.toml");
  write("lib/own/plan.toml",
        "seeds = 6\n[[rig]]\nname = \"hopper\"\nconditions = [{moisture = 0.1}]\n[[rig.effect]]\nname = \"wet\"\n"
        "strengths = [0.1]\nat = [1]\n");
  ASSERT_EQ(vielto("gap plan lib/own/plan.toml --rigs own.toml --out study.csv"), 0) << err_;
  const std::string study = content(folder_ / "study.csv");
  EXPECT_EQ(study.substr(0, study.find('\n')), "run,rig,seed,volume,wetness");
  EXPECT_NE(study.find("hopper1_wet0.1_s301,hopper,301,0.011,0.1"), std::string::npos) << study;
  expect_refused("gap plan lib/own/plan.toml --out study2.csv", "rigs: 'hopper' is no rig; write one of mixer");
}

// An effect whose file names the heap only; a hopper that takes the heap's effects has the wall's angle changed by it.
TEST_F(Rigs, AnOwnRigTakesTheEffectsOfAnother) {
  std::string text = kHopper;
  text.replace(text.find("title"), 0, "effects_of = \"repose\"\n");
  write("like.toml", text);
  write("hopper.par", "variable volume index 0.01 # m3\nvariable wall_frictionAngle index 20 # deg\n");
  write("lib/own/plan.toml",
        "seeds = 6\n[[rig]]\nname = \"hopper\"\nconditions = [{moisture = 0.1}]\n[[rig.effect]]\n"
        "name = \"wall_friction\"\nstrengths = [4]\nat = [1]\n");
  fs::create_directories(folder_ / "lib/effects");
  const fs::path libraries = fs::path(VIELTO_SOURCE_DIR) / "libraries";
  std::string effect = content(libraries / "effects/wall_friction.toml");
  effect.replace(effect.find("name = \"wall_frictionAngle\""), 0, "rigs = [\"repose\"]\n");
  write("lib/effects/wall_friction.toml", effect);
  fs::copy(libraries / "diagnosis.toml", folder_ / "lib/diagnosis.toml");
  ASSERT_EQ(vielto("gap plan lib/own/plan.toml --rigs like.toml --out study.csv"), 0) << err_;
  EXPECT_NE(content(folder_ / "study.csv").find("hopper1_wall_friction4_s301,hopper,301,28,0.1"), std::string::npos)
      << content(folder_ / "study.csv");
  expect_refused("gap plan lib/own/plan.toml --rigs own.toml --out study2.csv",
                 "name: does nothing in hopper; leave it out");
  text.replace(text.find("repose"), 6, "sieve");
  write("like.toml", text);
  expect_refused("rigs --rigs like.toml", "column effects_of: 'sieve' is no rig above this one");
}

TEST_F(Rigs, AFaultyTableIsRefusedWithFileLineAndMend) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kHopper;
    text.replace(text.find(from), from.size(), to);
    write("bad.toml", text);
  };
  with("[hopper]\n", "[drum]\n[hopper]\n");
  expect_refused("rigs --rigs bad.toml", "bad.toml, line 1, column drum: is the name of a rig that there is; name it");
  with("moisture = ", "colour = ");
  expect_refused("rigs --rigs bad.toml", "bad.toml, line 7, column colour: is no condition; use speed, fill, moisture");
  with("[\"kg/s\", \"mass flow\"]", "[\"kg/s\"]");
  expect_refused("rigs --rigs bad.toml", "column outflow: states no unit and meaning; write outflow = [");
  with("conditions = ", "picture = {from = \"above\"}\nconditions = ");
  expect_refused("rigs --rigs bad.toml", "column from: 'above' is no place; write end or side");
  with("conditions = ", "picture = {close_up = 1}\nconditions = ");
  expect_refused("rigs --rigs bad.toml", "column close_up: is neither true nor false");
  with("title", "heading");
  expect_refused("rigs --rigs bad.toml", "column heading: is no key here; use title");
  expect_refused("rigs --rigs none.toml", "none.toml: cannot be read; name an existing TOML file");
}

}  // namespace

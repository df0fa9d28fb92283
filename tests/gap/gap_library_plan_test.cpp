// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto gap plan` and `vielto gap collect` through the command line, on the repository's own rigs and effects; the
// runs themselves are stood in for by small files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "core/par_file.h"
#include "gap_folder.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vielto_test::content;
using vielto_test::GapFolder;

const char* const kPlan = R"(seeds = 6
[family]
file = "../family.csv"
members = [2, 4]
[[rig]]
name = "mixer"
settings = {grainDiameter = "0.012"}
conditions = [{speed = 0.5, fill = 0.1}, {speed = 1.5, fill = 0.2}]
members_at = [2]
[[rig.effect]]
name = "cohesion"
strengths = [150]
at = [1, 2]
[[rig.effect]]
name = "wall_friction"
strengths = [12, -8]
at = [1]
[[bench]]
observable = "wall_angle"
rows = [{value = 25}]
)";

std::vector<std::map<std::string, std::string>> table(const fs::path& path) {
  std::ifstream in(path);
  std::string line, cell;
  std::vector<std::string> header;
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream fields(line + ",");
    while (std::getline(fields, cell, ',')) cells.push_back(cell);
    if (header.empty()) {
      header = cells;
      continue;
    }
    rows.emplace_back();
    for (std::size_t k = 0; k < header.size(); ++k) rows.back()[header[k]] = k < cells.size() ? cells[k] : "";
  }
  return rows;
}

class GapLibraryPlan : public GapFolder {
 protected:
  void SetUp() override {
    GapFolder::SetUp();
    write("library/plan.toml", kPlan);
    write("family.csv", "weight,frictionAngle,rollingResistance\n1,20,0.1\n1,22,0.2\n1,24,0.3\n1,26,0.4\n");
  }

  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  const std::string root_ = "--root '" VIELTO_SOURCE_DIR "' ";
  int plan() { return gap("plan library/plan.toml --out study.csv " + root_); }
  int collect() { return gap("collect library/plan.toml results --out library " + root_); }

  // What a campaign leaves of a run.
  void finish(const std::map<std::string, std::string>& run, const std::string& script_hash) {
    const json made = {{"hashes", {{"in.mixer", script_hash}}}, {"parameters", run}};
    write("results/runs/" + run.at("run") + "/run.json", made.dump());
    const bool cohesive = !run.at("cohesion").empty();
    const json parts = {{"paddles", {{"torque_Nm", cohesive ? 6.0 : 3.0}}},
                        {"stems", {{"torque_Nm", 1.0}}},
                        {"drum", {{"torque_Nm", -2.0}}}};
    // the whole loss is the rotor's work, 2 pi n times its torque, and sliding has all that cohesion adds
    const double watt = 2 * std::acos(-1) * std::stod(run.at("speed"));
    const json losses = {{"normal", {{"power_W", 1.0 * watt}}},
                         {"sliding", {{"power_W", (cohesive ? 6.0 : 3.0) * watt}}}};
    write("results/runs/" + run.at("run") + "/post/power.json",
          json{{"speed", std::stod(run.at("speed"))}, {"parts", parts}, {"losses", losses}}.dump());
    // a paddle meets grain from 30 deg before to 60 deg after the lowest point, which is at 270 deg
    std::string phases = "phase_deg,paddle_Nm,paddles_Nm\n";
    for (double angle = 2.5; angle < 360; angle += 5)
      phases += fmt::format("{},{},1\n", angle, angle > 240 && angle < 330 ? 1 : 0);
    write("results/runs/" + run.at("run") + "/post/phase.csv", phases);
    write(
        "results/post/" + run.at("run") + ".csv",
        fmt::format("test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,"
                    "wall,material\nany,fit,mixer,power,{},0.1,W,{},{},,,,,,millet\n",
                    20 + 0.1 * std::stod(run.at("seed")), run.at("speed"), run.at("fill")));
  }
  std::string script_hash() {
    const std::string file = (folder_ / "hash.txt").string();
    EXPECT_EQ(std::system(("sha256sum '" VIELTO_SOURCE_DIR "/cases/mixer/in.mixer' > '" + file + "'").c_str()), 0);
    return content(file).substr(0, 64);
  }
};

TEST_F(GapLibraryPlan, TheStudyHoldsBaselineMembersAndEffects) {
  ASSERT_EQ(plan(), 0) << err_;
  const auto rows = table(folder_ / "study.csv");
  ASSERT_EQ(rows.size(), 6u * 2 + 2 + 2 + 2);
  const auto wall = vielto::ParFile::read(VIELTO_SOURCE_DIR "/materials/steel.par").number("frictionAngle");
  int baseline = 0, members = 0;
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("rig"), "mixer");
    EXPECT_EQ(row.at("grainDiameter"), "0.012");
    const std::string& name = row.at("run");
    if (name.find("_none_") != std::string::npos) {
      ++baseline;
      for (const char* var : {"cohesion", "adhesionStrength", "wall_frictionAngle", "frictionAngle"})
        EXPECT_EQ(row.at(var), "") << name << " " << var;
    } else if (name.find("_member") != std::string::npos) {
      ++members;
      EXPECT_EQ(row.at("speed"), "1.5");
      EXPECT_EQ(row.at("rollingResistance"), row.at("frictionAngle") == "22" ? "0.2" : "0.4");
    } else if (name.find("cohesion") != std::string::npos) {
      EXPECT_EQ(row.at("cohesion"), "adhesion");
      EXPECT_EQ(row.at("adhesionStrength"), "150");
    } else {
      // a contact takes the mean of both bodies: 2 deg of the wall are 1 deg of the contact
      const double change = std::stod(row.at("wall_frictionAngle")) - wall;
      EXPECT_NEAR(change, name.find("-8") == std::string::npos ? 24 : -16, 1e-9);
    }
  }
  EXPECT_EQ(baseline, 12);
  EXPECT_EQ(members, 2);
}

TEST_F(GapLibraryPlan, AConditionMayHaveSeedsOfItsOwn) {
  std::string text = kPlan;
  const std::string one = "{speed = 1.5, fill = 0.2}";
  write("library/plan.toml", text.replace(text.find(one), one.size(), "{speed = 1.5, fill = 0.2, seeds = 8}"));
  ASSERT_EQ(plan(), 0) << err_;
  std::map<std::string, int> seeds;
  for (const auto& row : table(folder_ / "study.csv"))
    if (row.at("run").find("_none_") != std::string::npos) ++seeds[row.at("speed")];
  EXPECT_EQ(seeds["0.5"], 6);
  EXPECT_EQ(seeds["1.5"], 8);
}

// A new posterior within the range of the members that were run needs no new runs: these stand in a file of their own.
TEST_F(GapLibraryPlan, MembersOfAnEarlierPosteriorStayWhenItIsReplaced) {
  write("library/members.csv", "weight,frictionAngle,rollingResistance\n1,18,0.05\n1,30,0.5\n");
  std::string text = kPlan;
  const std::string old = "members = [2, 4]";
  write("library/plan.toml",
        text.replace(text.find(old), old.size(), "members = [1, 2]\nmembers_from = \"members.csv\""));
  ASSERT_EQ(plan(), 0) << err_;
  const std::string study = content(folder_ / "study.csv");
  std::map<std::string, std::string> friction;
  for (const auto& row : table(folder_ / "study.csv")) friction[row.at("run")] = row.at("frictionAngle");
  EXPECT_EQ(friction.at("mixer2_member1_s101"), "18");
  EXPECT_EQ(friction.at("mixer2_member2_s102"), "30");

  write("family.csv", "weight,frictionAngle,rollingResistance\n1,21,0.15\n3,23,0.25\n");
  ASSERT_EQ(plan(), 0) << err_;
  EXPECT_EQ(content(folder_ / "study.csv"), study);
  const std::string hash = script_hash();
  for (const auto& run : table(folder_ / "study.csv")) finish(run, hash);
  ASSERT_EQ(collect(), 0) << err_;
  EXPECT_EQ(content(folder_ / "library/posterior.csv"), content(folder_ / "family.csv"));
  EXPECT_NE(content(folder_ / "library/inputs.csv").find("\nmembers.csv,"), std::string::npos);
  write("t.csv",
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\n"
        "a,fit,mixer,power,21,0.5,W,0.5,0.1,,,,,,millet\nb,fit,mixer,power,21,0.5,W,1.5,0.2,,,,,,millet\n");
  EXPECT_EQ(gap("diagnose t.csv --library library --draws 20 --out answer"), 0) << err_;
}

// The drum has a stiffness of its own, which holds over the card's: half a decade more is half a decade of the drum's.
TEST_F(GapLibraryPlan, AnEffectStartsFromWhatTheRigItselfStates) {
  write("library/plan.toml",
        "seeds = 6\n[[rig]]\nname = \"drum\"\nconditions = [{tilt = 45}]\n[[rig.effect]]\n"
        "name = \"soft_grain\"\nstrengths = [0.5]\nat = [1]\n");
  ASSERT_EQ(plan(), 0) << err_;
  const double own = vielto::ParFile::read(VIELTO_SOURCE_DIR "/cases/drum/drum.par").number("youngsModulus");
  const auto row = table(folder_ / "study.csv").back();
  for (const char* name : {"youngsModulus", "wall_youngsModulus"})
    EXPECT_NEAR(std::stod(row.at(name)), own * std::sqrt(10), 1e-4 * own) << name;
}

TEST_F(GapLibraryPlan, CollectsWhatIsDoneAndNamesTheRest) {
  ASSERT_EQ(plan(), 0) << err_;
  const auto runs = table(folder_ / "study.csv");
  const std::string hash = script_hash();
  for (const auto& run : runs)
    if (run.at("run").find("wall_friction-8") == std::string::npos) finish(run, hash);
  ASSERT_EQ(collect(), 0) << err_;
  EXPECT_NE(out_.find("not there yet: mixer1_wall_friction-8_s301"), std::string::npos) << out_;
  const auto design = table(folder_ / "library/design.csv");
  ASSERT_EQ(design.size(), runs.size() - 1 + 1);  // one is missing, one is of the bench
  const auto card = vielto::ParFile::read(VIELTO_SOURCE_DIR "/materials/hulled_millet.par");
  for (const auto& row : design) {
    if (row.at("test").find("member") != std::string::npos) continue;
    EXPECT_DOUBLE_EQ(std::stod(row.at("frictionAngle")), card.number("frictionAngle")) << row.at("test");
  }
  EXPECT_EQ(content(folder_ / "library/posterior.csv"), content(folder_ / "family.csv"));

  // The library is one that the diagnosis reads.
  write("t.csv",
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\n"
        "a,fit,mixer,power,21,0.5,W,0.5,0.1,,,,,,millet\nb,fit,mixer,power,21,0.5,W,1.5,0.2,,,,,,millet\n");
  EXPECT_EQ(gap("diagnose t.csv --library library --draws 20 --out answer"), 0) << err_;
  // Three of four parts of the baseline's torque are the paddles'.
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  const std::map<std::string, double> shares = {{"paddles", 0.75},   {"stems", 0.25},   {"drum", -0.5},
                                                {"normal", 0.25},    {"sliding", 0.75}, {"-60 to 0 deg", 0.25},
                                                {"0 to 60 deg", 0.5}};
  ASSERT_EQ(d["sources"].size(), 2u * (3 + 2 + 6));
  for (const json& s : d["sources"]) {
    const auto share = shares.find(s["source"]);
    EXPECT_NEAR(s["share"], share == shares.end() ? 0 : share->second, 1e-5) << s;  // six digits in the table
  }
  // What enters the bed is a third of a paddle's torque; the runs' tables say nothing of it, their sources do.
  ASSERT_EQ(gap("predict --library library --observable paddle_share_entering --speed 0.5 --fill 0.1 --out share.csv"),
            0)
      << err_;
  EXPECT_NEAR(std::stod(table(folder_ / "share.csv")[0].at("value")), 1.0 / 3, 1e-5);
  // What a paddle carries past the top is a grain wedged under it: no evidence.
  write("carried.csv",
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\na,fit,mixer,paddle_share_carried,0.05,0.01,1,0.5,0.1,,,,,,millet\n");
  EXPECT_EQ(gap("diagnose carried.csv --library library --draws 20 --out carried"), 2) << out_;
  expect_one_line("carried.csv, line 2, column observable: paddle_share_carried comes and goes with single grains");
  const std::string page = content(folder_ / "answer/diagnosis.html");
  for (const char* words : {"Where in the machine", "0 to 60 deg", "<td>sliding</td>"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

// A bench row that goes with calibrated parameters is stated for each member too: half a degree of the wall for one of
// the grain.
// A machine of one's own: its parts have any names, one that turns may be called drum, and no paddle's torque is kept
// by its place. Found on a real library of a stranger's mixer, which could not be collected.
TEST_F(GapLibraryPlan, CollectsAMachinesRunsWithItsOwnParts) {
  write("library/plan.toml",
        "seeds = 6\n[[rig]]\nname = \"machine\"\nsettings = {parts = \"/home/me/my mixer/machine.toml\"}\n"
        "conditions = [{speed = 0.8, fill = 0.3}]\n[[rig.effect]]\nname = \"wall_friction\"\nstrengths = [4]\nat = "
        "[1]\n");
  ASSERT_EQ(plan(), 0) << err_;
  for (const auto& run : table(folder_ / "study.csv")) {
    const std::string folder = "results/runs/" + run.at("run");
    const bool smooth = run.at("wall_frictionAngle").empty();
    write(folder + "/run.json", json{{"hashes", json::object()}, {"parameters", run}}.dump());
    const json parts = {{"blades", {{"torque_Nm", smooth ? 3.0 : 4.0}, {"turns", true}}},
                        {"drum", {{"torque_Nm", 1.0}, {"turns", true}}},
                        {"shell", {{"torque_Nm", -2.5}, {"turns", false}}}};
    write(folder + "/post/power.json", json{{"speed", 0.8}, {"parts", parts}, {"losses", nullptr}}.dump());
    write(folder + "/post/phase.csv", "phase_deg,blades_Nm,drum_Nm,shell_Nm\n2.5,3,1,-2.5\n7.5,3,1,-2.5\n");
    write(
        "results/post/" + run.at("run") + ".csv",
        fmt::format("test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,"
                    "wall,material\nany,fit,machine,power,{},0.1,W,0.8,0.3,,,,,,millet\n",
                    20 + 0.1 * std::stod(run.at("seed"))));
  }
  ASSERT_EQ(collect(), 0) << err_;
  write("t.csv",
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\na,fit,machine,power,21,0.5,W,0.8,0.3,,,,,,millet\n");
  ASSERT_EQ(gap("diagnose t.csv --library library --draws 20 --out answer"), 0) << err_;
  const json d = json::parse(content(folder_ / "answer/diagnosis.json"));
  const std::map<std::string, std::pair<std::string, double>> expected = {
      {"blades", {"part", 0.75}}, {"turning drum", {"part", 0.25}}, {"shell", {"standing", -0.625}}};
  ASSERT_EQ(d["sources"].size(), expected.size()) << d["sources"];
  for (const json& s : d["sources"]) {
    const auto& [kind, share] = expected.at(s["source"]);
    EXPECT_EQ(s["kind"], kind);
    EXPECT_NEAR(s["share"], share, 1e-5) << s;
  }
}

TEST_F(GapLibraryPlan, BenchRowsGoWithTheFamily) {
  std::string text = kPlan;
  const std::string row = "{value = 25}";
  text.replace(text.find(row), row.size(), "{value = 25, slopes = {frictionAngle = 0.5}}");
  write("library/plan.toml", text);
  ASSERT_EQ(plan(), 0) << err_;
  for (const auto& run : table(folder_ / "study.csv")) finish(run, script_hash());
  ASSERT_EQ(collect(), 0) << err_;
  const double own = vielto::ParFile::read(VIELTO_SOURCE_DIR "/materials/hulled_millet.par").number("frictionAngle");
  std::map<std::string, double> friction;
  for (const auto& run : table(folder_ / "library/design.csv"))
    friction[run.at("test")] = std::stod(run.at("frictionAngle"));
  const auto bench = table(folder_ / "library/bench.csv");
  ASSERT_EQ(bench.size(), 3u);
  EXPECT_EQ(bench[0].at("test"), "bench_wall_angle1");
  EXPECT_EQ(bench[1].at("test"), "bench_wall_angle1_member2");
  EXPECT_NE(friction.at(bench[1].at("test")), friction.at(bench[2].at("test")));
  for (const auto& b : bench)
    EXPECT_NEAR(std::stod(b.at("value")), 25 + 0.5 * (friction.at(b.at("test")) - own), 1e-4) << b.at("test");
  write("t.csv",
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\n"
        "a,fit,mixer,power,21,0.5,W,0.5,0.1,,,,,,millet\nb,fit,bench,wall_angle,25,0.5,deg,,,,,,,,\n");
  EXPECT_EQ(gap("diagnose t.csv --library library --draws 20 --out answer"), 0) << err_;

  write("library/plan.toml", text.replace(text.find("{frictionAngle"), 14, "{frictionAngel"));
  EXPECT_EQ(plan(), 2);
  expect_one_line("is no calibrated parameter");
}

// Effects and calibrated parameters together: each effect acts on top of what its row states, and the library says what
// was varied.
TEST_F(GapLibraryPlan, EffectsAndParametersTogether) {
  write("library/together.csv",
        "wall_friction,cohesion,shape,frictionAngle,rollingResistance\n6,150,0.1,22,0.2\n-4,,,,\n0,,,24,0.3\n");
  const std::string plain = kPlan, design = "members_at = [2]\n[[rig.design]]\nfile = \"together.csv\"\nat = [1, 2]";
  std::string text = plain;
  write("library/plan.toml", text.replace(text.find("members_at = [2]"), 16, design));
  ASSERT_EQ(plan(), 0) << err_;
  std::map<std::string, std::map<std::string, std::string>> runs;
  for (const auto& row : table(folder_ / "study.csv")) runs[row.at("run")] = row;
  ASSERT_EQ(runs.size(), 18u + 6);
  const double wall = vielto::ParFile::read(VIELTO_SOURCE_DIR "/materials/steel.par").number("frictionAngle");
  const auto& all = runs.at("mixer2_together1_s1001");
  EXPECT_EQ(all.at("speed"), "1.5");
  EXPECT_EQ(all.at("adhesionStrength"), "150");
  EXPECT_EQ(all.at("frictionAngle"), "22");
  EXPECT_DOUBLE_EQ(std::stod(all.at("rollingResistance")), 0.2 + 0.1);  // of the row, not of the card
  EXPECT_DOUBLE_EQ(std::stod(all.at("wall_frictionAngle")), wall + 12);
  EXPECT_EQ(runs.at("mixer1_together2_s1002").at("frictionAngle"), "");

  for (const auto& [name, run] : runs) finish(run, script_hash());
  ASSERT_EQ(collect(), 0) << err_;
  std::map<std::string, std::map<std::string, std::string>> kept;
  for (const auto& row : table(folder_ / "library/design.csv")) kept[row.at("test")] = row;
  const auto& own = kept.at("mixer2_together1_s1001");
  EXPECT_EQ(own.at("effect"), "cohesion+shape+wall_friction");
  EXPECT_EQ(own.at("strength"), "150+0.1+6");
  EXPECT_EQ(own.at("rollingResistance"), "0.2");
  EXPECT_EQ(kept.at("mixer1_together2_s1002").at("effect"), "wall_friction");
  EXPECT_EQ(kept.at("mixer1_together3_s1003").at("effect"), "none");
  EXPECT_NE(content(folder_ / "library/effects.csv").find("shape,mixer,"), std::string::npos);
  write("t.csv",
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,"
        "material\n"
        "a,fit,mixer,power,21,0.5,W,0.5,0.1,,,,,,millet\nb,fit,mixer,power,21,0.5,W,1.5,0.2,,,,,,millet\n");
  EXPECT_EQ(gap("diagnose t.csv --library library --draws 20 --out answer"), 0) << err_;

  const std::string old = content(folder_ / "library/design.csv");
  const auto refused_library = [&](const std::string& from, const std::string& to, const std::string& part) {
    std::string other = old;
    write("library/design.csv", other.replace(other.find(from), from.size(), to));
    EXPECT_EQ(gap("diagnose t.csv --library library --draws 20 --out other"), 2) << out_;
    expect_one_line(part);
  };
  refused_library("150+0.1+6", "150+0.1", "states 2 for 3 effects");
  refused_library("cohesion+shape+", "cohesion+cohesion+", "names cohesion twice");
  refused_library("150+0.1+6", "150+0.1+60", "60 is outside the prior range of wall_friction");
  const auto refused = [&](const std::string& design_text, const std::string& part) {
    write("library/together.csv", design_text);
    EXPECT_EQ(plan(), 2);
    expect_one_line(part);
  };
  refused("wall_friction,magic\n1,2\n", "together.csv, line 1, column magic: is neither an effect nor a parameter");
  refused("wall_friction,size\n", "together.csv");
  refused("wall_friction,frictionAngle,rollingResistance\n1,22,\n",
          "together.csv, line 2, column rollingResistance: is empty");
  refused("wall_friction,cohesion\n1,1e9\n", "together.csv, line 2, column cohesion: 1000000000 is outside the prior");
  refused("wall_friction,cohesion\n0,\n", "together.csv, line 2: states neither an effect nor parameters");
}

TEST_F(GapLibraryPlan, RefusesRunsOfAnotherScript) {
  ASSERT_EQ(plan(), 0) << err_;
  for (const auto& run : table(folder_ / "study.csv")) finish(run, std::string(64, '0'));
  EXPECT_EQ(collect(), 2) << out_;
  expect_one_line("the run was made from another in.mixer");
  EXPECT_FALSE(fs::exists(folder_ / "library/design.csv"));
}

// A run that a tight limit on overlaps did not end is the same with a wide one; not the other way round.
TEST_F(GapLibraryPlan, ATighterLimitThatDidNotEndARunChangesNothing) {
  const std::string hash = script_hash();
  const auto collect_with = [&](const std::string& made, const std::string& planned) {
    std::string text = kPlan;
    const std::string settings = "{grainDiameter = \"0.012\"";
    text.replace(text.find(settings), settings.size(), settings + ", maxOverlap = \"" + planned + "\"");
    write("library/plan.toml", text);
    EXPECT_EQ(plan(), 0) << err_;
    for (auto run : table(folder_ / "study.csv")) {
      if (run.count("maxOverlap") > 0) run["maxOverlap"] = made;
      finish(run, hash);
    }
    return collect();
  };
  EXPECT_EQ(collect_with("0.3", "0.4"), 0) << err_;
  EXPECT_EQ(collect_with("0.4", "0.3"), 2) << out_;
  expect_one_line("was made with maxOverlap 0.4, the plan now has 0.3");
}

TEST_F(GapLibraryPlan, RefusesAPlanThatCannotBeRun) {
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& part) {
    std::string text = kPlan;
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    write("library/plan.toml", text.replace(at, from.size(), to));
    EXPECT_EQ(plan(), 2) << to;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "study.csv"));
  };
  refused("name = \"cohesion\"", "name = \"magic\"", "'magic' has no effect file");
  refused("strengths = [150]", "strengths = [900000]", "outside the prior range");
  refused("strengths = [150]", "strengths = [0]", "outside the prior range");
  refused("at = [1, 2]", "at = [3]", "3 is no condition");
  refused("grainDiameter = ", "grainDiametre = ", "is no parameter of in.mixer");
  refused("speed = 0.5", "tilt = 0.5", "is no condition of this rig");
  refused("members = [2, 4]", "members = [5]", "5 is no member of the family");
  refused("wall_angle", "wall_angel", "is no bench observable");
  refused("../family.csv", "nothing.csv", "cannot be read");
  write("other.csv", "weight,frictionAngle\n1,20\n1,22\n1,24\n1,26\n");
  refused("members = [2, 4]", "members = [2, 4]\nmembers_from = \"../other.csv\"", "has other parameters than");
}

// A library whose inputs.csv names a file that has moved is refused whole, before its numbers are looked at.
// The law discrepancy of the library in use is what the command of its plan makes of the laws' runs; rows that no
// diagnosis takes (fitful) are passed over.
TEST_F(GapLibraryPlan, TheCommittedDiscrepancyIsThatOfItsCommand) {
  const fs::path libraries = VIELTO_SOURCE_DIR "/libraries";
  std::string laws;
  for (const char* name : {"mixer_hooke", "mixer_hooke_paddle", "mixer_hertz", "rigs_hooke", "rigs_hertz"})
    laws += fmt::format(" '{}'", (libraries / "laws" / (std::string(name) + ".csv")).string());
  ASSERT_EQ(gap("discrepancy" + laws + " --library '" + (libraries / "millet").string() + "' --out made.csv"), 0)
      << err_;
  EXPECT_EQ(content(folder_ / "made.csv"), content(libraries / "millet/discrepancy.csv"));
  EXPECT_EQ(content(folder_ / "made.csv").find("paddle_share_carried"), std::string::npos);
}

TEST(CommittedLibraries, NameInputsThatAreThere) {
  int files = 0;
  for (const auto& library : fs::directory_iterator(VIELTO_SOURCE_DIR "/libraries")) {
    std::ifstream inputs(library.path() / "inputs.csv");
    std::string line;
    std::getline(inputs, line);  // file,sha256
    for (; std::getline(inputs, line); ++files)
      EXPECT_TRUE(fs::exists(library.path() / line.substr(0, line.find(',')))) << library.path() << ": " << line;
  }
  EXPECT_GT(files, 20);
}

}  // namespace

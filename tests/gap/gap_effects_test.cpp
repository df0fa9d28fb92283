// SPDX-License-Identifier: GPL-2.0-or-later
// The effect files: all of the protocol's, what each changes, and that the rigs know the switches.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "core/bad_input.h"
#include "core/par_file.h"
#include "core/rig_table.h"
#include "gap/emulator/channel.h"
#include "gap/library/effect.h"
#include "gap/library/library.h"

namespace {

using namespace vielto;
using namespace vielto::gap;

const std::string kGap = VIELTO_SOURCE_DIR "/libraries/";

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<Effect> effects() { return read_effects(kGap + "effects", Settings::read(kGap + "diagnosis.toml")); }

// Rules that hold for every file of the folder, whichever they are.
TEST(GapEffects, EveryFileStatesASourceAndActsOnSomething) {
  std::set<EffectKind> kinds;
  for (const Effect& e : effects()) {
    kinds.insert(e.kind);
    EXPECT_GE(e.source.size(), 10u) << e.name;
    EXPECT_LE(e.prior_low, 0) << e.name;
    EXPECT_GE(e.prior_high, 0) << e.name;
    // a change of the rig has a simulation to be confirmed with, a measurement effect none
    EXPECT_EQ(e.kind == EffectKind::measurement, e.vars.empty()) << e.name;
    std::ifstream file(e.path);
    std::string first;
    std::getline(file, first);
    EXPECT_EQ(first.rfind("# ", 0), 0u) << e.name << " does not begin with what it is, for a reader";
  }
  // what the physics leaves out stands beside its rivals: geometry, measurement, numerics
  EXPECT_EQ(kinds, (std::set<EffectKind>{EffectKind::dem, EffectKind::geometry, EffectKind::measurement,
                                         EffectKind::numerical}));
}

// The numbers of a -var must be ones at both ends of the prior range, and no change at 0.
TEST(GapEffects, EveryChangeIsANumberOverThePriorRange) {
  for (const Effect& e : effects())
    for (const VarChange& v : e.vars) {
      if (v.rule == VarRule::word || v.rule == VarRule::switched) continue;
      constexpr double kBase = 7.5;
      if (v.rule != VarRule::value && !v.whole) {
        EXPECT_EQ(v.text(kBase, 0), "7.5") << e.name << ": " << v.name;
      }
      for (const double s : {e.prior_low, e.prior_high})
        EXPECT_TRUE(std::isfinite(std::stod(v.text(kBase, s)))) << e.name << ": " << v.name << " at " << s;
    }
}

// What is measured at a machine of a user's own goes through the same chain (cases/rigs.toml, effects_of).
TEST(GapEffects, AMachineTakesTheMixersEffectsOfMeasurement) {
  std::set<std::string> acting;
  for (const Effect& e : effects())
    for (const char* observable : {"power", "power_loaded", "power_idle", "torque_ripple"}) {
      EXPECT_EQ(e.transform_of("machine", observable), e.transform_of("mixer", observable)) << e.name;
      EXPECT_EQ(e.transform_of("silo", observable), nullptr) << e.name;
      if (e.transform_of("machine", observable)) acting.insert(e.name);
    }
  EXPECT_TRUE(acting.count("drive_loss") && acting.count("fill_error"));
}

// Every -var that an effect writes for the mixer stands in its parameters or a card.
TEST(GapEffects, TheMixerKnowsEverySwitch) {
  const std::string cases = VIELTO_SOURCE_DIR "/cases/", cards = VIELTO_SOURCE_DIR "/materials/";
  const ParFile mixer = ParFile::read(cases + "mixer/mixer.par"), law = ParFile::read(cases + "law.par"),
                grain = ParFile::read(cards + "hulled_millet.par"), wall = ParFile::read(cards + "steel.par");
  for (const Effect& e : effects())
    for (const VarChange& v : e.vars) {
      if (!v.acts_on("mixer")) continue;
      EXPECT_TRUE(mixer.has(v.name) || law.has(v.name) || grain.has(v.name) ||
                  (v.name.rfind("wall_", 0) == 0 && wall.has(v.name.substr(5))))
          << e.name << ": " << v.name;
    }
}

// What is the same in every rig names none, so that a new rig touches no effect's file.
TEST(GapEffects, AnEffectThatNamesNoRigActsOnEveryOne) {
  int files = 0;
  for (const Effect& e : effects()) {
    if (e.vars.empty() || text_of(e.path).find("rigs = ") != std::string::npos) continue;
    ++files;
    for (const RigDescription& rig : apparatuses()) {
      EXPECT_EQ(e.acts_on_rig(rig.name), rig.is_rig()) << e.name << ": " << rig.name;
      if (rig.is_rig()) {
        EXPECT_EQ(e.changes(rig.name), e.changes("mixer")) << e.name << ": " << rig.name;
      }
    }
  }
  EXPECT_EQ(files, 8);
}

TEST(GapEffects, AnEmptyListOfRigsIsRefused) {
  const auto path = std::filesystem::temp_directory_path() / "nothing.toml";
  std::string text = text_of(kGap + "effects/wall_rolling.toml");
  text.replace(text.find("wall_rolling"), 12, "nothing");
  text.insert(text.find("[[apply.var]]\n") + 14, "rigs = []\n");
  std::ofstream(path) << text;
  try {
    read_effect(path, Settings::read(kGap + "diagnosis.toml"));
    FAIL() << "an effect on no rig was read";
  } catch (const BadInput& e) {
    EXPECT_NE(std::string(e.what()).find("leave it out for every rig"), std::string::npos) << e.what();
  }
  std::filesystem::remove(path);
}

TEST(GapEffects, RulesByHand) {
  VarChange v;
  v.factor = 2;
  const std::pair<VarRule, const char*> rules[] = {{VarRule::value, "1"},
                                                   {VarRule::offset, "5"},
                                                   {VarRule::scale, "8"},
                                                   {VarRule::power10, "40"},
                                                   {VarRule::divide, "2"}};
  for (const auto& [rule, text] : rules) {
    v.rule = rule;
    EXPECT_EQ(v.text(4, 0.5), text);
  }
  v.rule = VarRule::divide;
  v.whole = true;
  EXPECT_EQ(v.text(48, 0.2), "34");  // 48/1.4 = 34.3
}

}  // namespace

// A feeler gauge is as sure in millimetres whatever it shows, a power transmitter in per cent: rows of the bench that
// an effect adds to do not go to logarithms, those that effects multiply do.
TEST(GapEffects, AddToTheBenchInItsUnits) {
  const std::string libraries = VIELTO_SOURCE_DIR "/libraries";
  const auto effects = read_effects(libraries + "/effects", Settings::read(libraries + "/diagnosis.toml"));
  const Library library = Library::read(libraries + "/millet", effects);
  const ParameterScale scale(library);
  for (const auto& [observable, relative] : std::map<std::string, bool>{{"paddle_gap", false},
                                                                        {"grain_spread", false},
                                                                        {"tensile_strength", false},
                                                                        {"wall_angle", false},
                                                                        {"dead_weight_gain", true},
                                                                        {"loaded_mass", true},
                                                                        {"restitution", true}}) {
    std::vector<const LibraryValue*> values;
    for (const LibraryValue& v : library.values)
      if (v.row.apparatus == "bench" && v.row.observable == observable) values.push_back(&v);
    ASSERT_FALSE(values.empty()) << observable;
    EXPECT_EQ(make_channel(library, values, effects, scale).relative, relative) << observable;
  }
}

// SPDX-License-Identifier: GPL-2.0-or-later
// What must not become a result: bad input and broken physics stop the mixer's run with one clear line, a status that
// is not 0, and no finished run folder.
#include "mixer_runner.h"

using namespace vielto_test;
namespace fs = std::filesystem;

namespace {

class MixerRefuses : public testing::TestWithParam<Refusal> {};

void copy_cards(const Mixer& mixer) { fs::copy(VIELTO_SOURCE_DIR "/materials", mixer.folder / "cards"); }

// Takes the line of a parameter out of a card.
void remove_parameter(const Mixer& mixer, const std::string& card, const std::string& name) {
  std::istringstream in(mixer.read(card));
  std::string text;
  for (std::string line; std::getline(in, line);)
    if (line.find("variable " + name + " ") != 0) text += line + "\n";
  mixer.write(card, text);
}

}  // namespace

TEST_P(MixerRefuses, WithOneLine) {
  Mixer mixer;
  expect_refusal(mixer.folder / "run", mixer.rig("run", two, GetParam().option), GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, MixerRefuses,
    testing::Values(
        Refusal{"FillBelowZero", "-var fill -0.1", {"fill is -0.1", "0 to 0.5"}},
        Refusal{"FillOverRange", "-var fill 0.51", {"fill is 0.51", "0 to 0.5"}},
        Refusal{"SpeedZero", "-var speed 0", {"speed is 0", "> 0"}}, Refusal{"NoTurns", "-var turns 0", {"turns is 0"}},
        Refusal{"TimeStepOverLimit", "-var dtFraction 0.051", {"dtFraction is 0.051", "at most dtLimit (0.05)"}},
        Refusal{"WordForNumber", "-var speed fast", {"speed is 'fast'", "number", "-var speed"}},
        Refusal{"WordForWallsNumber", "-var wall_frictionAngle steep", {"wall_frictionAngle is 'steep'", "number"}},
        Refusal{"UnknownWord", "-var energyBalance maybe", {"energyBalance is 'maybe'", "off or on"}},
        Refusal{"MisspelledParameter", "-var grainDiametre 0.01", {"-var grainDiametre", "no such parameter"}},
        Refusal{"UncertaintyInPercent", "-var powerUncertainty 2", {"powerUncertainty is 2", "0 to 0.2"}},
        Refusal{"UncertaintyBelowZero", "-var powerUncertainty -0.02", {"powerUncertainty is -0.02", "0 to 0.2"}},
        Refusal{"UncertaintyInTooFewTurns", "-var powerUncertainty 0.02", {"turns", "at least 5"}},
        Refusal{"UncertaintyOfNothing",
                "-var powerUncertainty 0.02 -var turns 9 -var fill 0",
                {"without grain", "powerUncertainty"}},
        Refusal{"TurnsWithoutEnd", "-var turns 1e14", {"more steps", "lower turns"}},
        Refusal{"TurnsBeyondNumbers", "-var turns 1e300", {"turns is 1e300", "from 1e-15 to 1e+15 in size"}},
        Refusal{"GrainOfNoSize", "-var grainDiameter 1e-300", {"grainDiameter is 1e-300", "in size (m)"}},
        Refusal{"StiffnessBeyondNumbers", "-var youngsModulus 1e308", {"youngsModulus is 1e308", "in size (Pa)"}},
        Refusal{"TwoValues", "-var fill 0.1 0.2", {"-var fill has several values"}},
        Refusal{"FolderOfTwoWords", "-var materials my cards -var speed 1", {"-var materials has several values"}},
        Refusal{"SeedOfHalves", "-var seed 1.5", {"seed is 1.5", "whole number"}},
        Refusal{"UnknownGrain", "-var grain moon_dust", {"materials/moon_dust.par", "cannot be read"}},
        Refusal{"UnknownWall", "-var wall moon_rock", {"materials/moon_rock.par", "cannot be read"}},
        Refusal{"NegativeFriction", "-var frictionAngle -5", {"frictionAngle of type 1 is -5", "range"}},
        Refusal{"NegativeStiffnessOfWall", "-var wall_stiffnessRatio -1", {"stiffnessRatio of type 2 is -1", "range"}},
        Refusal{"CommaInANumber", "-var wallRolling 0,27", {"wallRolling is '0,27'", "decimal point"}},
        Refusal{"PartInPercent", "-var maxOverlap 5%", {"maxOverlap is '5%'", "part of 1"}},
        Refusal{"ClearanceBelowZero", "-var clearance -0.001", {"clearance is -0.001 m", ">= 0", "mixer.par, line"}},
        Refusal{"ImpossibleGeometry", "-var drumSegments 8", {"vielto geometry", "failed"}},
        Refusal{"VolumeOfAnotherDrum", "-var drumLength 0.4", {"drumVolume is 0.0474 m3", "outlineVolume (0.024"}},
        Refusal{"CaseOfLetters", "-var graindiameter 0.01", {"no such parameter", "grainDiameter"}},
        Refusal{"OtherRig", "-var rig drum", {"rig is drum", "made with mixer", "mesh"}},
        Refusal{"NoGravity", "-var gravity 0", {"gravity is 0 m/s2", "> 0"}},
        Refusal{"GravityUpwards", "-var gravity -9.81", {"gravity is -9.81", "> 0"}},
        Refusal{"SettlesBackwards", "-var settleTime -1", {"settleTime is -1", ">= 0"}},
        Refusal{"NoLever", "-var powerLever 0", {"powerLever is 0 m", "> 0"}},
        Refusal{"NoCohesion", "-var bulkCohesion 0", {"bulkCohesion is 0 Pa", "> 0", "hulled_millet.par"}},
        Refusal{"NoBulkDensity", "-var bulkDensity 0", {"bulkDensity is 0", "> 0"}},
        Refusal{"DenserThanItsGrain", "-var bulkDensity 1400", {"bulkDensity is 1400", "1375 kg/m3"}},
        Refusal{"NoDensity", "-var density 0", {"density is 0 kg/m3", "hulled_millet.par"}},
        Refusal{"MassThatHasNoRoom", "-var fill 0.5 -var bulkDensity 1375", {"above the drum rim", "lower fill"}},
        Refusal{"MassBelowOneGrain", "-var fill 0.0001", {"mass that cannot be placed", "raise fill"}},
        Refusal{"OverlapOverLimit", "-var maxOverlap 0.002", {"step", "overlap of grain", "maxOverlap"}},
        Refusal{"TorqueOverLimit", "-var maxTorque 0.05", {"step", "torque of", "grain", "maxTorque"}}),
    name_of);

TEST(MixerRefusesCard, WithoutAPropertyOfGrainOrWall) {
  Mixer mixer;
  const std::string cards = fmt::format("-var materials '{}/cards'", mixer.folder.string());
  copy_cards(mixer);
  remove_parameter(mixer, "cards/steel.par", "rollingResistance");
  expect_refusal(mixer.folder / "run", mixer.rig("run", two, cards), {"steel.par", "rollingResistance", "missing"});
  remove_parameter(mixer, "cards/hulled_millet.par", "frictionAngle");
  expect_refusal(mixer.folder / "run", mixer.rig("run", two, cards), {"hulled_millet.par", "frictionAngle", "missing"});
}

TEST(MixerRefusesCard, OnTwoRanksWithOneLineToo) {
  Mixer mixer;
  expect_refusal(mixer.folder / "run", mixer.rig("run", two, "-var grain moon_dust", 2),
                 {"moon_dust.par", "cannot be read"});
}

TEST(MixerRefusesFolder, WithoutAName) {
  Mixer mixer;
  const Outcome run =
      mixer.shell(fmt::format("cd '{}/cases/mixer' && PATH='{}':$PATH {} -log none -in in.mixer -var run ''",
                              VIELTO_SOURCE_DIR, VIELTO_BIN_DIR, mixer.command(1, Program::ours)));
  expect_refusal(mixer.folder / "run", run, {"run has no name"});
}

// Called by its path, ours takes the vielto beside itself and gets as far as the grain's friction; the stock program
// has none.
TEST(MixerRefusesPath, WithoutOurProgram) {
  for (const Program program : {Program::ours, Program::stock}) {
    Mixer mixer;
    const Outcome run = mixer.shell(fmt::format(
        "cd '{}/cases/mixer' && PATH=/usr/bin:/bin {} -log none -in in.mixer -var frictionAngle -5 -var run '{}'",
        VIELTO_SOURCE_DIR, mixer.command(1, program), (mixer.folder / "run").string()));
    if (program == Program::ours)
      expect_refusal(mixer.folder / "run", run, {"frictionAngle of type 1 is -5"});
    else
      expect_refusal(mixer.folder / "run", run, {"no program 'vielto' is found", "PATH"});
  }
}

TEST(MixerRefusesFolder, ThatIsThereAlready) {
  Mixer mixer;
  fs::create_directory(mixer.folder / "run");
  mixer.write("run/torque.csv", "precious");
  const Outcome outcome = mixer.rig("run", two);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.text.find("is there already"), std::string::npos) << outcome.text;
  EXPECT_EQ(mixer.read("run/torque.csv"), "precious");
  EXPECT_FALSE(fs::exists(mixer.folder / "run.partial"));
}

// A run taken up again brings its mesh along; the parameters must be those of this mesh, and its files must be there.
TEST(MixerRefusesMesh, ThatIsNotTheRunsOwn) {
  Mixer mixer;
  const std::string options = two + "-var restartTurns 0.1 ";
  mixer.must_break_off("run", options);
  const std::string mesh = (mixer.folder / "run.partial/mesh").string();
  fs::rename(mesh + "/shaft.stl", mesh + "/shaft");
  expect_refusal(mixer.folder / "run", mixer.rig("run", options, "-var resume yes"), {"shaft.stl"});
  const Outcome made = mixer.shell(fmt::format(
      "'{}/vielto' geometry '{}/cases/mixer/mixer.par' --set slicePaddles=2 --set clearance=0.002 --out '{}'",
      VIELTO_BIN_DIR, VIELTO_SOURCE_DIR, mesh));
  ASSERT_EQ(made.status, 0) << made.text;
  expect_refusal(mixer.folder / "run", mixer.rig("run", options, "-var resume yes"),
                 {"clearance is 0.001", "made with 0.002", "mesh"});
}

// Grains far too soft for 20 turns a second, with no limit on their overlap: the rotor squeezes one out of the drum.
TEST(MixerRefusesLoss, OfAGrain) {
  Mixer mixer;
  const Outcome outcome = mixer.rig(
      "run", two, "-var speed 20 -var turns 2 -var maxOverlap 0 -var youngsModulus 2e4 -var wall_youngsModulus 2e4");
  expect_refusal(
      mixer.folder / "run", outcome,
      {"step", "178 of 179 grains are there; grain ", "was lost", "velocity", "of its radius a step; likely "});
}

// Softer still: they fall through the drum before the rotor turns.
TEST(MixerRefusesLoss, OfAGrainWhileFilling) {
  Mixer mixer;
  const Outcome outcome = mixer.rig("run", two, "-var maxOverlap 0 -var youngsModulus 100 -var wall_youngsModulus 100");
  expect_refusal(mixer.folder / "run", outcome,
                 {"step", "every 1000 steps", "of 179 grains are there; grain ", "was lost", "velocity",
                  "likely grains are too soft"});
}

// SPDX-License-Identifier: GPL-2.0-or-later
// cases/shearbox from filling to run folder: balance of forces, what the columns say, seeds, resume, ranks, and the
// numbers that `vielto post` makes of it.
#include <nlohmann/json.hpp>

#include "rig_runner.h"

using namespace vielto_test;
namespace fs = std::filesystem;

namespace {

double mean(const Table& rows, const std::string& column, std::size_t first = 0) {
  double sum = 0;
  for (std::size_t k = first; k < rows.rows.size(); k++) sum += rows.at(k, column);
  return sum / static_cast<double>(rows.rows.size() - first);
}

}  // namespace

// Newton: over the run the halves, the plate and the grains' weight leave only the change of the grains' momentum, 0.7
// N s over 0.04 s at most if all of 0.09 kg went from rest to the shear velocity: 0.25 N.
TEST(ShearboxRun, BalancesForcesAndRecordsWhatItDid) {
  Rig rig("shearbox");
  rig.must("run", coarse_shear);
  const Table rows = rig.csv("run/shear.csv");
  ASSERT_EQ(rows.rows.size(), 80u);  // 4 mm at 0.1 m/s in rows of 0.5 ms
  const double momentum = 0.09 * 0.1 / 0.04;
  EXPECT_NEAR(mean(rows, "lower_Fx_N") + mean(rows, "upper_Fx_N") + mean(rows, "plate_Fx_N"), 0, momentum);
  double weight = 0, solids = 0;
  std::istringstream in(rig.read("run/vtk/grains_" + fmt::format("{:.0f}", rows.at(79, "step")) + ".vtk"));
  for (std::string word; in >> word;)
    if (word == "radius") {
      int one, n;
      in >> one >> n >> word;
      ASSERT_EQ(n, rows.at(79, "grains"));
      for (double r; n > 0 && in >> r; n--) solids += 4.0 / 3 * pi * r * r * r;
    }
  weight = solids * 1375 * 9.81;
  EXPECT_GT(weight, 0.5);
  EXPECT_NEAR(mean(rows, "lower_Fz_N") + mean(rows, "upper_Fz_N") + mean(rows, "plate_Fz_N"), weight, momentum);
  EXPECT_GT(mean(rows, "lower_Fx_N", 40), 1);         // the drive supplies
  EXPECT_NEAR(-mean(rows, "plate_Fz_N"), 7.06, 1.5);  // 1961 Pa on 36 cm2, and the plate's inertia
  for (std::size_t k = 0; k < 80; k++) {
    const double time = 5e-4 * static_cast<double>(k + 1);
    EXPECT_NEAR(rows.at(k, "time_s"), time, 1e-9);
    EXPECT_NEAR(rows.at(k, "displacement_m"), 0.1 * time, 1e-9);
    // the bed fills 36 cm2 from 15 mm under the split to the plate; the dump's radii have six digits
    EXPECT_NEAR(rows.at(k, "porosity"), 1 - solids / (0.0036 * (rows.at(k, "plate_position_m") + 0.015)), 1e-5);
    EXPECT_NEAR(rows.at(k, "plate_position_m") - rows.at(k, "dilation_m"),
                rows.at(0, "plate_position_m") - rows.at(0, "dilation_m"), 1e-10);
  }
  // the mean velocity of a row carries the plate from the middle of one row to that of the next
  for (std::size_t k = 1; k < 80; k++)
    EXPECT_NEAR(rows.at(k, "plate_position_m") - rows.at(k - 1, "plate_position_m"),
                2.5e-4 * (rows.at(k, "plate_velocity_m_s") + rows.at(k - 1, "plate_velocity_m_s")), 2e-6);
}

TEST(ShearboxRun, IsDecidedByItsSeedAndSameWithTheStockProgram) {
  Rig rig("shearbox");
  const std::string brief = "-var displacement 0.0005 ";
  rig.must("a", coarse_shear, brief);
  rig.must("stock", coarse_shear, brief, 1, Program::stock);
  rig.must("other", coarse_shear, brief + "-var seed 2");
  EXPECT_EQ(rig.read("a/shear.csv"), rig.read("stock/shear.csv"));
  EXPECT_NE(rig.csv("a/shear.csv").at(0, "lower_Fx_N"), rig.csv("other/shear.csv").at(0, "lower_Fx_N"));
}

// A killed run taken up again: the same rows up to the restart, then the same to the last digits until the order of
// sums has grown (tests/rigs/mixer_resume_test.cpp); two ranks alike.
TEST(ShearboxResume, CarriesOnAKilledRunOnOneAndTwoRanks) {
  Rig rig("shearbox");
  const std::string restarts = "-var restartRows 20 ";
  rig.must("whole", coarse_shear, restarts);
  const std::string partial = (rig.folder / "broken.partial").string();
  const Outcome killed =
      rig.shell(fmt::format("d='{}'; first() {{ ls $d/restart | sort -n | head -1 | cut -d. -f1; }}; last() {{ tail -n "
                            "1 $d/shear.csv | cut -d, "
                            "-f1; }}; {} & p=$!; until [ -n \"$(first)\" ] && [ $(last) -gt $(first) ]; do kill -0 $p "
                            "|| exit 99; sleep 0.02; "
                            "done 2>/dev/null; kill -9 $p; wait $p",
                            partial, rig.command_of("broken", coarse_shear, restarts)));
  ASSERT_EQ(killed.status, 128 + 9) << killed.text;
  fs::copy(partial, rig.folder / "two.partial", fs::copy_options::recursive);
  rig.must("broken", coarse_shear, restarts + "-var resume yes");
  rig.must("two", coarse_shear, restarts + "-var resume yes", 2);
  const Table whole = rig.csv("whole/shear.csv"), broken = rig.csv("broken/shear.csv"), two = rig.csv("two/shear.csv");
  ASSERT_EQ(broken.rows.size(), 80u);
  ASSERT_EQ(two.rows.size(), 80u);
  EXPECT_EQ(difference(whole, broken, 0, 20), 0);
  EXPECT_LT(difference(whole, broken, 20, 24), 1e-7);
  EXPECT_LT(difference(whole, two, 20, 24), 1e-7);
}

// A bed that was filled and loaded once is sheared again: the same record to the last digit, and at another velocity
// the same bed at the start. A bed of other grain is refused.
TEST(ShearboxRun, ShearsTheBedOfAnotherRun) {
  Rig rig("shearbox");
  rig.must("first", coarse_shear);
  const std::string bed = fmt::format("-var bed '{}' ", (rig.folder / "first").string());
  rig.must("again", coarse_shear, bed);
  EXPECT_EQ(rig.read("first/shear.csv"), rig.read("again/shear.csv"));
  rig.must("slower", coarse_shear, bed + "-var shearVelocity 0.05 ");
  const Table first = rig.csv("first/shear.csv"), slower = rig.csv("slower/shear.csv");
  EXPECT_NEAR(slower.at(0, "porosity"), first.at(0, "porosity"), 1e-4);
  EXPECT_NEAR(slower.at(1, "displacement_m"), first.at(0, "displacement_m"), 1e-12);
  EXPECT_NE(rig.rig("other", coarse_shear, bed + "-var seed 2 ").text.find("cannot take the bed"), std::string::npos);
  EXPECT_NE(rig.rig("no", coarse_shear, "-var bed nowhere ").text.find("cannot take the bed of nowhere"),
            std::string::npos);
}

// Slippery while it is filled, the grain lies closer than with the friction of its card.
TEST(ShearboxRun, IsFilledWithAFrictionOfItsOwn) {
  Rig rig("shearbox");
  rig.must("close", coarse_shear);
  rig.must("loose", coarse_shear, "-var fillFrictionAngle 28 -var overfill 1.05 ");
  EXPECT_LT(rig.csv("close/shear.csv").at(0, "porosity") + 0.01, rig.csv("loose/shear.csv").at(0, "porosity"));
}

TEST(ShearboxPost, MakesTheNumbersOfTheRun) {
  Rig rig("shearbox");
  rig.must("run", coarse_shear);
  const Outcome done = rig.vielto("post run --test coarse");
  ASSERT_EQ(done.status, 0) << done.text;
  const auto json = nlohmann::json::parse(rig.read("run/post/shear.json"));
  const Table rows = rig.csv("run/shear.csv");
  // the steady part begins at the end of a row
  std::size_t first = 0;
  while (first < 80 && rows.at(first, "displacement_m") < json["steady_from_m"].get<double>() + 1e-9) first++;
  ASSERT_LE(first, 40u);
  const double stress = mean(rows, "lower_Fx_N", first) / 0.0036;
  EXPECT_NEAR(json["shear_stress_steady_Pa"], stress, 1e-9 * stress);
  EXPECT_NEAR(json["friction_coefficient"], stress / 1961, 1e-9);
  EXPECT_GE(json["shear_stress_peak_Pa"], json["shear_stress_steady_Pa"]);
  const std::string table = rig.read("run/post/observations.csv");
  for (const char* observable : {"shear_stress_peak", "shear_stress_steady", "plate_force_fluctuation"})
    EXPECT_NE(table.find(fmt::format("coarse,fit,shearbox,{},", observable)), std::string::npos) << table;
}

class ShearboxRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(ShearboxRefuses, WithOneLine) {
  Rig rig("shearbox");
  const Outcome outcome = rig.rig("run", coarse_shear, GetParam().option);
  expect_refusal(rig.folder / "run", outcome, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, ShearboxRefuses,
    testing::Values(
        Refusal{"NegativeStress", "-var normalStress -1", {"normalStress is -1", "> 0"}},
        Refusal{"NoVelocity", "-var shearVelocity 0", {"shearVelocity is 0"}},
        Refusal{"DisplacementOverFlange", "-var displacement 0.013", {"displacement is 0.013", "flangeLength"}},
        Refusal{"TimeStepOverLimit", "-var dtFraction 0.06", {"dtFraction is 0.06", "0.05"}},
        Refusal{"GrainTooLarge", "-var grainDiameter 0.007", {"grainDiameter is 0.007"}},
        Refusal{
            "BoxNarrowerThanItsGrains", "-var boxWidth 0.001", {"grainDiameter is 0.006", "0.1 boxWidth (0.0001 m)"}},
        Refusal{"BoxLowerThanItsGrains", "-var boxHeight 0.02", {"grainDiameter is 0.006", "0.2 boxHeight (0.004 m)"}},
        Refusal{"HalvesWithoutAGap", "-var splitGap 0", {"splitGap is 0 m", "> 0"}},
        Refusal{"NoRoomForFilling", "-var freeboard 0", {"freeboard"}},
        Refusal{"RestartsWithinARow", "-var restartRows 0.4", {"restartRows is 0.4", "whole number"}},
        Refusal{"NoGravity", "-var gravity 0", {"gravity is 0", "> 0"}},
        Refusal{"NegativeBulkDensity", "-var bulkDensity -1", {"bulkDensity is -1", "> 0"}},
        Refusal{"WordForNumber", "-var shearVelocity fast", {"shearVelocity is 'fast'", "number"}},
        Refusal{"MisspelledParameter", "-var normalStres 100", {"-var normalStres", "no such parameter"}},
        Refusal{"OtherRig", "-var rig mixer", {"rig is mixer", "made with shearbox"}},
        Refusal{"ImpossibleGeometry", "-var splitHeight 0.04", {"vielto geometry", "failed"}},
        Refusal{"BoxNotFull", "-var bulkDensity 500", {"does not fill the box", "overfill"}},
        Refusal{"PlateNotAtRest", "-var maxPlateError 1e-9 -var loadTime 0.02", {"not at rest", "loadTime"}},
        Refusal{"OverlapOverLimit", "-var maxOverlap 0.002", {"overlap of grain", "maxOverlap"}}),
    name_of);

TEST(ShearboxRefusesRun, ThatIsThereOrWasNeverBegun) {
  Rig rig("shearbox");
  fs::create_directories(rig.folder / "old");
  EXPECT_NE(rig.rig("old", coarse_shear).text.find("is there already"), std::string::npos);
  EXPECT_NE(rig.rig("none", coarse_shear, "-var resume yes").text.find("cannot resume"), std::string::npos);
}

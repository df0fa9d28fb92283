// SPDX-License-Identifier: GPL-2.0-or-later
// Every law in the rigs (liggghts_addons/CMakeLists.txt names them): a short coarse drum of each, and what they cannot
// honour; a shear box of one of LIGGGHTS' own.
#include "rig_runner.h"

using namespace vielto_test;

namespace {

// Grains of 1 cm turned fast; Hertz' time step follows the overlap limit. CohFrictPhys, without damping, presses
// deepest.
const std::string coarse =
    "-var grainDiameter 0.01 -var youngsModulus 2e4 -var wall_youngsModulus 2e4 -var speed 0.5 -var startAngle 40 "
    "-var frames 3 -var frameAngle 5 -var settleTime 0.2 -var maxOverlap 0.1 ";

class LawDrum : public testing::TestWithParam<std::string> {};

std::vector<std::string> laws() {
  std::vector<std::string> options;
  std::istringstream names(VIELTO_LAWS);
  for (std::string name; names >> name;) options.push_back("-var law " + name + " ");
  options.push_back("-var law hooke -var cohesion sjkr2 -var cohesionEnergyDensity 100 ");
  return options;
}

}  // namespace

/* The bed keeps its grains within the drum and is carried up on the side of positive y (drum_run_test.cpp). */
TEST_P(LawDrum, CarriesTheBedUp) {
  Rig rig("drum");
  rig.must("run", coarse, GetParam());
  const Table bed = rig.csv("run/bed_3.csv");
  ASSERT_EQ(bed.rows.size(), rig.csv("run/bed_1.csv").rows.size());
  ASSERT_GT(bed.rows.size(), 100u);
  double y = 0, z = 0;
  for (std::size_t k = 0; k < bed.rows.size(); k++) {
    EXPECT_LT(std::hypot(bed.at(k, "y_m"), bed.at(k, "z_m")), 0.075);
    y += bed.at(k, "y_m") / static_cast<double>(bed.rows.size());
    z += bed.at(k, "z_m") / static_cast<double>(bed.rows.size());
  }
  EXPECT_GT(y, 0.005);
  EXPECT_LT(z, 0);
  EXPECT_NE(rig.read("run/bed_1.csv").find("# dt_over_tc=0.05\n"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Laws, LawDrum, testing::ValuesIn(laws()));

/* The bed is filled slippery (5 deg) and sheared with the card's friction (contacts of 26 and 27 deg): it resists by
 * far more than one that stays slippery. */
TEST(StockShearbox, IsFilledSlipperyAndShearedWithTheCardsFriction) {
  Rig rig("shearbox");
  const auto force = [&](const std::string& run, const std::string& friction) {
    rig.must(run, coarse_shear, "-var law hooke " + friction);
    const Table rows = rig.csv(run + "/shear.csv");
    double sum = 0;
    for (std::size_t k = 40; k < rows.rows.size(); k++) sum += rows.at(k, "lower_Fx_N");
    return sum / static_cast<double>(rows.rows.size() - 40);
  };
  const double slippery = force("slippery", "-var frictionAngle 5 -var wall_frictionAngle 5 ");
  EXPECT_GT(slippery, 0);
  EXPECT_GT(force("card", ""), 2 * slippery);
}

class StockRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(StockRefuses, WithOneLine) {
  Rig rig(GetParam().rig);
  expect_refusal(rig.folder / "run", rig.rig("run", "", GetParam().option), GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, StockRefuses,
    testing::Values(
        Refusal{"Twisting", "-var law hertz -var twistingResistance 0.2", {"law hertz", "twistingResistance"}, "drum"},
        Refusal{
            "WallTwisting", "-var law hooke -var wall_twistingResistance 0.2", {"wall_twistingResistance"}, "shearbox"},
        Refusal{"Energy", "-var law hooke -var energyBalance on", {"law hooke", "energyBalance on"}, "mixer"},
        Refusal{"Bonds", "-var law hertz -var bondNewContacts on", {"bondNewContacts on"}, "repose"},
        Refusal{"Dashpot", "-var law hertz -var wall_tangentialDamping 0.3", {"wall_tangentialDamping 0.3"}, "drum"},
        Refusal{"NoRestitution", "-var law hooke -var normalDamping 3", {"normalDamping", "0.69"}, "drum"},
        Refusal{"NoLimit", "-var law hertz -var maxOverlap 0", {"hertz needs a maxOverlap > 0"}, "drum"},
        Refusal{"NoSuchLaw", "-var law hertzian", {"law is 'hertzian'", "give vielto, cohfrict, hertz"}, "drum"},
        Refusal{"NoSuchPartner",
                "-var law hooke -var cohesion adhesion",
                {"law hooke takes no cohesion adhesion", "sjkr, sjkr2 or off"},
                "drum"},
        Refusal{"OwnCohesion", "-var law cohfrict -var cohesion adhesion", {"law cohfrict", "normalCohesion"}, "drum"},
        Refusal{"ParameterOfAnotherLaw",
                "-var hertzOverlap 0.02",
                {"law vielto has no counterpart of hertzOverlap 0.02"},
                "drum"},
        Refusal{"OutOfRange", "-var law hertz -var hertzOverlap 0.2", {"hertzOverlap is '0.2'", "(0, 0.1]"}, "drum"},
        Refusal{"NoNumber", "-var law hertz -var poissonsRatio 0,3", {"poissonsRatio is '0,3'", "[0, 0.5]"}, "drum"},
        Refusal{"NoWord", "-var law cohfrict -var bondNewContacts 1", {"bondNewContacts is '1'", "on or off"}, "drum"}),
    name_of);

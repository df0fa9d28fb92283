// SPDX-License-Identifier: GPL-2.0-or-later
// A mixer run killed on the way and taken up again. The restart file holds positions, velocities, forces, contact
// history of pairs and meshes, the rotor's position and the record's accounts.
#include "mixer_runner.h"

using namespace vielto_test;

namespace {

const std::string restarts = four + "-var restartTurns 0.1 -var energyBalance on ";
const std::size_t rows = 108;  // 0.3 turns
const std::size_t kept = 36;   // rows up to the first restart

// Row k ends at step (k + 1) N and turn (k + 1)/360.
void expect_every_row_once(const Mixer& mixer, const std::string& name) {
  const Table table = mixer.csv(name + "/torque.csv");
  const double interval = std::stod(mixer.header(name, "interval_steps"));
  ASSERT_EQ(table.rows.size(), rows);
  for (std::size_t k = 0; k < rows; k++) {
    ASSERT_EQ(table.at(k, "step"), (static_cast<double>(k) + 1) * interval) << "row " << k;
    ASSERT_NEAR(table.at(k, "turn"), (static_cast<double>(k) + 1) / 360, 1e-8) << "row " << k;
  }
}

}  // namespace

// The resumed run has the same state to the last digit; only sums over neighbours are taken in another order, and in a
// granular bed such a difference of 1e-16 grows (here to 1e-5 in 0.2 turns). The record prints 9 digits.
TEST(MixerResume, CarriesOnAKilledRunAsIfNeverBrokenOff) {
  Mixer mixer;
  mixer.must("whole", restarts);
  mixer.must_break_off("broken", restarts);
  std::ofstream(mixer.folder / "broken.partial/torque.csv", std::ios::app) << "12";  // a line cut off by the kill
  mixer.must("broken", restarts, "-var resume yes");
  expect_every_row_once(mixer, "whole");
  expect_every_row_once(mixer, "broken");
  const Table whole = mixer.csv("whole/torque.csv"), broken = mixer.csv("broken/torque.csv");
  EXPECT_EQ(difference(whole, broken, 0, kept), 0);
  EXPECT_LT(difference(whole, broken, kept, kept + 12), 1e-8);
  EXPECT_LT(difference(whole, broken, kept + 12, rows), 1e-2);
  EXPECT_GT(std::fabs(rotor(whole, kept + 1)), 0.1);  // paddles were in the bed at the restart
}

// Ranks divide sums otherwise: differences as above. Over the first twelve rows grains are pushed and slide.
TEST(MixerResume, OneAndTwoRanksAgreeFromACommonRestart) {
  Mixer mixer;
  mixer.must_break_off("one", restarts);
  std::filesystem::copy(mixer.folder / "one.partial", mixer.folder / "two.partial",
                        std::filesystem::copy_options::recursive);
  mixer.must("one", restarts, "-var resume yes");
  mixer.must("two", restarts, "-var resume yes", 2);
  expect_every_row_once(mixer, "two");
  const Table one = mixer.csv("one/torque.csv"), two = mixer.csv("two/torque.csv");
  EXPECT_LT(difference(one, two, kept, kept + 12), 1e-8);
  EXPECT_LT(difference(one, two, kept + 12, rows), 1e-2);
  EXPECT_GT(one.at(kept + 11, "diss_sliding_J"), 1.01 * one.at(kept, "diss_sliding_J"));  // contacts slid meanwhile
}

// A queue ends a run with SIGTERM: no success, no finished folder, nothing left in the case's folder, and it can be
// resumed.
TEST(MixerResume, CarriesOnARunThatWasAskedToEnd) {
  Mixer mixer;
  const Outcome ended = mixer.break_off("run", restarts, "TERM");
  EXPECT_EQ(ended.status, 1) << ended.text;
  EXPECT_FALSE(std::filesystem::exists(mixer.folder / "run"));
  for (const auto& entry : std::filesystem::directory_iterator(VIELTO_SOURCE_DIR "/cases/mixer"))
    EXPECT_EQ(entry.path().filename().string().find("restart_forced"), std::string::npos) << entry.path();
  mixer.must("run", restarts, "-var resume yes");
  expect_every_row_once(mixer, "run");
  // the log goes on too
  const std::string log = mixer.read("run/log.liggghts");
  EXPECT_NE(log.find("filling: "), std::string::npos);
  EXPECT_NE(log.find("done: "), std::string::npos);
}

TEST(MixerResume, RefusesARunBrokenOffBeforeItsFirstRestart) {
  Mixer mixer;
  const Outcome none = mixer.rig("none", restarts, "-var resume yes");
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.text.find("cannot resume"), std::string::npos) << none.text;
  const std::string partial = (mixer.folder / "early.partial/torque.csv").string();
  mixer.shell(mixer.command_of("early", four) + " & p=$!; until [ -e '" + partial +
              "' ]; do kill -0 $p || exit 99; sleep 0.02; done; kill -9 $p; wait $p");
  const Outcome early = mixer.rig("early", four, "-var resume yes");
  EXPECT_NE(early.status, 0);
  EXPECT_NE(early.text.find("broken off before the first restart file was complete; start anew"), std::string::npos)
      << early.text;
  const Outcome other = mixer.rig("early", four, "-var resume yes -var fill 0.2");
  EXPECT_NE(other.text.find("it was started with fill 0.15, not 0.2"), std::string::npos) << other.text;
}

// Runs of one fill may share a bed: the same record to the last digit, and at another speed the same grains in it. A
// bed of other grain, and one of a run without grain, are refused.
TEST(MixerBed, OfAnotherRunIsMixed) {
  Mixer mixer;
  mixer.must("first", four);
  const std::string bed = fmt::format("-var bed '{}' ", (mixer.folder / "first").string());
  mixer.must("again", four, bed);
  EXPECT_EQ(mixer.read("first/torque.csv"), mixer.read("again/torque.csv"));
  mixer.must("slower", four, bed + "-var speed 0.85 ", 2);
  EXPECT_EQ(mixer.header("slower", "mass_kg"), mixer.header("first", "mass_kg"));
  EXPECT_EQ(mixer.header("slower", "speed"), "0.85");
  const Table slower = mixer.csv("slower/torque.csv");
  EXPECT_NEAR(slower.at(slower.rows.size() - 1, "turn"), 0.3, 1e-8);
  EXPECT_GT(rms(slower, "paddles_Nm", 0, slower.rows.size()), 0.01);  // the paddles met it
  const std::string log = mixer.read("slower/log.liggghts");
  EXPECT_EQ(log.find("filling: "), std::string::npos);
  EXPECT_NE(mixer.rig("other", four, bed + "-var fill 0.2 ").text.find("it was started with fill 0.15, not 0.2"),
            std::string::npos);
  mixer.must("idle", four, "-var fill 0 ");
  const std::string none = fmt::format("-var bed '{}' -var fill 0 ", (mixer.folder / "idle").string());
  EXPECT_NE(mixer.rig("none", four, none).text.find("bed.restart is missing"), std::string::npos);
}

// SPDX-License-Identifier: GPL-2.0-or-later
/* A restart through `liggghts` brings positions, velocities and contact history (between grains and with a moving mesh)
   back exactly, and the record goes on as one file. What follows is not bit for bit the run that was not broken off:
   LIGGGHTS takes the first forces with full-step velocities and with a moving mesh that has no velocity yet, which
   kicks grains on it by gamma v_wall dt/(2 m), some mm/s. So the state is asked exactly, what follows by its means. */
#include "tests/rigs/sheared_bed.h"

namespace {

using namespace vielto_test;

const long before = 12000, after = 12000, row = 500;

TEST(Restart, BringsStateAndContactHistoryBackExactly) {
  Liggghts run;
  run.script =
      bed_start(run) + bed_walls(run, "A", before, row) + fmt::format("run {}\nwrite_restart half.restart\n", before);
  run.must();
  run.script = bed_restart("half.restart") + bed_walls(run, "B", before, row) + "run 0\n";
  run.must();
  const std::vector<Table> statesA = run.dump("stateA"), statesB = run.dump("stateB");
  const Table &a = frame_of(statesA, before), &b = frame_of(statesB, before);
  ASSERT_EQ(a.rows.size(), 64u);
  ASSERT_EQ(b.rows.size(), 64u);
  for (std::size_t i = 0; i < 64; i++) {
    EXPECT_EQ(a.x(i), b.x(i)) << i;
    EXPECT_EQ(a.v(i), b.v(i)) << i;
    EXPECT_EQ(a.w(i), b.w(i)) << i;
  }
  for (const bool pairs : {true, false}) {
    const std::vector<Table> contactsA = run.dump(pairs ? "pairA" : "wallA"),
                             contactsB = run.dump(pairs ? "pairB" : "wallB");
    const auto historyA = history(frame_of(contactsA, before), pairs),
               historyB = history(frame_of(contactsB, before), pairs);
    EXPECT_GT(historyA.size(), pairs ? 12u : 6u);
    EXPECT_EQ(historyA, historyB);
    double force = 0, rolling = 0, twisting = 0;
    for (const auto& [partners, values] : historyA) {
      force = std::max(force, std::fabs(values[0]));
      rolling = std::max(rolling, std::fabs(values[3]));
      twisting = std::max(twisting, std::fabs(values[6]));
    }
    EXPECT_GT(force, 1e-4);  // N, a tenth of a grain's weight: there is history to bring back
    EXPECT_GT(rolling, 1e-8);
    EXPECT_GT(twisting, 1e-8);
  }
}

// The record of a broken-off run and of its restart is one file: one header, every row once and in order, those up to
// the restart as they were, accounts and turns going on. The mean torque afterwards is that of the unbroken run within
// what rows scatter.
TEST(Restart, CarriesTheRecordOn) {
  Liggghts whole;
  whole.script = bed_start(whole) + bed_walls(whole, "A", before, row) + fmt::format("run {}\n", before + after);
  whole.must();
  Liggghts run;
  // broken off two rows after the restart was written: those rows are to be cut off
  run.script = bed_start(run) + bed_walls(run, "A", before, row) +
               fmt::format("restart {} half.restart\nrun {}\nshell mv half.restart.{} half.restart\n", before,
                           before + 2 * row, before);
  run.must();
  const Table first = run.csv("torque.csv");
  ASSERT_EQ(first.rows.size(), static_cast<std::size_t>(before / row + 2));
  run.script = bed_restart("half.restart") + bed_walls(run, "B", before, row) + fmt::format("run {}\n", after);
  run.must();
  const Table joined = run.csv("torque.csv"), unbroken = whole.csv("torque.csv");
  const std::size_t rows = static_cast<std::size_t>((before + after) / row),
                    kept = static_cast<std::size_t>(before / row);
  ASSERT_EQ(joined.rows.size(), rows);
  ASSERT_EQ(unbroken.rows.size(), rows);
  double mean[2] = {0, 0}, square[2] = {0, 0};
  for (std::size_t k = 0; k < rows; k++) {
    EXPECT_EQ(joined.at(k, "step"), static_cast<double>(row) * static_cast<double>(k + 1));
    EXPECT_EQ(joined.at(k, "time_s"), unbroken.at(k, "time_s"));
    EXPECT_EQ(joined.at(k, "turn"), unbroken.at(k, "turn"));
    if (k < kept) {
      EXPECT_EQ(joined.rows[k], first.rows[k]) << k;
      continue;
    }
    for (const Table* t : {&joined, &unbroken}) {
      const double torque = t->at(k, "floor_Nm"), n = static_cast<double>(rows - kept);
      mean[t == &joined] += torque / n;
      square[t == &joined] += torque * torque / n;
    }
  }
  // accounts are sums since the rotation began: none starts anew, each grows by some percent from row to row
  for (const char* account :
       {"work_J", "diss_normal_J", "diss_tangential_J", "diss_sliding_J", "diss_rolling_J", "diss_twisting_J"})
    EXPECT_NEAR(joined.at(kept, account) / joined.at(kept - 1, account),
                unbroken.at(kept, account) / unbroken.at(kept - 1, account), 0.02)
        << account;
  // standard error of the difference of two means of 24 rows, rows taken as correlated in pairs; four of them
  const double scatter = std::sqrt(square[0] - mean[0] * mean[0]);
  EXPECT_NEAR(mean[1], mean[0], 4 * scatter * std::sqrt(2.0 / 12));
  EXPECT_GT(mean[0], 2 * scatter * std::sqrt(2.0 / 12));
  std::size_t headers = 0;
  const std::string text = run.read("torque.csv");
  for (std::size_t at = text.find("step,time_s"); at != std::string::npos; at = text.find("step,time_s", at + 1))
    headers++;
  EXPECT_EQ(headers, 1u);
}

TEST(Restart, WithoutTheRecordItCarriesOnIsAnError) {
  Liggghts run;
  run.script = bed_start(run) + bed_walls(run, "A", 1000, row) + "run 1000\nwrite_restart half.restart\n";
  run.must();
  std::filesystem::remove(run.folder / "torque.csv");
  run.script = bed_restart("half.restart") + bed_walls(run, "B", 1000, row) + "run 0\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.text.find("cannot read torque.csv"), std::string::npos) << outcome.text;
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// The pair loop: our own and LIGGGHTS' give the same numbers, and a contact that ends takes its history with it.
#include "sheared_bed.h"

namespace {

using namespace vielto_test;

// A stress in every row of the log makes LIGGGHTS ask for the virial, which our loop leaves to LIGGGHTS' own.
const char* const general_loop =
    "compute stress all stress/atom\ncompute sum all reduce sum c_stress[1]\nthermo_style custom step c_sum\nthermo 1\n";

class PairLoop : public testing::TestWithParam<const char*> {};

/* A spinning grain bounces on a fixed one twice. A fresh run that begins in the flight between knows nothing of the
   first bounce: neither may the second bounce. Tolerance: round-off of the digits handed over, grown in one bounce. */
TEST_P(PairLoop, HistoryEndsWithTheContact) {
  Material m;
  m.normalDamping = 0;
  m.tangentialDamping = 0;
  const long flight = 4000, end = 10000;
  const auto fly = [&](const Sphere& grain, long steps) {
    Liggghts run;
    run.script = head(run, {Sphere(), grain}, {m}, 0.1) + "group flying id 2\n" + GetParam() +
                 "timestep 2e-6\nfix move flying nve/sphere\nfix gravity flying gravity 50 vector 0 0 -1\n" +
                 dump_grains("states", 2000) + fmt::format("run {}\n", steps);
    run.must();
    return run.dump("states");
  };
  Sphere grain;
  grain.x = {0, 0, 2 * grain.radius + 1e-4};
  grain.v = {0, 0, -0.4};
  grain.w = {0, 10, 0};
  const std::vector<Table> whole = fly(grain, end);
  const Table &between = whole[2], &last = whole.back();
  grain.x = between.x(1), grain.v = between.v(1), grain.w = between.w(1);
  ASSERT_GT(grain.x.norm(), 2 * grain.radius);
  ASSERT_LT(between.w(1)[1], 9) << "friction acted in the first bounce";
  const Table fresh = fly(grain, end - flight).back();
  ASSERT_GT(last.v(1)[2], between.v(1)[2]) << "bounced again";
  EXPECT_LT((last.w(1) - fresh.w(1)).norm(), 1e-9 * grain.w.norm());
  EXPECT_LT((last.v(1) - fresh.v(1)).norm(), 1e-9 * 0.4);
}

INSTANTIATE_TEST_SUITE_P(OursAndLiggghts, PairLoop, testing::Values("", general_loop));

TEST(PairLoops, OursGivesTheNumbersOfLiggghtsToTheLastDigit) {
  std::string states[2];
  for (const bool general : {false, true}) {
    Liggghts run;
    run.script = bed_start(run) + (general ? general_loop : "") + bed_walls(run, "", 500, 500) + "run 3000\n";
    run.must();
    states[general] = run.read("state") + run.read("pair") + run.read("torque.csv");
  }
  EXPECT_EQ(states[0], states[1]);
  EXPECT_GT(states[0].size(), 10000u);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// The pair loop: our own and LIGGGHTS' give the same numbers, and a contact that ends takes its history with it.
#include <sys/resource.h>

#include "tests/rigs/sheared_bed.h"

namespace {

using namespace vielto_test;

// A stress in every row of the log makes LIGGGHTS ask for the virial, which our loop leaves to LIGGGHTS' own.
const char* const general_loop =
    "compute stress all stress/atom\ncompute sum all reduce sum c_stress[1]\nthermo_style custom step c_sum\nthermo "
    "1\n";

class PairLoop : public testing::TestWithParam<const char*> {};

/* A grain is torn off another in the middle of a sliding contact, with its springs loaded, and comes back. A fresh run
   that begins in the flight between knows nothing of the first contact: neither may the second. Tolerance: round-off of
   the digits handed over, grown in one bounce. (LIGGGHTS' loop keeps the springs of a pair that has parted, unless the
   law asks for its surfacesClose beyond the radii.) */
TEST_P(PairLoop, HistoryEndsWithTheContact) {
  const long loaded = 80, apart = 85, back = 24 * apart;
  const auto start = [&](const Liggghts& run, const Sphere& grain) {
    return head(run, {Sphere(), grain}, {Material()}, 0.1) + "group flying id 2\n" + GetParam() +
           "timestep 2e-6\nfix move flying nve/sphere\n" + dump_grains("states", apart);
  };
  Sphere grain;
  grain.x = {0, 0, 2 * grain.radius};
  grain.v = {0.3, 0, -0.4};
  Liggghts whole;
  whole.script = start(whole, grain) +
                 fmt::format(
                     "run {}\nvelocity flying set 0 0 100 units box\nrun {}\nvelocity flying set 0 0 -0.4 units box\n"
                     "run {}\n",
                     loaded, apart - loaded, back);
  whole.must();
  const Table between = whole.dump("states")[1], end = whole.dump("states").back();
  ASSERT_GT(std::fabs(between.w(1)[1]), 1) << "friction has acted";
  ASSERT_GT(between.x(1).norm(), 2 * grain.radius) << "the grains have parted";
  grain.x = between.x(1), grain.w = between.w(1), grain.v = {0, 0, -0.4};
  Liggghts fresh;
  fresh.script = start(fresh, grain) + fmt::format("run {}\n", back);
  fresh.must();
  const Table alone = fresh.dump("states").back();
  ASSERT_GT(alone.v(1)[2], 0) << "bounced again";
  EXPECT_LT((end.v(1) - alone.v(1)).norm(), 1e-9 * 0.4);
  EXPECT_LT((end.w(1) - alone.w(1)).norm(), 1e-9 * grain.w.norm());
}

INSTANTIATE_TEST_SUITE_P(OursAndLiggghts, PairLoop, testing::Values("", general_loop));

class PairLoops : public testing::TestWithParam<double> {};

TEST_P(PairLoops, OursGivesTheNumbersOfLiggghtsToTheLastDigit) {
  Material m;
  m.youngsModulus = GetParam();
  std::string states[2];
  for (const bool general : {false, true}) {
    Liggghts run;
    run.script = head(run, bed_grains(), {m}, 0.1, bed_settings) + (general ? general_loop : "") +
                 bed_walls(run, "", 500, 500) + "run 20000\n";
    run.must();
    states[general] = run.read("state") + run.read("pair") + run.read("torque.csv");
  }
  EXPECT_EQ(states[0], states[1]);
  EXPECT_GT(states[0].size(), 10000u);
}

/* Two grains that meet in a box of 22 million bins: the list costs no more memory than LIGGGHTS' own, which an
   exclusion asks for, and says the same. What runs have taken is read as that of the largest so far, so LIGGGHTS' comes
   first. */
TEST(PairListInALargeBox, TakesTheMemoryOfLiggghtsAndSaysTheSame) {
  long kilobytes[2];
  std::string states[2];
  for (const bool ours : {false, true}) {
    Liggghts run;
    Sphere grain;
    grain.x = {0, 0, 2.1 * grain.radius};
    grain.v = {0.3, 0, -0.4};
    run.script = head(run, {Sphere(), grain}, {Material(), Material()}, 0.7) +
                 (ours ? "" : "neigh_modify exclude type 2 2\n") + "timestep 2e-6\nfix move all nve/sphere\n" +
                 dump_grains("states", 400) + "run 4000\n";
    run.must();
    rusage taken;
    ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &taken), 0);
    kilobytes[ours] = taken.ru_maxrss;
    states[ours] = run.read("states");
  }
  EXPECT_LT(static_cast<double>(kilobytes[1]), 1.2 * static_cast<double>(kilobytes[0]));
  EXPECT_EQ(states[0], states[1]);
}

INSTANTIATE_TEST_SUITE_P(StiffAndSoft, PairLoops, testing::Values(1e6, 2e4));

}  // namespace

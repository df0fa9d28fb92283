// SPDX-License-Identifier: GPL-2.0-or-later
/* One and two ranks from one common state, through `liggghts`. Two ranks add forces in another order, so round-off
   differs, and collisions make a small difference grow (a displacement d becomes an angle d/R): measured here, from
   1e-16 m/s about tenfold in 1000 steps (5 ms). Horizon: 6000 steps, in which 1e-10 m/s are to be expected; a thousand
   times the measured growth is allowed, 1e-13 m/s times 10 for every 1000 steps, and 5 ms of that in the places. */
#include "tests/rigs/sheared_bed.h"

namespace {

using namespace vielto_test;

const long settled = 12000, horizon = 6000, row = 500;

TEST(TwoRanks, AgreeWithOneFromACommonStateWhileContactsSlide) {
  Liggghts run;
  run.script =
      bed_start(run) + bed_walls(run, "A", settled, row) + fmt::format("run {}\nwrite_restart half.restart\n", settled);
  run.must();
  const std::string start = run.read("torque.csv");
  Table torque[2];
  for (const int ranks : {1, 2}) {
    run.write("torque.csv", start);
    // the seam of two ranks is x = 0, in the middle of the bed
    run.script = fmt::format("processors {} 1 1\n", ranks) + bed_restart("half.restart") +
                 bed_walls(run, std::to_string(ranks), 1000, row) + fmt::format("run {}\n", horizon);
    run.must(ranks);
    torque[ranks - 1] = run.csv("torque.csv");
  }
  const std::vector<Table> one = run.dump("state1"), two = run.dump("state2");
  ASSERT_EQ(one.size(), 7u);
  ASSERT_EQ(two.size(), 7u);
  for (std::size_t k = 0; k < one.size(); k++) {
    const double v = 1e-13 * std::pow(10, static_cast<double>(k));  // m/s
    for (std::size_t i = 0; i < 64; i++) {
      EXPECT_LT((one[k].x(i) - two[k].x(i)).norm(), 0.005 * v) << k;
      EXPECT_LT((one[k].v(i) - two[k].v(i)).norm(), v) << k;
      EXPECT_LT((one[k].w(i) - two[k].w(i)).norm() * 0.004, v) << k;
    }
  }
  // contact history, also of pairs across the seam
  int across = 0;
  for (const bool pairs : {true, false}) {
    const std::vector<Table> contacts1 = run.dump(pairs ? "pair1" : "wall1"),
                             contacts2 = run.dump(pairs ? "pair2" : "wall2");
    const auto history1 = history(contacts1.back(), pairs), history2 = history(contacts2.back(), pairs);
    ASSERT_EQ(history1.size(), history2.size());
    for (const auto& [partners, values] : history1) {
      ASSERT_TRUE(history2.count(partners));
      // forces in N of springs of 1e4 N/m (displacements differ by 1e-11 m), moments in N m are a hundredth of that
      for (std::size_t i = 0; i < values.size(); i++)
        EXPECT_NEAR(values[i], history2.at(partners)[i], i < 3 ? 1e-7 : 1e-9);
      if (pairs) {
        const auto side = [&](int grain) { return one.back().x(static_cast<std::size_t>(grain - 1))[0] > 0; };
        across += side(partners.first) != side(partners.second);
      }
    }
  }
  EXPECT_GT(across, 0);
  // rows: torque, forces, energy accounts (a pair across the seam is counted by halves), all but the step and the
  // counts
  ASSERT_EQ(torque[0].rows.size(), torque[1].rows.size());
  const std::size_t last = torque[0].rows.size() - 1;
  for (const std::string& name : torque[0].names)
    for (std::size_t k = static_cast<std::size_t>(settled / row); k <= last; k++)
      EXPECT_NEAR(torque[0].at(k, name), torque[1].at(k, name), 1e-5 * std::fabs(torque[0].at(k, name)) + 1e-8)
          << name << k;
  EXPECT_GT(torque[0].at(last, "diss_sliding_J"), 1.1 * torque[0].at(last - 12, "diss_sliding_J"));  // it does slide
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// One value among n that lies d from the mean of the others moves the mean by d/n.
#include "core/lone_value.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pi.h"

namespace vielto {
namespace {

// A torque of mean 4 N m with four passes of paddles a turn: median 4, median of |x - 4| 0.8 sin(pi/4), so that a
// robust deviation is 1.4826 x 0.5657 = 0.8387 N m.
std::vector<double> torque() {
  std::vector<double> signal(1440);
  for (std::size_t i = 0; i < signal.size(); ++i)
    signal[i] = 4 + 0.8 * std::sin(2 * kPi * 4 * (static_cast<double>(i) + 0.5) / 360);
  return signal;
}

std::optional<LoneValue> with_value(std::size_t index, double value) {
  std::vector<double> signal = torque();
  signal[index] = value;
  return lone_value(signal);
}

TEST(LoneValue, NamesTheRowThatMovesTheMeanByATwentieth) {
  const auto lone = with_value(700, 4 + 0.06 * 4 * 1440);
  ASSERT_TRUE(lone);
  EXPECT_EQ(lone->index, 700u);
  EXPECT_NEAR(lone->without, 4, 4 * 1e-3);  // the others' mean, less one of them
  EXPECT_NEAR(lone->mean / lone->without, 1.06, 1e-3);
}

// 100 N m of 4 move the mean of 1440 rows by 1.7 %, and lie 114 deviations off; 30 N m move it by 0.45 %.
TEST(LoneValue, NamesAFarRowThatMovesTheMeanByAHundredth) {
  const auto lone = with_value(33, 100);
  ASSERT_TRUE(lone);
  EXPECT_EQ(lone->index, 33u);
  EXPECT_FALSE(with_value(33, 30));
  EXPECT_TRUE(with_value(33, -100));
}

// Of one turn's 360 values one that lies 19 or 21 deviations off moves the mean by 1.1 or 1.2 %.
TEST(LoneValue, LeavesAWedgedGrainAlone) {
  for (const double deviations : {19.0, 21.0}) {
    std::vector<double> signal = torque();
    signal.resize(360);
    signal[10] = 4 + deviations * 0.8387;
    EXPECT_EQ(lone_value(signal).has_value(), deviations > 20) << deviations;
  }
}

// Where most values are the same, nothing can be said of their spread: only the share counts.
TEST(LoneValue, AsksForTheShareWhereMostValuesAreOne) {
  std::vector<double> signal(100, 1.0);
  signal[5] = 4;  // 3 %
  EXPECT_FALSE(lone_value(signal));
  signal[5] = 7;  // 6 %
  EXPECT_TRUE(lone_value(signal));
  EXPECT_FALSE(lone_value({3.0}));
}

}  // namespace
}  // namespace vielto

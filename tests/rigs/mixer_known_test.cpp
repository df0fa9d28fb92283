// SPDX-License-Identifier: GPL-2.0-or-later
// -var powerUncertainty: a mixer run that ends when its mean power is known, and one that cannot know it. The rule
// itself is tested on synthetic records in tests/core/stopping_rule_test.cpp.
#include "core/stopping_rule.h"
#include "mixer_runner.h"

using namespace vielto_test;

namespace {

const std::string ends = "-var powerUncertainty 0.2 -var turns 25 -var rowsPerTurn 72 -var restartTurns 2 ";

// Means of the rotor's torque over whole turns of 72 rows.
std::vector<double> turn_means(const Table& table) {
  std::vector<double> means;
  for (std::size_t k = 0; k < table.rows.size(); k++) {
    if (k % 72 == 0) means.push_back(0);
    means.back() += rotor(table, k) / 72;
  }
  return means;
}

}  // namespace

/* Batch means bound what the rule may have accepted: their spread over the root of their number is within a factor of 2
   of the uncertainty asked for (a dozen of turns tell it to a third). */
TEST(MixerUntilKnown, EndsAtATurnWithTheUncertaintyAskedFor) {
  Mixer mixer;
  const Outcome done = mixer.rig("run", two, ends);
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_NE(done.text.find("mean power known to"), std::string::npos) << done.text;
  const Table table = mixer.csv("run/torque.csv");
  ASSERT_EQ(table.rows.size() % 72, 0u);
  const std::vector<double> means = turn_means(table);
  EXPECT_GE(means.size(), 4u);
  EXPECT_LT(means.size(), 25u);
  double mean = 0, square = 0;
  const double n = static_cast<double>(means.size()) - 1;  // without the start
  for (std::size_t k = 1; k < means.size(); k++) mean += means[k] / n;
  for (std::size_t k = 1; k < means.size(); k++) square += std::pow(means[k] - mean, 2) / (n - 1);
  EXPECT_LT(std::sqrt(square / n), 2 * 0.2 * mean);
}

// Four paddles a quarter turn apart look the same after each quarter: the run may end there, and says so. What is asked
// for is met after two turns, long before three are over.
TEST(MixerUntilKnown, EndsInAQuarterOfATurnWhereTheRotorRepeats) {
  Mixer mixer;
  const Outcome done = mixer.rig("run", four, "-var powerUncertainty 0.19 -var turns 25 -var rowsPerTurn 72 ");
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_NE(done.text.find("mean power known to"), std::string::npos) << done.text;
  EXPECT_EQ(mixer.header("run", "turn_parts"), "4");
  const Table table = mixer.csv("run/torque.csv");
  const std::size_t rows = table.rows.size();
  EXPECT_EQ(rows % 18, 0u);
  EXPECT_GE(rows, 9u * 18);
  const Outcome post = mixer.vielto("post run");
  ASSERT_EQ(post.status, 0) << post.text;
  EXPECT_NE(post.text.find(fmt::format("of {:.10g} averaged", static_cast<double>(rows) / 72)), std::string::npos)
      << post.text;
}

// Rows of a degree are taken in phases of five, as `vielto post` takes them: the rule, fed with these, says the same.
TEST(MixerUntilKnown, LooksAtPhasesOfFiveDegrees) {
  Mixer mixer;
  const Outcome done = mixer.rig("run", two, "-var powerUncertainty 0.2 -var turns 25 -var rowsPerTurn 360 ");
  ASSERT_EQ(done.status, 0) << done.text;
  const Table table = mixer.csv("run/torque.csv");
  vielto::StoppingRule rule(72, 0.2);
  std::size_t known = 0;
  for (std::size_t k = 0; k + 5 <= table.rows.size(); k += 5) {
    double mean = 0;
    for (std::size_t i = 0; i < 5; i++) mean += rotor(table, k + i) / 5;
    rule.add(mean);
    if (rule.known() && known == 0) known = k + 5;
  }
  EXPECT_EQ(table.rows.size(), known) << done.text;
}

TEST(MixerUntilKnown, DecidesOnTheWholeRecordWhenResumed) {
  Mixer mixer;
  mixer.must("whole", two, ends);
  mixer.must_break_off("broken", ends + two);
  const Outcome done = mixer.rig("broken", ends + two, "-var resume yes ");
  ASSERT_EQ(done.status, 0) << done.text;
  // the bed's own chaos makes its turns other ones after the restart; what was there before counts
  const std::vector<double> whole = turn_means(mixer.csv("whole/torque.csv")),
                            broken = turn_means(mixer.csv("broken/torque.csv"));
  EXPECT_EQ(whole[0], broken[0]);
  EXPECT_EQ(whole[1], broken[1]);
  EXPECT_NE(done.text.find(fmt::format("of {} turns", broken.size())), std::string::npos) << done.text;
  EXPECT_LT(broken.size(), 25u);
}

TEST(MixerUntilKnown, SaysThatItCannot) {
  Mixer mixer;
  const Outcome done = mixer.rig("run", two, "-var powerUncertainty 0.0001 -var turns 5 -var rowsPerTurn 72 ");
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_NE(done.text.find("Warning: after 5 turns the mean power is not known to 0.01 %"), std::string::npos)
      << done.text;
  EXPECT_EQ(mixer.csv("run/torque.csv").rows.size(), 5u * 72);
}

// SPDX-License-Identifier: GPL-2.0-or-later
// Reading torque.csv: phases and turns against closed forms, what is refused and where, and how much memory it takes.
#include "rigs/torque_record.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "core/bad_input.h"
#include "synthetic_record.h"

namespace {

namespace fs = std::filesystem;
const double kPi = std::acos(-1.0);

class TorqueRecord : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("torque_record_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = (folder_ / "torque.csv").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  vielto::TorqueRecord read(const SyntheticRecord& synthetic) {
    synthetic.write(folder_);
    return vielto::read_torque_record(path_);
  }
  // The message of the refusal of this text, without the path of the file.
  std::string refusal(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      vielto::read_torque_record(path_);
    } catch (const vielto::BadInput& error) {
      return std::string(error.what()).substr(path_.size());
    }
    return "accepted";
  }

  fs::path folder_;
  std::string path_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("nothing to replace: " + from);
  return text.replace(at, from.size(), to);
}

double mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

TEST_F(TorqueRecord, ReadsItsKeys) {
  SyntheticRecord synthetic;
  synthetic.turns = 2;
  const auto record = read(synthetic);
  const auto& h = record.header;
  EXPECT_EQ(h.speed, 1.21);
  EXPECT_EQ(h.fill, 0.15);
  EXPECT_EQ(h.slice, 4);
  EXPECT_EQ(h.paddles, 22);
  ASSERT_EQ(h.paddle_angles.size(), 4u);
  EXPECT_NEAR(h.paddle_angles[3], 1.5 * kPi, 1e-12);
  EXPECT_NEAR(h.paddle_angle_step, 0.5 * kPi, 1e-12);
  EXPECT_EQ(h.material, "hulled_millet");
  EXPECT_TRUE(h.provisional);
  EXPECT_EQ(h.bulk_density, 825);
  EXPECT_EQ(h.bulk_cohesion, 6175);
  EXPECT_EQ(h.power_lever, 0.114);
  EXPECT_EQ(h.mass_target, 1.0665);
  EXPECT_EQ(h.whole_drum(), 5.5);
  EXPECT_EQ(record.first_grains, 3000);
  EXPECT_NEAR(record.intervals_per_turn, 72, 1e-9);
}

// 72 rows a turn: each row is one phase. The values are printed with nine digits.
TEST_F(TorqueRecord, RowsOfOnePhaseEachAreKeptAsTheyAre) {
  SyntheticRecord synthetic;
  synthetic.turns = 3;
  const auto record = read(synthetic);
  ASSERT_EQ(record.blocks, 3);
  ASSERT_EQ(record.paddle.size(), 4u);
  for (int i = 0; i < 3 * vielto::kPhases; ++i) {
    const double from = i / 72.0, to = (i + 1) / 72.0;
    EXPECT_NEAR(record.paddle[1][i], 0.15 + 0.02 * mean_cosine(from, to, 0.5 * kPi), 1e-9);
    EXPECT_NEAR(record.part[0][i], 0.6, 1e-8);  // four paddles in quadrature: the cosines cancel
    EXPECT_NEAR(record.part[1][i], 0.1, 1e-15);
    EXPECT_NEAR(record.part[2][i], 0.05, 1e-15);
  }
  EXPECT_NEAR(record.rotor()[10], 0.75, 1e-8);
}

// 500 rows a turn do not fit 72 phases: shares of time keep the mean of every turn exactly, and of every phase closely
// (a row of 0.72 degrees is constant to 1e-5 of the swing's curvature).
TEST_F(TorqueRecord, RowsThatReachOverPhasesCountByTheirShareOfTime) {
  SyntheticRecord synthetic;
  synthetic.rows_per_turn = 500;
  synthetic.turns = 3;
  const auto record = read(synthetic);
  ASSERT_EQ(record.blocks, 3);
  EXPECT_NEAR(mean(record.paddle[0]), 0.15, 1e-9);
  // A phase is 5 degrees: the mean of the swing's cosine over it, off by half a row's change at most: 0.02 * 2 pi/500
  // / 4.
  for (int i = 0; i < vielto::kPhases; ++i)
    EXPECT_NEAR(record.paddle[0][i], 0.15 + 0.02 * mean_cosine(i / 72.0, (i + 1) / 72.0, 0), 0.02 * 2 * kPi / 500 / 4);
}

// 7 rows a turn are longer than a phase; a turn is a fraction of rows. The turn means stay exact.
TEST_F(TorqueRecord, LongRowsThatDoNotDivideTheTurnKeepTheMeanOfLinearGrowth) {
  SyntheticRecord synthetic;
  synthetic.rows_per_turn = 36;
  synthetic.turns = 4;
  synthetic.paddle_swing = 0;
  synthetic.drift = 0.36;  // rotor torque grows by 0.36 N m a turn; a row's mean is its middle
  const auto record = read(synthetic);
  ASSERT_EQ(record.blocks, 4);
  for (int t = 0; t < 4; ++t) {
    const auto begin = record.part[0].begin() + t * vielto::kPhases;
    const double turn_mean = std::accumulate(begin, begin + vielto::kPhases, 0.0) / vielto::kPhases;
    EXPECT_NEAR(turn_mean, 0.6 + 0.36 * (t + 0.5), 1e-8);
  }
}

TEST_F(TorqueRecord, TurnsThatAreNotWholeAreLeftOutAtBothEnds) {
  SyntheticRecord synthetic;
  synthetic.start = 0.5;
  synthetic.turns = 4;  // 0.5 to 4.5: whole are 1 to 4
  synthetic.drift = 1;
  synthetic.paddle_swing = 0;
  const auto record = read(synthetic);
  EXPECT_EQ(record.first_turn, 1);
  EXPECT_EQ(record.blocks, 3);
  ASSERT_EQ(record.part[0].size(), 3u * vielto::kPhases);
  EXPECT_NEAR(mean(record.part[0]), 0.6 + 2.5, 1e-8);
  ASSERT_EQ(record.overlap_max.size(), 3u);
}

TEST_F(TorqueRecord, ASampleHoweverWildIsNeverDropped) {
  SyntheticRecord synthetic;
  synthetic.turns = 3;
  synthetic.change = [](int i, std::map<std::string, double>& row) {
    if (i == 100) row["stems_Nm"] = 1e12;
  };
  EXPECT_NEAR(mean(read(synthetic).part[1]), 1e12 / 216, 1);
}

TEST_F(TorqueRecord, GreatestOverlapIsKeptForItsOwnTurn) {
  SyntheticRecord synthetic;
  synthetic.turns = 3;
  synthetic.change = [](int i, std::map<std::string, double>& row) {
    if (i == 71) row["overlap_max"] = 0.07;  // the last row of the first turn
  };
  EXPECT_EQ(read(synthetic).overlap_max, (std::vector<double>{0.07, 0.01, 0.01}));
}

TEST_F(TorqueRecord, EnergyAccountsAreTakenWhereTurnsMeet) {
  SyntheticRecord synthetic;
  synthetic.turns = 3;
  synthetic.energy = true;
  const auto record = read(synthetic);
  ASSERT_EQ(record.energy.size(), 4u);
  // Work of a turn: 2 pi times the mean rotor torque, 0.75 N m.
  EXPECT_NEAR(record.energy[2].work - record.energy[1].work, 2 * kPi * 0.75, 1e-6);
  EXPECT_NEAR(record.energy[3].dissipated(), record.energy[3].work, 1e-6);
  EXPECT_EQ(record.energy[0].potential, 1.5);
  for (const double loss : record.energy[3].losses) EXPECT_NEAR(loss, 0.2 * record.energy[3].work, 1e-6);
  SyntheticRecord plain;
  plain.turns = 2;
  EXPECT_TRUE(read(plain).energy.empty());
}

TEST_F(TorqueRecord, UnknownColumnsAndOtherOrdersAreRead) {
  // Columns are found by name: turn the order of the first three around and add one.
  SyntheticRecord synthetic;
  synthetic.turns = 2;
  std::string text = synthetic.text(), turned;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '#') {
      turned += line + "\n";
      continue;
    }
    std::vector<std::string> fields;
    std::istringstream split(line);
    for (std::string field; std::getline(split, field, ',');) fields.push_back(field);
    std::swap(fields[0], fields[2]);
    fields.push_back(fields[2] == "step" ? "extra" : "7");
    for (std::size_t i = 0; i < fields.size(); ++i) turned += (i ? "," : "") + fields[i];
    turned += "\n";
  }
  EXPECT_EQ(refusal(turned), "accepted");
  EXPECT_NEAR(mean(vielto::read_torque_record(path_).part[0]), 0.6, 1e-8);
}

TEST_F(TorqueRecord, RefusesAFaultWithFileLineAndColumn) {
  SyntheticRecord synthetic;
  synthetic.turns = 2;
  const std::string good = synthetic.text();
  ASSERT_EQ(refusal(good), "accepted");
  // 23 keys, the header in line 24, rows from line 25 on.
  const auto row = [&](int number) {
    std::istringstream in(good);
    std::string line;
    for (int i = 0; i < number; ++i) std::getline(in, line);
    return line;
  };
  const std::string r26 = row(26);
  const std::pair<std::string, std::string> faults[] = {
      {"", ": is empty"},
      {"# schema=1\n", ": has no header line"},
      {replaced(good, "# seed=1\n", ""), ": lacks the key 'seed'"},
      {replaced(good, "# schema=1\n", "# schema=2\n"), ", line 1: the schema is not 1"},
      {replaced(good, "# fill=0.15", "# fill=fifteen"), ", line 4: key 'fill' has the value 'fifteen'"},
      {replaced(good, "# fill=0.15", "# fill=15"), ", line 4: key 'fill' has the value 15"},
      {replaced(good, "# speed=1.21", "# speed=0"), ", line 3: key 'speed' has the value '0'"},
      {replaced(good, "# speed=1.21", "# speed=1.21\n# speed=1"), ", line 4: key 'speed' is stated twice"},
      {replaced(good, "# slice=4", "# slice=3"), ", line 7: states 4 angles for a slice of 3 paddles"},
      {replaced(good, "0 90 180 270", "0 90 x 270"), ", line 7: key 'paddle_angles_deg' holds 'x'"},
      {replaced(good, "# speed=1.21", "# speed=1.22"), ", line 11: steps_per_turn * dt * speed is 1.00826"},
      {replaced(good, "paddle4_Nm,", "other,"), ", line 24, column paddle4_Nm: is missing"},
      {replaced(good, "drum_Fz_N,", "drum_Fy_N,"), ", line 24, column drum_Fy_N: is there twice"},
      {replaced(good, "contacts,", "touches,"), ", line 24, column contacts: is missing"},
      {replaced(good, r26, replaced(r26, "0.1,0.05", "nan,0.05")), ", line 26, column stems_Nm: 'nan' is not a finite"},
      {replaced(good, r26, replaced(r26, "0.1,0.05", "1e12x,0.05")), ", line 26, column stems_Nm: '1e12x' is not"},
      {replaced(good, r26, replaced(r26, "0.1,0.05", "inf,0.05")), ", line 26, column stems_Nm: 'inf' is not a finite"},
      {replaced(good, r26, replaced(r26, "0.1,0.05", ",0.05")), ", line 26, column stems_Nm: '' is not a finite"},
      {replaced(good, r26, replaced(r26, "0.1,", "")), ", line 26: has "},
      {replaced(good, r26 + "\n", ""), ", line 26, column step: is 150 where 100 follows"},
      {replaced(good, r26 + "\n", r26 + "\n" + r26 + "\n"), ", line 27, column step: is 100 where 150 follows"},
      {good.substr(0, good.size() - 1), ", line 168: is cut off"},
      {good.substr(0, good.size() - 20), ", line 168: is cut off"},
      {good.substr(0, good.find(r26) - row(25).size() - 1), ": holds no row"},
  };
  for (const auto& [text, message] : faults)
    EXPECT_EQ(refusal(text).rfind(message, 0), 0u) << "expected: " << message << "\ngot: " << refusal(text);
}

TEST_F(TorqueRecord, RefusesTimesAndTurnsThatLeaveTheSteps) {
  SyntheticRecord synthetic;
  synthetic.turns = 2;
  synthetic.change = [](int i, std::map<std::string, double>& row) {
    if (i >= 100) row["time_s"] += 0.1;
  };
  EXPECT_EQ(refusal(synthetic.text()).rfind(", line 125, column time_s: is ", 0), 0u);
  synthetic.change = [](int i, std::map<std::string, double>& row) {
    if (i >= 100) row["turn"] *= 1.1;
  };
  EXPECT_EQ(refusal(synthetic.text()).rfind(", line 125, column turn: is ", 0), 0u);
}

TEST_F(TorqueRecord, RefusesPaddlesThatDoNotAddUp) {
  SyntheticRecord synthetic;
  synthetic.turns = 2;
  synthetic.change = [](int, std::map<std::string, double>& row) { row["paddle2_Nm"] *= 1.1; };
  EXPECT_EQ(refusal(synthetic.text()).rfind(": the 4 paddle columns do not add up to paddles_Nm", 0), 0u);
}

TEST_F(TorqueRecord, RefusesAMissingFile) {
  try {
    vielto::read_torque_record(path_);
    FAIL();
  } catch (const vielto::BadInput& error) {
    EXPECT_EQ(std::string(error.what()).substr(path_.size()).rfind(": cannot be read", 0), 0u);
  }
}

// Memory grows with turns, not rows: 60 MB of rows in three turns are read in less than 5 MB more than before.
TEST_F(TorqueRecord, IsReadAsAStream) {
  SyntheticRecord synthetic;
  synthetic.turns = 0.01;
  synthetic.rows_per_turn = 100000;
  synthetic.steps_per_row = 1;
  {
    const std::string text = synthetic.text();
    const std::size_t rows_at = text.find("\n", text.find("step,time_s")) + 1;
    std::ofstream out(path_, std::ios::binary);
    out << std::setprecision(10) << text.substr(0, rows_at);
    std::string rest = text.substr(rows_at, text.find('\n', rows_at) - rows_at);
    for (int c = 0; c < 3; ++c) rest = rest.substr(rest.find(',') + 1);
    for (int i = 1; i <= 300000; ++i) {
      out << i << "," << i / 100000.0 / 1.21 << "," << i / 100000.0 << "," << rest << "\n";
    }
  }
  ASSERT_GT(fs::file_size(path_), 40'000'000u);
  const auto peak = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // kB
  };
  const long before = peak();
  EXPECT_EQ(vielto::read_torque_record(path_).blocks, 3);
  EXPECT_LT(peak() - before, 5000);
}

}  // namespace

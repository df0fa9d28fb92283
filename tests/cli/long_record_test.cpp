// SPDX-License-Identifier: GPL-2.0-or-later
// Torque records longer than memory: turns are kept as blocks, means and uncertainties stay right, and `vielto post`
// needs the same memory for any length.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "child_memory.h"
#include "rigs/mixing_power.h"
#include "rigs/torque_record.h"
#include "tests/rigs/synthetic_record.h"

namespace {

namespace fs = std::filesystem;
using namespace vielto;

class LongRecord : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("vielto_long_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

SyntheticRecord steady(double turns) {
  SyntheticRecord record;
  record.rows_per_turn = 8;
  record.turns = turns;
  return record;
}

// 1500 turns are 750 blocks of two: the first block is the mean of the first two turns of the same record cut short.
TEST_F(LongRecord, BlocksAreMeansOfTurns) {
  SyntheticRecord record = steady(1500);
  record.noise = 0.05;
  record.energy = true;
  record.write(folder_ / "long");
  record.turns = 10;
  record.write(folder_ / "short");
  const TorqueRecord longer = read_torque_record((folder_ / "long/torque.csv").string());
  const TorqueRecord shorter = read_torque_record((folder_ / "short/torque.csv").string());
  EXPECT_EQ(shorter.turns_per_block, 1);
  ASSERT_EQ(longer.turns_per_block, 2);
  EXPECT_EQ(longer.blocks, 750);
  for (int block = 0; block < 5; ++block)
    for (int i = 0; i < kPhases; ++i) {
      const double mean =
          0.5 * (shorter.part[0][(2 * block) * kPhases + i] + shorter.part[0][(2 * block + 1) * kPhases + i]);
      EXPECT_NEAR(longer.part[0][block * kPhases + i], mean, 1e-12);
    }
  ASSERT_EQ(longer.energy.size(), 751u);
  for (int block = 0; block <= 5; ++block) EXPECT_EQ(longer.energy[block].work, shorter.energy[2 * block].work);
  EXPECT_EQ(longer.overlap_max.size(), 750u);
}

// AR(1) noise of a row's rotor torque, standard deviation s, correlation rho: the mean of N rows has the variance
// s^2/N (1 + rho)/(1 - rho) (textbook, N large). 2600 turns: blocks of four. An estimate from a window has a relative
// scatter of sqrt(2 (2W+1)/N), here below 5 %; 20 % are four of these.
TEST_F(LongRecord, PowerAndItsUncertaintyStayRight) {
  SyntheticRecord record = steady(2600);
  record.noise = 0.1;
  record.rho = 0.6;
  record.write(folder_);
  const TorqueRecord read = read_torque_record((folder_ / "torque.csv").string());
  ASSERT_EQ(read.turns_per_block, 4);
  const MixingPower power = mixing_power(read, nullptr, 3);
  EXPECT_EQ(power.turns_total, 2600);
  EXPECT_GT(power.averaged.turns_kept(), 1290);
  const double rows = power.averaged.turns_kept() * record.rows_per_turn;
  const double u = record.noise * std::sqrt((1 + record.rho) / (1 - record.rho) / rows) * 22 / 4;
  EXPECT_NEAR(power.torque.u, u, 0.2 * u);
  EXPECT_NEAR(power.torque.mean, record.rotor_mean() * 22 / 4, 4 * u);
}

// Quarters of a turn become turns when there are kMostBlocks: 300 turns are read as if nothing had been said of parts.
TEST_F(LongRecord, PartsOfATurnBecomeTurns) {
  SyntheticRecord record = steady(300);
  record.noise = 0.05;
  record.energy = true;
  record.write(folder_ / "turns");
  record.turn_parts = 4;
  record.write(folder_ / "parts");
  const TorqueRecord turns = read_torque_record((folder_ / "turns/torque.csv").string());
  const TorqueRecord parts = read_torque_record((folder_ / "parts/torque.csv").string());
  EXPECT_EQ(parts.turns_per_block, 1);
  ASSERT_EQ(parts.blocks, turns.blocks);
  EXPECT_EQ(parts.part, turns.part);
  EXPECT_EQ(parts.overlap_max, turns.overlap_max);
  ASSERT_EQ(parts.energy.size(), turns.energy.size());
  for (std::size_t k = 0; k < turns.energy.size(); ++k) EXPECT_EQ(parts.energy[k].work, turns.energy[k].work);
}

TEST_F(LongRecord, AskedTurnsAreTurnsNotBlocks) {
  SyntheticRecord record = steady(1500);
  record.noise = 0.05;
  record.write(folder_);
  const TorqueRecord read = read_torque_record((folder_ / "torque.csv").string());
  EXPECT_EQ(mixing_power(read, nullptr, 1000).turns_total, 1500);
  EXPECT_THROW(mixing_power(read, nullptr, 1501), std::exception);
}

// Repeats rows of a short record with new steps, times and turns: cheap enough to write 200 MB.
void write_long(const fs::path& folder, long turns) {
  SyntheticRecord record = steady(1);
  fs::create_directories(folder);
  const std::string text = record.text();
  const auto header_end = text.find('\n', text.find("\nstep,") + 1) + 1;
  FILE* out = std::fopen((folder / "torque.csv").c_str(), "w");
  std::fputs(text.substr(0, header_end).c_str(), out);
  std::vector<std::string> rest;  // of each row, after step, time and turn
  for (std::size_t at = header_end; at < text.size();) {
    const auto end = text.find('\n', at);
    std::size_t comma = at;
    for (int i = 0; i < 3; ++i) comma = text.find(',', comma) + 1;
    rest.push_back(text.substr(comma, end - comma));
    at = end + 1;
  }
  const long rows = turns * static_cast<long>(rest.size());
  for (long i = 1; i <= rows; ++i) {
    const double turn = static_cast<double>(i) / record.rows_per_turn;
    std::fprintf(out, "%ld,%.12g,%.12g,%s\n", i * record.steps_per_row, turn / record.speed, turn,
                 rest[static_cast<std::size_t>(i - 1) % rest.size()].c_str());
  }
  std::fclose(out);
}

// The long file has over eighty megabytes and would take 440 MB of memory if every turn were kept.
TEST_F(LongRecord, MemoryDoesNotGrowWithTheRecord) {
  write_long(folder_ / "short", 1100);
  write_long(folder_ / "long", 70000);
  EXPECT_GT(fs::file_size(folder_ / "long/torque.csv"), 80e6);
  const double short_one = vielto_test::memory_of({"post", (folder_ / "short").string()});
  const double long_one = vielto_test::memory_of({"post", (folder_ / "long").string()});
  EXPECT_LT(long_one, short_one + 15) << short_one << " MB and " << long_one << " MB";
  const auto power = nlohmann::json::parse(std::ifstream(folder_ / "long/post/power.json"));
  // Constant torque but for the swing, which is nothing over whole turns.
  EXPECT_NEAR(power["torque_Nm"].get<double>(), steady(1).rotor_mean() * 22 / 4, 1e-6);
}

}  // namespace

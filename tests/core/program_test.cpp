// SPDX-License-Identifier: GPL-2.0-or-later
// Programs are started with their words as they are, whatever a shell would make of them.
#include "core/program.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using vielto::run_program;

class Program : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "vielto-test-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(folder_ / "log").rdbuf();
    return text.str();
  }
  fs::path folder_;
};

TEST_F(Program, GetsItsWordsAsTheyAre) {
  const std::string word = "; touch touched $(touch touched) `x` 'it''s' \"q\" *\n";
  EXPECT_EQ(run_program({"printf", "%s|", word, "b"}, {folder_.string(), (folder_ / "log").string()}), 0);
  EXPECT_EQ(log(), word + "|b|");
  EXPECT_FALSE(fs::exists(folder_ / "touched"));
}

TEST_F(Program, TellsHowItEnded) {
  EXPECT_EQ(run_program({"true"}), 0);
  EXPECT_EQ(run_program({"sh", "-c", "exit 3"}), 3);
  EXPECT_EQ(run_program({"sh", "-c", "kill -9 $$"}), 128 + 9);
  EXPECT_EQ(run_program({"no-such-program-anywhere"}), -1);
}

TEST_F(Program, RunsInItsFolderAndItsLogGrows) {
  for (int i = 0; i < 2; ++i) EXPECT_EQ(run_program({"pwd"}, {folder_.string(), (folder_ / "log").string()}), 0);
  const std::string place = fs::canonical(folder_).string();
  EXPECT_EQ(log(), place + "\n" + place + "\n");
}

}  // namespace

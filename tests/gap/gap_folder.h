// SPDX-License-Identifier: GPL-2.0-or-later
// A temporary folder laid out as gap/ (effects and settings beside the library) and `vielto gap` run in it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace vielto_test {

inline std::string content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

class GapFolder : public testing::Test {
 protected:
  void SetUp() override {
    namespace fs = std::filesystem;
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / fmt::format("gap_{}_{}_{}", info->test_suite_name(), info->name(), getpid());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "library");
    for (const char* name : {"effects", "diagnosis.toml", "next_tests.toml"})
      fs::copy(fs::path(VIELTO_SOURCE_DIR) / "libraries" / name, folder_ / name, fs::copy_options::recursive);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  int gap(const std::string& arguments) {
    const std::string command =
        fmt::format("cd '{}' && '{}/vielto' gap {} > out.txt 2> err.txt", folder_.string(), VIELTO_BIN_DIR, arguments);
    const int status = std::system(command.c_str());
    out_ = content(folder_ / "out.txt");
    err_ = content(folder_ / "err.txt");
    return WEXITSTATUS(status);
  }
  // One line that says what is wrong and how to mend it.
  void expect_one_line(const std::string& part) const {
    EXPECT_EQ(err_.rfind("vielto: ", 0), 0u) << err_;
    EXPECT_NE(err_.find(part), std::string::npos) << "expected: " << part << "\ngot: " << err_;
    EXPECT_NE(err_.find("; "), std::string::npos) << "no way to mend it: " << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  }

  std::filesystem::path folder_;
  std::string out_, err_;
};

}  // namespace vielto_test

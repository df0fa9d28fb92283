// SPDX-License-Identifier: GPL-2.0-or-later
// A temporary folder laid out as gap/ (effects and settings beside the library) and `vielto gap` run in it.
#pragma once

#include "tests/cli/command_test.h"

namespace vielto_test {

class GapFolder : public CommandTest {
 protected:
  void SetUp() override {
    namespace fs = std::filesystem;
    fs::create_directories(folder_ / "library");
    for (const char* name : {"effects", "diagnosis.toml", "next_tests.toml"})
      fs::copy(fs::path(VIELTO_SOURCE_DIR) / "libraries" / name, folder_ / name, fs::copy_options::recursive);
  }

  int gap(const std::string& arguments) { return vielto("gap " + arguments); }
  // One line that says what is wrong and how to mend it.
  void expect_one_line(const std::string& part) const {
    EXPECT_EQ(err_.rfind("vielto: ", 0), 0u) << err_;
    EXPECT_NE(err_.find(part), std::string::npos) << "expected: " << part << "\ngot: " << err_;
    EXPECT_NE(err_.find("; "), std::string::npos) << "no way to mend it: " << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  }
};

}  // namespace vielto_test

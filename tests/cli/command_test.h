// SPDX-License-Identifier: GPL-2.0-or-later
// A temporary folder of one test, and programs run in it through their command line. vielto_test::content reads a file.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

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

class CommandTest : public testing::Test {
 protected:
  CommandTest() {
    std::string name = (std::filesystem::temp_directory_path() / "vielto-test-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~CommandTest() override { std::filesystem::remove_all(folder_); }

  // Exit status of a shell command in the folder.
  int run(const std::string& command) {
    const std::string streams = " > out.txt 2> err.txt";
    const int status = std::system(("cd '" + folder_.string() + "' && " + command + streams).c_str());
    out_ = content(folder_ / "out.txt");
    err_ = content(folder_ / "err.txt");
    return WEXITSTATUS(status);
  }
  int vielto(const std::string& arguments) { return run("'" VIELTO_BIN_DIR "/vielto' " + arguments); }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  std::filesystem::path folder_;
  std::string out_, err_;  // of the last command
};

}  // namespace vielto_test

// SPDX-License-Identifier: GPL-2.0-or-later
// Largest resident memory of a run of `vielto`, for tests that it does not grow with the input.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

namespace vielto_test {

// MB; the words are those after `vielto`. Its tables are thrown away; it has to end well.
inline double memory_of(std::vector<std::string> words) {
  std::string program = VIELTO_BIN_DIR "/vielto";
  std::vector<char*> arguments = {program.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    if (!std::freopen("/dev/null", "w", stdout)) _exit(99);
    execv(program.c_str(), arguments.data());
    _exit(98);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace vielto_test

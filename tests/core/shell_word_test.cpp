// SPDX-License-Identifier: GPL-2.0-or-later
// A word for a shell: what the shell itself makes of it is the word again.
#include "core/shell_word.h"

#include <gtest/gtest.h>
#include <stdio.h>

#include <string>

namespace {

std::string read_back(const std::string& word) {
  FILE* const shell = popen(("printf %s " + vielto::shell_word(word)).c_str(), "r");
  std::string text;
  for (int c; (c = fgetc(shell)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(pclose(shell), 0) << word;
  return text;
}

TEST(ShellWord, IsReadBackByAShell) {
  for (const std::string word : {"", "two words", "it's", "'", "$HOME", "`id`", "a;b", "a\\b", "\"x\"", "a\nb", "*",
                                 "~", "Mischer Größe 2/drum.stl", "#1", "!"})
    EXPECT_EQ(read_back(word), word);
}

TEST(ShellWord, LeavesAPlainOneAsItIs) {
  for (const std::string word : {"-var", "results/a_1.5", "slow=0.5", "materials/über.par", "1e-3,+2"})
    EXPECT_EQ(vielto::shell_word(word), word);
}

}  // namespace

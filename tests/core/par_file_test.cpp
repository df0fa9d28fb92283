// SPDX-License-Identifier: GPL-2.0-or-later
// Ranges of parameters: what each form lets through, what it asks for instead; and the parameter files of the rigs,
// each line of which has one.
#include "core/par_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/par_range.h"

using vielto::ParFile;
using vielto::ParRange;
namespace fs = std::filesystem;

namespace {

// What is asked for instead, or "good". Other parameters: a = 2, b = 30, in m.
std::string asked(const std::string& range, const std::string& value) {
  const auto lookup = [](const std::string& name) -> std::optional<double> {
    if (name == "a") return 2.0;
    if (name == "b") return 30.0;
    return std::nullopt;
  };
  return ParRange::parse(range).refusal(value, "m", lookup).value_or("good");
}

std::string fault_of(const std::string& text) {
  const fs::path path = fs::temp_directory_path() / ("par_file_test_" + std::to_string(::getpid()) + ".par");
  std::ofstream(path) << text;
  std::string fault = "accepted";
  try {
    ParFile::read(path.string());
  } catch (const vielto::BadInput& e) {
    fault = e.what();
  }
  fs::remove(path);
  return fault;
}

}  // namespace

TEST(ParRange, HoldsItsEndsAsTheyAreWritten) {
  EXPECT_EQ(asked("0 to 0.5", "0"), "good");
  EXPECT_EQ(asked("0 to 0.5", "0.5"), "good");
  EXPECT_EQ(asked("0 to 0.5", "0.50001"), "0 to 0.5");
  EXPECT_EQ(asked("> 0 to 0.05", "0"), "> 0 and at most 0.05");
  EXPECT_EQ(asked("> 0 to 0.05", "0.05"), "good");
  EXPECT_EQ(asked("0 to < 90", "90"), ">= 0 and < 90");
  EXPECT_EQ(asked("0 to < 90", "89.9"), "good");
  EXPECT_EQ(asked("> 0", "0"), "> 0");
  EXPECT_EQ(asked(">= 0", "0"), "good");
  EXPECT_EQ(asked(">= 0", "-1e-9"), ">= 0");
}

TEST(ParRange, OfWholeNumbersAndWords) {
  EXPECT_EQ(asked("whole 1 to 1000", "1.5"), "a whole number from 1 to 1000");
  EXPECT_EQ(asked("whole >= 3", "2"), "a whole number >= 3");
  EXPECT_EQ(asked("whole >= 3", "3"), "good");
  EXPECT_EQ(asked("plain, rough or mixed", "rough"), "good");
  EXPECT_EQ(asked("plain, rough or mixed", "rou"), "plain, rough or mixed");
  EXPECT_EQ(asked("-", "any text"), "good");
}

TEST(ParRange, NamesTheBoundThatHolds) {
  EXPECT_EQ(asked("> 0 to 0.5 a, 0.1 b", "0.9"), "good");
  EXPECT_EQ(asked("> 0 to 0.5 a, 0.1 b", "1.1"), "> 0 and at most 0.5 a (1 m)");
  EXPECT_EQ(asked("> 0 to b", "31"), "> 0 and at most b (30 m)");
  EXPECT_EQ(asked("0.9 a to 1.1 a", "1.7"), "0.9 a (1.8 m) to 1.1 a (2.2 m)");
  EXPECT_EQ(asked("> 0 to unknown", "1e9"), "good");  // nothing to hold it against
}

TEST(ParRange, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "fast", "0,27", "5%", "nan", "inf", "1e400", "0x10", "1 ", "1e"})
    EXPECT_NE(asked("any", text), "good") << text;
  EXPECT_EQ(asked("law", "0,27"), "a number (with a decimal point, m)");
  EXPECT_EQ(asked("any", "5%"), "a number (as a part of 1, m)");
  for (const char* text : {"1", "-1.5", "+2", "1e-3", ".5", "2E5"}) EXPECT_EQ(asked("any", text), "good") << text;
}

// An integer of steps, of rows or of grains made of such a number is none.
TEST(ParRange, RefusesNumbersOfNoPhysicalSize) {
  for (const char* text : {"1e308", "1e300", "-1e300", "1.1e15", "1e-300", "-9e-16"})
    EXPECT_EQ(asked("any", text), "a number from 1e-15 to 1e+15 in size (m)") << text;
  for (const char* text : {"1e15", "-1e15", "1e-15", "0", "-0"}) EXPECT_EQ(asked("any", text), "good") << text;
}

TEST(ParRange, RefusesWhatIsNoRange) {
  for (const char* text : {"0", "positive", "> x y", "0 to", "to 1", ">= 0 to 1", "0 to 1 2", "> 0 to ", "whole"})
    EXPECT_THROW(ParRange::parse(text), std::invalid_argument) << text;
}

TEST(ParFile, ReadsLinesWithAndWithoutARange) {
  const fs::path path = fs::temp_directory_path() / ("par_file_test_" + std::to_string(::getpid()) + ".par");
  std::ofstream(path) << "variable a index 1 # m | > 0 | 0.1 | a book | its page\n"
                         "variable b index 2 # s | - | assumption\n"
                         "variable c index on # off or on | - | a choice\n"
                         "variable d index 3\n";
  const ParFile file = ParFile::read(path.string());
  fs::remove(path);
  EXPECT_EQ(file.find("a").range, "> 0");
  EXPECT_EQ(file.find("a").u, "0.1");
  EXPECT_EQ(file.find("a").source, "a book");
  EXPECT_EQ(file.find("b").unit, "s");
  EXPECT_EQ(file.find("b").range, "");
  EXPECT_EQ(file.find("b").source, "assumption");
  EXPECT_EQ(file.find("c").range, "off or on");
  EXPECT_EQ(file.find("d").unit, "");
}

TEST(ParFile, RefusesARangeThatIsNone) {
  const std::string fault = fault_of("# card\nvariable a index 1 # m | positive | - | a book\n");
  EXPECT_NE(fault.find("line 2"), std::string::npos) << fault;
  EXPECT_NE(fault.find("'positive' is no range of 'a'"), std::string::npos) << fault;
}

// The rigs' own values lie in their ranges, and every bound names a parameter of the same files (or of the mesh).
TEST(RigsParameters, HaveRangesThatHoldTheirValues) {
  const fs::path cases = VIELTO_SOURCE_DIR "/cases";
  int files = 0;
  for (const auto& entry : fs::directory_iterator(cases)) {
    const fs::path path = entry.path() / (entry.path().filename().string() + ".par");
    if (!fs::exists(path)) continue;
    ++files;
    const ParFile file = ParFile::read(path.string());
    const auto lookup = [&](const std::string& name) -> std::optional<double> {
      return file.has(name) ? vielto::parameter_number(file.text(name)) : std::nullopt;
    };
    for (const vielto::Parameter& p : file.all()) {
      EXPECT_FALSE(p.range.empty()) << path << " " << p.name;
      const ParRange range = ParRange::parse(p.range);
      if (p.value == "card") continue;
      EXPECT_EQ(range.refusal(p.value, p.unit, lookup).value_or(""), "") << path << " " << p.name;
      for (const std::string& name : range.depends_on())
        EXPECT_TRUE(file.has(name) || name == "outlineVolume") << path << " " << name;
    }
  }
  EXPECT_GE(files, 4);
}

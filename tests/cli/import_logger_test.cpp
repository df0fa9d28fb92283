// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto import logger` through its command line: one signal of known mean as loggers write it, bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "tests/cli/command_test.h"

namespace {

namespace fs = std::filesystem;
const double pi = std::acos(-1.0);

// 10 Hz for two minutes: a start-up of 3 s, then 1200 W with a ripple and noise. Written with two decimals.
double start_up(int i) { return 800 * std::exp(-0.1 * i / 3); }
std::vector<double> signal(double mean, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 20);
  std::vector<double> values;
  for (int i = 0; i < 1200; ++i)
    values.push_back(std::round(100 * (mean + start_up(i) + 30 * std::sin(2 * pi * 0.13 * i) + noise(random))) / 100);
  return values;
}

std::string text_of(double value, char point, int digits = 2) {
  std::ostringstream out;
  out.setf(std::ios::fixed);
  out.precision(digits);
  out << value;
  std::string text = out.str();
  std::replace(text.begin(), text.end(), '.', point);
  return text;
}

std::string two(int n) { return (n < 10 ? "0" : "") + std::to_string(n); }

class ImportLogger : public vielto_test::CommandTest {
 protected:
  int import(const std::string& options) { return vielto("import logger " + options + " --test t --out o.csv"); }
  std::vector<vielto::Observation> rows(const std::string& options) {
    const int status = import(options);
    EXPECT_EQ(status, 0) << err_;
    return status == 0 ? vielto::read_observations((folder_ / "o.csv").string()) : std::vector<vielto::Observation>(1);
  }
  // One line, exit status 2, no table and no part of one.
  std::string refusal(const std::string& options) {
    EXPECT_EQ(import(options), 2) << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
    EXPECT_EQ(out_, "");
    EXPECT_FALSE(fs::exists(folder_ / "o.csv"));
    return err_;
  }
  // Rows of the record, each from its number and value.
  std::string lines(const std::function<std::string(int, double)>& row) const {
    std::string text;
    for (std::size_t i = 0; i < values_.size(); ++i) text += row(static_cast<int>(i), values_[i]) + "\n";
    return text;
  }
  std::string plain(char mark = '\t') const {
    return std::string("t") + mark + "P\n" +
           lines([mark](int i, double v) { return text_of(0.1 * i, '.') + mark + text_of(v, '.'); });
  }

  std::vector<double> values_ = signal(1200, 1);
};

// The mean within four of its own standard uncertainties; the start-up, 800 W at first, would move the whole mean
// by 20.
TEST_F(ImportLogger, MeanOfTheSteadyPart) {
  write("a.txt", plain());
  const auto row = rows("a.txt --value-column P --time-column t").at(0);
  EXPECT_EQ(row.observable, "power_loaded");
  EXPECT_NEAR(row.value, 1200, 4 * row.u);
  EXPECT_GT(row.u, 0.1);
  EXPECT_LT(row.u, 3);
  EXPECT_TRUE(fs::exists(folder_ / "o.a.png"));
}

// The same samples in other dress give the same numbers; a bound for the rounding of clock times to milliseconds.
TEST_F(ImportLogger, WhateverTheLoggerWrites) {
  write("a.txt", plain());
  const auto expected = rows("a.txt --value-column P --time-column t").at(0);
  const auto same = [&](const std::string& text, const std::string& options, double tolerance = 1e-9) {
    write("b.csv", text);
    const auto row = rows("b.csv " + options).at(0);
    EXPECT_NEAR(row.value / expected.value, 1, tolerance) << options << text.substr(0, 200);
    EXPECT_NEAR(row.u / expected.u, 1, 1e3 * tolerance) << options;
  };
  same("t;P\r\n" + lines([](int i, double v) { return text_of(0.1 * i, ',') + ";" + text_of(v, ',') + "\r"; }),
       "--value-column P --time-column t");
  same("\xEF\xBB\xBF\"t\",\"P total\"\n" +
           lines([](int i, double v) { return "\"" + text_of(0.1 * i, ',') + "\",\"" + text_of(v, ',') + "\""; }),
       "--value-column 'P total' --time-column t");
  // preamble, units, another column that is no number, Latin-1, kW, milliseconds
  same("Analyser;\xB0\x43\nSerial;12345\n\nTime;P;Status\nms;kW;-\n" +
           lines([](int i, double v) { return std::to_string(100 * i) + ";" + text_of(v / 1000, '.', 5) + ";ok"; }),
       "--value-column P --time-column Time --time-factor 0.001 --unit kW", 1e-8);
  // a clock that passes midnight without a date, and one with; day first, month first, and ISO
  const auto clock = [](int i, char point) {
    const int ms = (86400 - 60) * 1000 + 100 * i, s = ms / 1000 % 86400;
    return two(s / 3600) + ":" + two(s / 60 % 60) + ":" + two(s % 60) + point + std::to_string(ms / 100 % 10);
  };
  same("Zeit;P\n" + lines([&](int i, double v) { return clock(i, ',') + ";" + text_of(v, ','); }),
       "--value-column P --time-column Zeit", 1e-8);
  const auto day = [](int i) { return i < 600 ? 28 : 29; };
  same("T,P\n" + lines([&](int i, double v) {
         return "2024-02-" + two(day(i)) + "T" + clock(i, '.') + "Z," + text_of(v, '.');
       }),
       "--value-column P --time-column T", 1e-8);
  same("T;P\n" +
           lines([&](int i, double v) { return two(day(i)) + ".02.2024 " + clock(i, '.') + ";" + text_of(v, '.'); }),
       "--value-column P --time-column T", 1e-8);
  same("T,P\n" + lines([&](int i, double v) {
         const std::string c = clock(i, '.');
         const bool late = i < 600;
         return "2/" + two(day(i)) + "/2024 " + (late ? "11" : "12") + c.substr(2) + (late ? " PM," : " AM,") +
                text_of(v, '.');
       }),
       "--value-column P --time-column T", 1e-8);
  // no time at all
  same("P\n" + lines([](int, double v) { return text_of(v, '.'); }), "--value-column P --interval 0.1");
}

// P = 2 pi n T; --factor turns the sign.
TEST_F(ImportLogger, TorqueBecomesPower) {
  write("a.txt", plain());
  const double watts = rows("a.txt --value-column P --time-column t").at(0).value;
  EXPECT_NEAR(rows("a.txt --value-column P --time-column t --unit Nm --speed 0.8").at(0).value, watts * 2 * pi * 0.8,
              1e-6 * watts);
  for (double& v : values_) v = -v;
  write("a.txt", plain());
  EXPECT_NEAR(rows("a.txt --value-column P --time-column t --unit kNm --speed 0.8 --factor -1").at(0).value,
              1000 * watts * 2 * pi * 0.8, 1e-3 * watts);
}

TEST_F(ImportLogger, LoadedAndIdleShareTheInstrumentsError) {
  write("full.txt", plain());
  values_ = signal(300, 2);
  write("empty.txt", plain(';'));
  const auto both =
      rows("full.txt --idle empty.txt --value-column P --time-column t --accuracy 0.015 --speed 1 --fill 0.2");
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[1].observable, "power_idle");
  EXPECT_NEAR(both[1].value, 300, 10);
  EXPECT_GT(both[0].u, 0.015 * both[0].value);
  EXPECT_LT(both[0].u, 0.0152 * both[0].value);
  const auto shared = vielto::read_covariances((folder_ / "o.covariance.csv").string(), both);
  ASSERT_EQ(shared.size(), 1u);
  EXPECT_NEAR(shared[0].covariance, 0.015 * 0.015 * both[0].value * both[1].value, 1e-6 * both[0].value);
}

// A part asked for is taken as it is, without a search for the steady one.
TEST_F(ImportLogger, AveragesThePartAskedFor) {
  write("a.txt", plain());
  double sum = 0;
  for (int i = 200; i < 400; ++i) sum += values_[static_cast<std::size_t>(i)];
  EXPECT_NEAR(rows("a.txt --value-column P --time-column t --from 20 --to 39.95").at(0).value, sum / 200, 1e-9);
}

// One sample of 10 kW among some 1200 moves the mean of 1200 W by 7 W, one of 10^6 W by 70 %: the second is named.
TEST_F(ImportLogger, ASampleThatAloneMovesTheMeanIsNamed) {
  values_[800] = 10000;
  write("a.txt", plain());
  EXPECT_EQ(import("a.txt --value-column P --time-column t"), 0) << err_;
  EXPECT_EQ(out_.find("alone moves"), std::string::npos);
  values_[800] = 1e6;
  write("a.txt", plain());
  for (const char* part : {"", " --from 20 --to 119"}) {
    EXPECT_EQ(import("a.txt --value-column P --time-column t" + std::string(part)), 0) << err_;
    EXPECT_NE(out_.find("note: line 802, 1e+06, alone moves the mean from 12"), std::string::npos) << out_;
  }
}

// VTK ends the program where no X server answers.
TEST_F(ImportLogger, WithoutADisplayTheTableIsWritten) {
  write("a.txt", plain());
  const std::string options = " --test t --out o.csv a.txt --value-column P --time-column t";
  for (const std::string display : {"env -u DISPLAY ", "DISPLAY=:98765 "}) {
    EXPECT_EQ(run(display + VIELTO_BIN_DIR "/vielto import logger" + options), 0) << err_;
    EXPECT_EQ(vielto::read_observations((folder_ / "o.csv").string()).size(), 1u);
    EXPECT_FALSE(fs::exists(folder_ / "o.a.png"));
    fs::remove(folder_ / "o.csv");
  }
}

TEST_F(ImportLogger, BadInputIsOneLine) {
  for (const char* time :
       {"10:-5", "10:+5:00", "99999999999:00", "1-2-99999999999 10:00", "-2147483648-1-1 10:00", "10:", ":10"}) {
    write("clock.txt", "t\tP\n10:00:00\t1\n" + std::string(time) + "\t1\n");
    EXPECT_NE(refusal("clock.txt --value-column P --time-column t").find("clock.txt, line 3, column t"),
              std::string::npos)
        << time;
  }
  std::string wide = "\xFF\xFE";  // UTF-16, as a spreadsheet's "Unicode text" is
  for (const char c : plain()) wide += {c, '\0'};
  write("wide.txt", wide);
  EXPECT_NE(refusal("wide.txt --value-column P --time-column t")
                .find("wide.txt, line 1: is no text; export the record as text (CSV, UTF-8)"),
            std::string::npos);
  write("short.txt", plain());
  EXPECT_NE(refusal("short.txt --value-column P --time-column t --from 1 --to 1e12").find("ends at 119.9 s"),
            std::string::npos);
  const std::string options = " --value-column P --time-column t";
  EXPECT_NE(refusal("none.txt" + options).find("none.txt: cannot be read"), std::string::npos);
  write("a.txt", plain());
  EXPECT_NE(refusal("a.txt --value-column Power --time-column t").find("has no line of names with the column 'Power'"),
            std::string::npos);
  EXPECT_NE(
      refusal("a.txt --value-column P --time-column Time").find("line 1: has no column 'Time'; choose from t | P"),
      std::string::npos);
  EXPECT_NE(refusal("a.txt --value-column P").find("give --time-column, or --interval"), std::string::npos);
  EXPECT_NE(refusal("a.txt --unit Nm" + options).find("no speed is given"), std::string::npos);
  EXPECT_NE(refusal("a.txt --factor -1" + options).find("column P: has the mean -1"), std::string::npos);
  EXPECT_NE(refusal("a.txt --from 3" + options).find("--from and --to go together"), std::string::npos);
  EXPECT_NE(refusal("a.txt --from 3 --to 4" + options).find("has 11 samples"), std::string::npos);
  EXPECT_NE(refusal("a.txt --idle a.txt" + options).find("no more than the idling record's"), std::string::npos);
  const std::string good = plain();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    write("a.txt", text);
    return refusal("a.txt" + options);
  };
  const std::string row = "\n50.00\t";
  EXPECT_NE(changed(row, row + "12..3 ").find("line 502, column P"), std::string::npos);
  EXPECT_NE(changed(row, "\n49.00\t").find("column t: goes back by 0.9 s"), std::string::npos);
  EXPECT_NE(changed(row, "\nnoon\t").find("column t: 'noon' is no time"), std::string::npos);
  const std::size_t begin = good.find(row), end = good.find("\n60.00\t");
  write("a.txt", good.substr(0, begin) + good.substr(end));
  EXPECT_NE(refusal("a.txt" + options).find("comes 10.1 s after line 501, 101 sampling intervals"), std::string::npos);
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += static_cast<double>(i);
  write("a.txt", plain());
  EXPECT_NE(refusal("a.txt" + options).find("column P: "), std::string::npos);
}

}  // namespace

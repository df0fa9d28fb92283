// SPDX-License-Identifier: GPL-2.0-or-later
// A signal over time as data loggers and power analysers write it -> its mean over the steady part.
//
// Text: any lines, then the line of column names, in which the column asked for stands; perhaps a line of units; then
// rows. Columns are divided by tabs, semicolons or commas, whichever gives that column; fields may be in quotes.
// Numbers have decimal points, or decimal commas where commas divide nothing; empty fields of the signal are samples
// that the logger missed and are left out. Text that is not UTF-8 is taken byte for byte. Time: seconds (times a
// factor), or clock times with or without a date (10:00:03,2; 2024-05-01 10:00:03.200; 01.05.2024 10:00:03; 5/1/2024
// 10:00:03 PM), past midnight too. Rows of one time, from a clock coarser than the sampling, are one sample, their
// mean.
//
// Mean: samples are put on an even grid by linear interpolation, so that a lost sample weighs nothing; the steady part
// is found on kBlocks block means (steady_part.h), the uncertainty is that of an autocorrelated mean
// (mean_uncertainty.h). A sample that alone moves the mean is named.
//
// Errors: BadInput with file, line and column for no such column, a field that is no number or time, times that do not
// rise, a gap of over kWidestGap sampling intervals in the part asked for, a part that reaches over the record's end,
// too few samples, no steady part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mean_uncertainty.h"

namespace vielto {

constexpr int kBlocks = 40;
constexpr double kWidestGap = 5;  // sampling intervals

struct LoggerColumns {
  std::string value, time;         // names; no time: rows are `interval` apart
  double interval = 0;             // s
  double time_factor = 1;          // times a number in the time column is s
  std::optional<double> from, to;  // s after the first row: the part to average; default: what is steady
};

struct LoggerRecord {
  std::string path;
  std::vector<double> time, value;  // s after the first row, unit of the column
  std::vector<int> lines;           // of the file
};

struct LoggerMean {
  MeanUncertainty mean;     // unit of the column
  double from = 0, to = 0;  // s, of the part averaged
  double interval = 0;      // s, median of the sampling
  std::string lone;         // the line of a sample that alone moves the mean, in words; empty if there is none
};

LoggerRecord read_logger(const std::string& path, const LoggerColumns& columns);
LoggerMean logger_mean(const LoggerRecord& record, const LoggerColumns& columns);

// The record and what was averaged of it, as a PNG. Errors: std::runtime_error if it cannot be written.
void draw_logger(const LoggerRecord& record, const LoggerMean& mean, const std::string& quantity,
                 const std::string& path);

}  // namespace vielto

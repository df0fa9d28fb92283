// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: the mixer powers of observation tables of any length, in bounded memory: read once, checked as any table,
// and kept as numbers in a temporary file (112 bytes a row) that every pass of a fit reads again. A sample of the rows
// stays in memory.
#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "equation/power_equation.h"

namespace vielto {

// Above this, `vielto fit` streams (the residuals of every row in memory and in the JSON would be in the way).
constexpr int kMostRowsInMemory = 20000;

// True if the tables hold more rows than that and none has a covariance file: correlated rows are fitted in memory.
bool are_long(const std::vector<std::string>& tables);

class PowerStream {
 public:
  struct Row {
    double check = 0;                          // 1: of role `check`
    double power = 0, u = 0, booklet = 0;      // W; booklet: power after its equation
    double scale_n_pc = 0, scale_n_p = 0;      // power over N_PC and N_P, W
    std::array<double, kGroupCount> groups{};  // not a number where it is not known
  };

  // Errors: BadInput as of power_data and for_each_test.
  PowerStream(const std::vector<std::string>& tables, const std::vector<MixerDimensions>& mixers,
              const std::vector<BulkMaterial>& materials);

  // Errors: std::runtime_error if the temporary file cannot be read.
  void for_each(const std::function<void(const Row&)>& use) const;

  PowerData sample;  // every `stride`-th row of role `fit`, at most kMostRowsInMemory; rows of role `check` too
  long rows = 0;     // of role `fit`
  std::array<std::optional<FittedRange>, kGroupCount> group_range;  // over all of them
  FittedRange lever;
  bool provisional = false;

 private:
  void add(const PowerRow& row);
  struct Close {
    void operator()(FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<FILE, Close> file_;
  long stride_ = 1;
};

}  // namespace vielto

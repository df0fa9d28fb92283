// SPDX-License-Identifier: GPL-2.0-or-later
// What the records of all rigs state of their run, and what their results have in common: the head of the result file,
// and the table for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/record_file.h"

namespace vielto {

struct RunHeader {
  double grain_diameter = 0;  // m
  double youngs_modulus = 0;  // Pa
  double dt_over_tc = 0;      // 1, of the stiffest mode
  std::string seed, material, wall;
  bool provisional = false;  // the material's card is not calibrated yet
};

// Errors: BadInput as Keys, and for another schema than 1.
void read_run_header(const Keys& keys, RunHeader& header);

// schema, rig, material, provisional, wall, seed.
nlohmann::ordered_json head_of_result(const std::string& rig, const RunHeader& header);

// "hulled_millet (provisional)"
std::string material_text(const std::string& material, bool provisional);

// Aligned lines: name, value, standard uncertainty, unit; below them, what is held against a limit.
class ResultTable {
 public:
  explicit ResultTable(const std::vector<std::string>& warnings = {}, int name_width = 44);

  void text(const std::string& line);
  void heading(const std::string& name);
  void line(const std::string& name, double value, const std::string& unit);
  void line(const std::string& name, double value, double u, const std::string& unit);
  void limits_heading();
  void limit(const std::string& name, double value, const std::string& limit);
  void time_step(const RunHeader& header);  // as a line with its limit

  const std::string& written() const { return text_; }

 private:
  void row(const std::string& name, double value, const std::string& u, const std::string& unit);

  std::string text_;
  int width_;
};

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Each rig against its reference file, cases/RIG/reference.csv: the numbers of eight seeds or more of a coarse run
// (scripts/reference, settings in cases/rigs.toml). Seed 9, which is none of them, run here through the
// rig's command line, must lie where one more draw of the same lot lies: mean +- t s sqrt(1 + 1/n), t Student's
// quantile for one number out of them all being outside once in a hundred times. Not bit by bit: a change of
// round-off leads to another bed, and to another draw.
#include <nlohmann/json.hpp>

#include "core/mean_uncertainty.h"
#include "core/toml_table.h"
#include "rig_runner.h"

using namespace vielto_test;

namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> table(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line, cell; std::getline(in, line);) {
    std::vector<std::string> cells;
    for (std::istringstream fields(line + ","); std::getline(fields, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    rows.emplace_back();
    for (std::size_t k = 0; k < names.size() && k < cells.size(); k++) rows.back()[names[k]] = cells[k];
  }
  return rows;
}

struct Case {
  std::string name, rig, result, settings;
  std::size_t numbers = 0;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

// Every case of every rig that keeps a reference.
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto table = vielto::TomlTable::read(VIELTO_SOURCE_DIR "/cases/rigs.toml");
  for (const std::string& rig : table.keys()) {
    const auto stated = table.table(rig);
    if (!stated.has("reference")) continue;
    const auto listed = stated.table("reference").table("cases");
    for (const std::string& name : listed.keys()) {
      Case one{name, rig, stated.text("result"), "", stated.table("reference").texts("numbers").size()};
      const auto settings = listed.table(name);
      for (const std::string& var : settings.keys())
        one.settings += fmt::format("-var {} {} ", var, settings.text(var));
      all.push_back(one);
    }
  }
  return all;
}

std::size_t count_of_numbers() {
  std::size_t count = 0;
  for (const Case& one : cases()) count += one.numbers;
  return count;
}

class RigReference : public testing::TestWithParam<Case> {};

}  // namespace

TEST_P(RigReference, AnotherSeedIsOneMoreDraw) {
  const std::string source = VIELTO_SOURCE_DIR;
  const int seed = 9;
  const std::string& options = GetParam().settings;
  Rig rig(GetParam().rig);
  rig.must("run", options, fmt::format("-var seed {}", seed));
  const Outcome done = rig.vielto("post run");
  ASSERT_EQ(done.status, 0) << done.text;
  auto told = nlohmann::json::parse(rig.read("run/post/" + GetParam().result));
  if (told.contains("quality")) told.update(nlohmann::json(told["quality"]));

  std::map<std::string, std::vector<double>> numbers;
  for (const Row& row : table(source + "/cases/" + GetParam().rig + "/reference.csv"))
    if (row.at("case") == GetParam().name) {
      EXPECT_NE(std::stoi(row.at("seed")), seed);
      for (const auto& [name, value] : row)
        if (name != "case" && name != "seed") numbers[name].push_back(std::stod(value));
    }
  ASSERT_FALSE(numbers.empty());
  for (const auto& [name, values] : numbers) {
    const auto n = static_cast<double>(values.size());
    ASSERT_GE(n, 8) << name;
    double mean = 0, squares = 0;
    for (const double v : values) mean += v / n;
    for (const double v : values) squares += (v - mean) * (v - mean);
    const double sd = std::sqrt(squares / (n - 1));
    EXPECT_GT(sd, 0) << name;
    const double t = vielto::student_quantile(1 - 0.01 / static_cast<double>(count_of_numbers()) / 2, n - 1);
    const double value = told[name];
    const double band = t * sd * std::sqrt(1 + 1 / n);
    EXPECT_NEAR(value, mean, band) << name;
    // the seeds must scatter little enough for the test to see a rig that shows nothing, or twice as much
    EXPECT_LT(band, 0.8 * std::fabs(mean)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Rigs, RigReference, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

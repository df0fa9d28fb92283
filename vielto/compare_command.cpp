// SPDX-License-Identifier: GPL-2.0-or-later
// vielto compare A B: two observation tables side by side.
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "commands.h"
#include "core/csv.h"
#include "equation/comparison.h"

namespace vielto {
namespace {

struct CompareOptions {
  std::string a, b, out;
  std::vector<std::string> ignored;
  bool json = false;
};

std::string comparison_json(const Comparison& comparison) {
  nlohmann::json result = {{"schema", 1},
                           {"pairs", nlohmann::json::array()},
                           {"summary", nlohmann::json::array()},
                           {"chi2", comparison.chi2 ? nlohmann::json(*comparison.chi2) : nlohmann::json()},
                           {"only_a", comparison.only_a},
                           {"only_b", comparison.only_b}};
  if (comparison.chi2) result["chi2_exceedance"] = comparison.chi2_exceedance;
  for (const ComparedPair& p : comparison.pairs)
    result["pairs"].push_back({{"test_a", p.a.test},
                               {"test_b", p.b.test},
                               {"apparatus", p.a.apparatus},
                               {"observable", p.a.observable},
                               {"unit", p.a.unit},
                               {"rows_a", p.rows_a},
                               {"rows_b", p.rows_b},
                               {"value_a", p.a.value},
                               {"u_a", p.a.u},
                               {"value_b", p.b.value},
                               {"u_b", p.b.u},
                               {"relative_gap", p.gap},
                               {"z", p.z}});
  for (const GapSummary& s : comparison.summaries)
    result["summary"].push_back({{"apparatus", s.apparatus},
                                 {"observable", s.observable},
                                 {"pairs", s.pairs},
                                 {"mean_gap", s.mean_gap},
                                 {"rms_gap", s.rms_gap},
                                 {"max_gap", s.max_gap},
                                 {"mean_z", s.mean_z},
                                 {"max_z", s.max_z}});
  return result.dump(2) + "\n";
}

void compare_tables(const CompareOptions& o) {
  const ReducedTable a = read_reduced_table(o.a), b = read_reduced_table(o.b);
  const Comparison comparison = compare(a, b, {o.ignored.begin(), o.ignored.end()});
  if (!o.out.empty()) write_whole_file(o.out, comparison_csv(comparison));
  std::fputs((o.json ? comparison_json(comparison) : comparison_text(comparison)).c_str(), stdout);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto o = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand(
      "compare",
      "two observation tables side by side: relative gap B/A - 1, z = (B - A)/u, chi2 with both covariances\n"
      "Rows are paired by apparatus, observable and conditions, not by the names of their tests. The covariance of a "
      "table\n"
      "is read from TABLE.covariance.csv or covariance.csv beside it. power_loaded and power_idle are compared as "
      "power.\n"
      "Example: vielto compare measured.csv simulated.csv --ignore moisture,wall");
  add_rigs_option(command);
  command->add_option("A", o->a, "observation table, the observed one")->required();
  command->add_option("B", o->b, "observation table, the simulated one")->required();
  command->add_option("--ignore", o->ignored, "conditions that need not agree, such as moisture,wall")->delimiter(',');
  command->add_flag("--json", o->json, "print JSON instead of tables");
  command->add_option("--out", o->out, "also write the pairs as CSV");
  command->callback([o] { compare_tables(*o); });
}

}  // namespace vielto

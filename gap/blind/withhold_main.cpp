// SPDX-License-Identifier: GPL-2.0-or-later
// gap-withhold: makes the withheld cases of a blind check (withhold.h).
#include <fmt/format.h>

#include "gap/blind/program.h"
#include "gap/blind/withhold.h"

int main(int argc, char** argv) {
  CLI::App app{"withheld cases from response libraries of other laws, truths sealed", "gap-withhold"};
  vielto::gap::WithholdRequest r;
  app.add_option("--library", r.library.library, "the diagnoser's response library")->required();
  app.add_option("--effects", r.library.effects, "the diagnoser's effects; without it effects/ beside the library");
  app.add_option("--settings", r.library.settings, "without it diagnosis.toml beside the library");
  app.add_option("--truth", r.truths, "response library of another law, a base truth (repeatable)")->required();
  app.add_option("--truth-effects", r.truth_effects, "effects of the truths, where they are other mechanisms");
  app.add_option("--tests", r.tests, "observation table: conditions, roles and u of the rows (values are not used)")
      ->required();
  auto* sealed = app.add_option("--sealed", r.isolability, "isolability.json of those tests");
  app.add_option("--reference", r.reference, "cases are of a change against this table of the base truth");
  bool draws_reference = false;
  app.add_flag("--draw-reference", draws_reference, "write one table of the base truth without an effect to --out")
      ->excludes(sealed);
  app.add_option("--plan", r.plan, "how many cases of which kind (tests/data/toy_plan.toml)")->required();
  app.add_option("--ignore", r.ignored, "conditions that need not agree with the libraries")->delimiter(',');
  app.add_option("--seed", r.seed, "of all draws")->capture_default_str();
  app.add_option("--out", r.out, "folder to make")->required();
  return vielto::gap::run_program(app, argc, argv, [&] {
    if (draws_reference) return vielto::gap::draw_reference(r);
    if (r.isolability.empty())
      throw vielto::BadInput("--sealed", 0, "is missing", "seal the tests first: vielto gap isolability");
    const auto made = vielto::gap::withhold(r);
    fmt::print("{} cases, {} unreachable\n", made.cases, made.unreachable);
  });
}

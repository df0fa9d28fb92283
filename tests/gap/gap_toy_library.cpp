// SPDX-License-Identifier: GPL-2.0-or-later
// gap_toy_library FOLDER TRUTHS: a toy response library in FOLDER/libraries/millet, TRUTHS other toy laws in
// FOLDER/truth/N, the toy's tests in FOLDER/tests.csv. For the blind check on formulas instead of simulations
// (gap_toy_blind.sh).
#include <cstdio>
#include <cstdlib>

#include "gap_toy.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: gap_toy_library FOLDER TRUTHS\n", stderr), 2;
  const toy::fs::path folder(argv[1]);
  toy::write_library(folder / "libraries" / "millet", toy::effects_with_runs(), 0, 7);
  toy::write_discrepancy(folder / "libraries" / "millet");
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (int t = 0; t < std::atoi(argv[2]); ++t)
    toy::write_library(folder / "truth" / fmt::format("{}", t), toy::effects_with_runs(), normal(random),
                       100 + static_cast<unsigned>(t), false);
  vielto::write_observations((folder / "tests.csv").string(), toy::measured({}, random));
}

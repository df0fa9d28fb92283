// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/test_design.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("next_tests.toml") {
  for (const auto& test : vielto::gap::read_candidate_tests(path)) vielto::gap::candidate_table(path, test, "", "");
  vielto::gap::read_state_test(path, "reference");
}

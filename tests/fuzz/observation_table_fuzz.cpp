// SPDX-License-Identifier: GPL-2.0-or-later
// What is read is written and read back the same, test by test too.
#include "core/observation_table.h"
#include "tests/fuzz/harness.h"

using namespace vielto_fuzz;

VIELTO_FUZZ("table.csv") {
  const auto rows = vielto::read_observations(path);
  const std::string again = folder().file("again.csv");
  vielto::write_observations(again, rows);
  const auto copy = vielto::read_observations(again);
  demand(copy.size() == rows.size(), "a row is lost");
  for (std::size_t i = 0; i < rows.size(); ++i)
    demand(copy[i].test == rows[i].test && copy[i].value == rows[i].value && copy[i].u == rows[i].u &&
               copy[i].speed == rows[i].speed && copy[i].material == rows[i].material,
           "a row reads back otherwise");
  std::size_t count = 0;
  vielto::for_each_test(path, [&](const auto& test) { count += test.size(); });
  demand(count == rows.size(), "a row is lost test by test");
}

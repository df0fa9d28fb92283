// SPDX-License-Identifier: GPL-2.0-or-later
// Time in a column t, value in P, and the same with rows a tenth of a second apart.
#include "import/logger_record.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("record.csv") {
  for (const char* time : {"t", ""}) {
    vielto::LoggerColumns columns;
    columns.value = "P";
    columns.time = time;
    columns.interval = 0.1;
    try {
      const vielto::LoggerRecord record = vielto::read_logger(path, columns);
      vielto::logger_mean(record, columns);
      columns.from = 1;
      columns.to = 20;
      vielto::logger_mean(record, columns);
    } catch (const vielto::BadInput& refusal) {
      vielto_fuzz::demand(vielto::is_plain_utf8(refusal.what()), "the refusal is not one line of plain text");
    }
  }
}

// SPDX-License-Identifier: GPL-2.0-or-later
// A JSON file of a result folder as the report shows it.
#include "report/file_pages.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("result.json") {
  vielto::Page page;
  vielto::add_json(path, "result", page);
  vielto::page_html(page, false);
}

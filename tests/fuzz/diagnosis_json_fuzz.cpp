// SPDX-License-Identifier: GPL-2.0-or-later
#include <nlohmann/json.hpp>

#include "gap/library/rig.h"
#include "report/diagnosis_page.h"
#include "tests/fuzz/harness.h"

VIELTO_FUZZ("diagnosis.json") {
  const nlohmann::json j = vielto::gap::read_json(path);
  if (!vielto::gap::is_diagnosis(j)) return;
  vielto::Page page;
  vielto::gap::add_diagnosis(j, path, "diagnosis", page);
  vielto::page_html(page, false);
}

// SPDX-License-Identifier: GPL-2.0-or-later
// What a report says of one run folder of the mixer or of a machine of a user's own: numbers, limits, torque over time
// and over the phase of the turn, picture.
#pragma once

#include <optional>
#include <string>

#include "report/equation_pages.h"
#include "report/page.h"

namespace vielto {

struct RunOfReport {
  std::string folder, name;       // name: "" if the report is of this run alone
  std::string picture;            // PNG to show; empty: none
  std::vector<std::string> read;  // files that were used
};

// True if `folder` holds a torque record of the mixer or of a machine.
bool is_power_run(const std::string& folder);

// Adds a section; the point is empty for a machine, to which the published equation does not apply, for an idling run
// and for one without post/power.json (the summary says so). Errors: BadInput for files that break their format.
std::optional<PowerPoint> add_run(RunOfReport& run, bool alone, Page& page);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Any other CSV or JSON file of a result folder (observation tables, shear.csv, heap.csv, post/*.json): as tables, and
// numbers as plots.
#pragma once

#include <string>

#include "report/page.h"

namespace vielto {

// `name` is the file's name in the folder. `plot_powers`: mixer powers of an observation table are drawn too.
// Errors: BadInput for a file that is not what its name says.
void add_csv(const std::string& path, const std::string& name, bool plot_powers, Page& page);
void add_json(const std::string& path, const std::string& name, Page& page);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// A result folder as one HTML file, with every plot as SVG and its data as CSV beside it.
//
// A result folder is a run folder, a folder of run folders (a demo, a campaign), or any folder with observation tables,
// fits of `vielto fit --out`, other CSV or JSON files and pictures. Files that a run folder in it holds too are shown
// once. What is in `post` of the folder counts as being in it.
#pragma once

#include <string>
#include <vector>

namespace vielto {

struct ReportRequest {
  std::string folder;
  std::string out;                // folder of the report; it is made anew
  bool plots = true, svg = true;  // svg needs plots
};

// What a person should know, a line each.
// Errors: BadInput for a folder with nothing to report, a file that breaks its format, an `out` that is something else
// than a report, or a plotting library or node that is not there; then nothing is written.
std::vector<std::string> write_report(const ReportRequest& request);

}  // namespace vielto

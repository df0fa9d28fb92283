// SPDX-License-Identifier: GPL-2.0-or-later
// vielto report FOLDER: one self-contained HTML file of a result folder, with its plots as SVG and CSV beside it.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "report/report.h"

namespace vielto {

void add_report_command(CLI::App& app) {
  auto o = std::make_shared<ReportRequest>();
  CLI::App* command = app.add_subcommand(
      "report",
      "a result folder as one HTML file that opens offline: summary, tables, interactive plots, pictures, provenance\n"
      "FOLDER is a run folder, a folder of run folders, or any folder with observation tables, fits (`vielto fit "
      "--out`)\n"
      "and other CSV or JSON files. Every plot also as SVG, its data as CSV. Pictures of the rig need a display.\n"
      "Example: xvfb-run -a vielto report results/demo");
  command->add_option("FOLDER", o->folder, "result folder")->required();
  command->add_option("--out", o->out, "folder of the report, made anew (default: FOLDER/report)");
  bool* const plots = &o->plots;
  bool* const svg = &o->svg;
  command->add_flag_callback(
      "--no-plots", [plots] { *plots = false; }, "tables, pictures and CSV only; needs no plotting library");
  command->add_flag_callback(
      "--no-svg", [svg] { *svg = false; }, "no SVG files; needs no node");
  command->callback([o] {
    for (const std::string& line : write_report(*o)) std::fprintf(stderr, "vielto: %s\n", line.c_str());
    const auto folder = o->out.empty() ? std::filesystem::path(o->folder) / "report" : std::filesystem::path(o->out);
    std::printf("report: %s\n", (folder / "report.html").lexically_normal().c_str());
  });
}

}  // namespace vielto

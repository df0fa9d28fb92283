// SPDX-License-Identifier: GPL-2.0-or-later
// vielto import surface: a measured free surface of a drum's bed -> rows of an observation table.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/observation_table.h"
#include "import/measured_surface.h"
#include "row_options.h"

namespace vielto {
namespace {

struct SurfaceOptions : RowOptions {
  std::string file;
  SurfaceColumns columns;
  double drum_diameter = 0;
  std::vector<double> u;
};

void import_surface(const SurfaceOptions& o) {
  std::vector<Observation> rows = o.earlier();
  const MeasuredSurface surface = read_surface(o.file, o.columns, o.drum_diameter / 2);
  std::size_t k = 0;
  Observation row = o.row;
  row.apparatus = "drum";
  for (const SurfaceWindow& window : kSurfaceWindows)
    rows.push_back(with_value(row, window.observable, surface.angles.*window.angle, o.u[k++]));
  write_observations(o.out, rows);
  for (const SurfaceWindow& window : kSurfaceWindows)
    fmt::print("{}: {} {} = {:.4g} deg\n", o.out, o.row.test, window.observable, surface.angles.*window.angle);
}

}  // namespace

void add_import_surface(CLI::App& import) {
  auto o = std::make_shared<SurfaceOptions>();
  o->row.tilt = 0;
  CLI::App* command = import.add_subcommand(
      "surface",
      "slopes angle_mid, angle_upper and angle_lower of a measured free surface in a level drum\n"
      "Example: vielto import surface contour.csv --x-column x_mm --y-column y_mm --length-factor 0.001 \\\n"
      "           --drum-diameter 0.084 --u 0.5 0.7 0.7 --speed 0.1667 --test day1 --out observations.csv");
  command->add_option("FILE", o->file, "text with columns of x, across the axis, and y, up; the axis at 0, 0")
      ->required();
  command->add_option("--x-column", o->columns.x, "its column of x, as the file names it")->required();
  command->add_option("--y-column", o->columns.y, "its column of y; a row without one is left out")->required();
  command->add_option("--length-factor", o->columns.length_factor, "times the columns is m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--uphill-right", o->columns.uphill_right,
                    "the drum carries the bed up at positive x (default: at negative x)");
  command->add_option("--drum-diameter", o->drum_diameter, "m, inner")->check(CLI::PositiveNumber)->required();
  command->add_option("--u", o->u, "deg, standard uncertainty of angle_mid, angle_upper and angle_lower")
      ->expected(3)
      ->check(CLI::PositiveNumber)
      ->required();
  o->add_to(command);
  command->callback([o] { import_surface(*o); });
}

}  // namespace vielto

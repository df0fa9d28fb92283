// SPDX-License-Identifier: GPL-2.0-or-later
// vielto import yade: torque and positions that a Yade script of one's own has saved -> rows of an observation table.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "import/script_run.h"
#include "row_options.h"

namespace vielto {
namespace {

struct ImportOptions : RowOptions {
  ScriptTorque torque;
  ScriptBed bed;
  std::string across = "y", up = "z";
  std::vector<double> window, box;

  ScriptBed asked_bed() const {
    ScriptBed asked = bed;
    asked.axes = {across[0] - 'x', up[0] - 'x'};
    if (!window.empty()) asked.window = {window[0], window[1]};
    if (!box.empty()) std::copy(box.begin(), box.end(), asked.box.emplace().begin());
    return asked;
  }
};

// What an option needs beside it, in one line instead of CLI11's several.
void check(const ImportOptions& o) {
  const auto refuse = [](const std::string& what, const std::string& mend) {
    throw BadInput("vielto import yade", 0, what, mend);
  };
  if (o.torque.file.empty() && o.bed.files.empty())
    refuse("imports nothing", "give --torque FILE, --bed FILE, or both");
  if (!o.torque.file.empty() && o.torque.columns.torque.empty())
    refuse("--torque has no column", "name it with --torque-column");
  if (!o.torque.file.empty() && !(o.row.speed && *o.row.speed > 0))
    refuse("--torque has no speed", "give --speed, in turns a second");
  if (o.torque.file.empty() && (!o.torque.idle.empty() || o.torque.ripple))
    refuse("--idle and --ripple have no torque", "give --torque FILE");
  if (!o.bed.files.empty() && o.bed.angle_of.empty() && o.box.empty())
    refuse("--bed makes no observation", "give --angle drum or repose, or --box with --grain-density");
  if (o.bed.files.empty() && (!o.bed.angle_of.empty() || !o.box.empty()))
    refuse("--angle and --box have no bed", "give --bed FILE");
  if (o.box.empty() != (o.bed.grain_density == 0))
    refuse("--box and --grain-density go together", "give both or neither");
  for (std::size_t d = 0; d < o.box.size(); d += 2)
    if (!(o.box[d] < o.box[d + 1]))
      refuse("--box is turned inside out", "give it as x0 x1 y0 y1 z0 z1, each from low to high");
  if (!o.window.empty() && !(o.window[0] < o.window[1]))
    refuse("--window is turned inside out", "give it from low to high");
  if (o.across == o.up) refuse("--across and --up are the same axis", "name two axes");
}

void import_yade(const ImportOptions& o) {
  check(o);
  std::vector<Observation> rows = o.earlier();
  std::vector<Observation> added;
  const auto add = [&](const ScriptRows& made) {
    for (const std::string& line : made.said) fmt::print("{}\n", line);
    added.insert(added.end(), made.rows.begin(), made.rows.end());
  };
  if (!o.torque.file.empty()) add(torque_rows(o.torque, o.row));
  if (!o.bed.files.empty()) add(bed_rows(o.asked_bed(), o.row));
  rows.insert(rows.end(), added.begin(), added.end());
  write_observations(o.out, rows);
  for (const Observation& row : added)
    fmt::print("{}: {} {} = {:.6g} {}, u {:.2g}\n", o.out, row.test, row.observable, row.value, row.unit, row.u);
}

}  // namespace

void add_import_yade(CLI::App& import) {
  auto o = std::make_shared<ImportOptions>();
  CLI::App* command = import.add_subcommand(
      "yade",
      "torque and positions saved by a Yade script (plot.saveDataTxt, VTKRecorder, export.text); see "
      "doc/guide/yade_results.md\n"
      "Example: vielto import yade --torque plot.txt --torque-column Tx --time-column t --speed 1 --fill 0.15 \\\n"
      "           --test seed1 --out observations.csv");
  o->add_to(command);
  command->add_option("--tilt", o->row.tilt, "deg, of the axis from horizontal")->check(CLI::Range(-90.0, 90.0));

  command->add_option("--torque", o->torque.file, "text with the torque on the rotor against time")->group("Torque");
  command->add_option("--idle", o->torque.idle, "the same of the empty machine: rows power_loaded and power_idle")
      ->group("Torque");
  command->add_option("--torque-column", o->torque.columns.torque, "its column, as the file names it")->group("Torque");
  command->add_option("--time-column", o->torque.columns.time, "column of the time")
      ->capture_default_str()
      ->group("Torque");
  command->add_option("--torque-factor", o->torque.columns.torque_factor, "times the column is N m; -1 turns the sign")
      ->capture_default_str()
      ->group("Torque");
  command->add_option("--time-factor", o->torque.columns.time_factor, "times the column is s; O.dt if it holds O.iter")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Torque");
  command->add_option("--start", o->torque.columns.start, "s, when the rotor began to turn (default: the first row)")
      ->group("Torque");
  command
      ->add_flag("--skip-nan", o->torque.columns.skip_nan, "leave out rows without a torque (other plot.addData calls)")
      ->group("Torque");
  command->add_option("--turns", o->torque.turns, "steady whole turns asked for")
      ->check(CLI::Range(kLeastAveragedTurns, 1000000))
      ->capture_default_str()
      ->group("Torque");
  command->add_flag("--ripple", o->torque.ripple, "also torque_ripple; only if the whole rotor was simulated")
      ->group("Torque");

  command
      ->add_option("--bed", o->bed.files,
                   ".vtu or .vtp of the spheres, or text with x y z r; several: snapshots in their order")
      ->group("Bed");
  command->add_option("--length-factor", o->bed.length_factor, "times the file's lengths are m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Bed");
  command
      ->add_option("--angle", o->bed.angle_of, "slope of the free surface, as the angle of a drum or of a repose test")
      ->check(CLI::IsMember({"drum", "repose"}))
      ->group("Bed");
  command->add_option("--across", o->across, "horizontal axis along which the surface falls")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str()
      ->group("Bed");
  command->add_option("--up", o->up, "vertical axis")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str()
      ->group("Bed");
  command->add_option("--window", o->window, "m, from and to along --across (default: the middle half of the grains)")
      ->expected(2)
      ->group("Bed");
  command->add_option("--box", o->box, "m, x0 x1 y0 y1 z0 z1 inside the bed: bulk_density")->expected(6)->group("Bed");
  command->add_option("--grain-density", o->bed.grain_density, "kg/m3, for --box")
      ->check(CLI::PositiveNumber)
      ->group("Bed");
  command->callback([o] { import_yade(*o); });
}

}  // namespace vielto

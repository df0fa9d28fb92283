// SPDX-License-Identifier: GPL-2.0-or-later
// vielto geometry PARFILE --out DIR [--set NAME=VALUE ...] [--picture FILE.png]   makes the meshes of a rig
// vielto geometry --check FILE.stl [--closed]                                     measures one
#include <fmt/format.h>

#include <memory>

#include "commands.h"
#include "core/bad_input.h"
#include "geometry/geometry_output.h"
#include "geometry/stl.h"
#include "picture/display.h"
#include "rigs/rig_code.h"

namespace vielto {
namespace {

constexpr double kLargestMachine = 10;  // m

struct Options {
  std::string par_file, folder, picture, check;
  std::vector<std::string> settings;
  bool closed = false;
};

void check(const Options& o) {
  const StlCheck checked = check_stl(o.check, o.closed);
  const Measure& m = checked.measure;
  fmt::print("{}: {} triangles, {} open edges, {} edges shared wrongly, smallest angle {:.2f} deg, area {:.6g} m2, ",
             o.check, m.triangles, m.open_edges, m.crowded_edges, m.smallest_angle * 57.29577951308232, m.area);
  if (m.open_edges == 0 && m.crowded_edges == 0)
    fmt::print("volume {:.6g} m3 (normals {})\n", m.volume, m.volume > 0 ? "outward" : "inward");
  else
    fmt::print("open, so no volume\n");
  const Point size = m.high - m.low;
  fmt::print("extents {:.6g} x {:.6g} x {:.6g} m, from {:.6g} {:.6g} {:.6g}\n", size.x(), size.y(), size.z(), m.low.x(),
             m.low.y(), m.low.z());
  if (size.maxCoeff() > kLargestMachine)
    fmt::print(
        "note: that is {:.4g} m long; are its lengths in mm? LIGGGHTS takes m (or scale 0.001 of fix mesh/surface)\n",
        size.maxCoeff());
  if (!checked.fault.empty())
    throw BadInput(o.check, 0, checked.fault,
                   "export it again as text; 'vielto geometry' of a machine reads it as it is");
}

void make(const Options& o) {
  if (!o.picture.empty() && !has_display())
    throw BadInput("--picture " + o.picture, 0, "cannot be drawn without a display",
                   "run the command under 'xvfb-run -a'");
  ParFile file = ParFile::read(o.par_file);
  for (const std::string& setting : o.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == setting.size())
      throw BadInput("--set " + setting, 0, "is no setting", "write --set NAME=VALUE");
    file.override_value(setting.substr(0, equals), setting.substr(equals + 1));
  }
  GeometryInput input(file);
  const RigGeometry geometry = rig_geometry(input);
  write_geometry(geometry, input, o.folder);
  if (!o.picture.empty()) write_picture(geometry, o.picture);
  for (const Part& part : geometry.parts)
    fmt::print("{}/{}.stl: {} triangles\n", o.folder, part.name, part.triangles.size());
  for (const std::string& note : geometry.notes) fmt::print("{}\n", note);
}

}  // namespace

void add_geometry_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("geometry", "meshes (STL) of a rig from its parameter file, or the check of one mesh");
  CLI::Option* par =
      command->add_option("parfile", options->par_file, "the rig's parameter file, e.g. cases/mixer/mixer.par");
  CLI::Option* out = command->add_option("--out", options->folder, "folder for the meshes and geometry.par");
  par->needs(out);
  out->needs(par);
  command->add_option("--set", options->settings, "NAME=VALUE in place of the file's value")->needs(par);
  command->add_option("--picture", options->picture, "also render a view into this PNG (needs a display)")->needs(par);
  CLI::Option* check_option =
      command->add_option("--check", options->check, "measure this STL file instead")->excludes(par);
  command->add_flag("--closed", options->closed, "with --check: the surface must be closed")->needs(check_option);
  command->callback([options] {
    if (!options->check.empty())
      check(*options);
    else if (!options->par_file.empty())
      make(*options);
    else
      throw CLI::RequiredError("a parameter file with --out, or --check FILE.stl");
  });
}

}  // namespace vielto

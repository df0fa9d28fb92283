// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/sphere_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/bad_input.h"
#include "import/column_text.h"
#include "import/vtk_spheres.h"

namespace vielto {
namespace {

std::vector<Grain> read_text(const std::string& path) {
  std::string first;
  std::getline(std::ifstream(path, std::ios::binary), first);
  if (first.rfind("# vtk DataFile", 0) == 0)
    throw BadInput(path, 1, "is a VTK file of the legacy format",
                   "save it as .vtu or .vtp (ParaView: File, Save Data), or as text of x y z r");
  const ColumnText text = read_column_text(path);
  const std::size_t x = text.column("x"), y = text.column("y"), z = text.column("z"), r = text.column("r");
  std::vector<Grain> grains;
  for (const auto& row : text.rows) grains.push_back({{row[x], row[y], row[z]}, row[r]});
  return grains;
}

}  // namespace

std::vector<Grain> read_spheres(const std::string& path, double factor) {
  const std::filesystem::path file(path);
  if (!std::filesystem::is_regular_file(file)) throw BadInput(path, 0, "cannot be read", "name an existing file");
  const std::string kind = file.extension().string();
  std::vector<Grain> grains = kind == ".vtu"   ? read_vtk_spheres(path, "UnstructuredGrid")
                              : kind == ".vtp" ? read_vtk_spheres(path, "PolyData")
                                               : read_text(path);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    Grain& g = grains[i];
    for (double& q : g.x) q *= factor;
    g.radius *= factor;
    if (!std::isfinite(g.x[0] + g.x[1] + g.x[2]) || !(g.radius > 0) || !std::isfinite(g.radius))
      throw BadInput(path, 0, fmt::format("grain {} has no finite place and positive radius", i + 1),
                     "look for where that run went wrong");
  }
  return grains;
}

}  // namespace vielto

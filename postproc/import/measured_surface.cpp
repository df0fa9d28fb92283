// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/measured_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/bad_input.h"
#include "import/column_text.h"

namespace vielto {

MeasuredSurface read_surface(const std::string& path, const SurfaceColumns& columns, double drum_radius) {
  const ColumnText text = read_column_text(path);
  const std::size_t x = text.column(columns.x), y = text.column(columns.y);
  if (x == y) throw BadInput(path, 0, columns.x, "is named for x and for y", "name two columns");
  std::map<double, int> lines;  // by x
  MeasuredSurface surface;
  for (std::size_t i = 0; i < text.rows.size(); ++i) {
    const int line = text.lines[i];
    if (std::isnan(text.rows[i][y])) continue;
    if (std::isnan(text.rows[i][x]))
      throw BadInput(path, line, columns.x, "is not given", "state where the point lies");
    const SurfacePoint point = {(columns.uphill_right ? -1 : 1) * columns.length_factor * text.rows[i][x],
                                columns.length_factor * text.rows[i][y]};
    if (const auto [seen, is_new] = lines.emplace(point.x, line); !is_new)
      throw BadInput(path, line, columns.x, fmt::format("is that of line {} too", seen->second),
                     "give one height for each place");
    if (std::hypot(point.x, point.y) > drum_radius)
      throw BadInput(path, line, columns.y,
                     fmt::format("lies {:.3g} m from the axis, outside the drum of radius {:.3g} m",
                                 std::hypot(point.x, point.y), drum_radius),
                     "give the columns' unit with --length-factor (0.001 for mm), the axis at x = y = 0");
    surface.points.push_back(point);
  }
  std::sort(surface.points.begin(), surface.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  try {
    surface.angles = surface_angles(surface.points, drum_radius);
  } catch (const std::invalid_argument& e) {
    throw BadInput(path, 0, columns.y, e.what(), "read the surface off in more places");
  }
  return surface;
}

}  // namespace vielto

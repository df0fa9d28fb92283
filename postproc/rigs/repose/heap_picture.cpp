// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/heap_picture.h"

#include <fmt/format.h>

#include "picture/chart.h"

namespace vielto {
namespace {

void split(const std::vector<SurfacePoint>& points, std::vector<double>& r, std::vector<double>& z) {
  for (const SurfacePoint& p : points) r.push_back(1e3 * p.r), z.push_back(1e3 * p.z);
}

}  // namespace

void draw_heap(const Heap& heap, const ConeFit& fit, const std::string& path) {
  const HeapHeader& h = heap.header;
  std::vector<double> r, z, mean_r, mean_z;
  split(fit.surface, r, z);
  split(fit.profile, mean_r, mean_z);
  const double reach = 1.5e3 * fit.flank_to, high = 1.4e3 * fit.height;
  Chart chart(fmt::format("{}{}, lifted at {} mm/s: angle of repose {:.1f} deg, standard uncertainty {:.1f} deg",
                          h.material, h.provisional ? " (provisional)" : "", 1e3 * h.lift_speed, fit.angle, fit.u));
  chart.shade("flank", 1e3 * fit.flank_from, 1e3 * fit.flank_to, 0, high);
  chart.points(fmt::format("surface in {} strips", kConeStrips), r, z, kGrey, 4);
  chart.line("mean profile", mean_r, mean_z, kBlue, 4);
  const double foot = fit.intercept / fit.slope;
  chart.line("fitted cone", {0, 1e3 * foot}, {1e3 * fit.intercept, 0}, kOrange, 3);
  chart.horizontal_axis("distance from the axis / mm", 0, reach);
  chart.vertical_axis("height / mm", 0, high);
  chart.write(path);
}

}  // namespace vielto

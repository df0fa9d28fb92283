// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/shearbox/shear_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "picture/chart.h"

namespace vielto {
namespace {

std::vector<double> scaled(std::vector<double> values, double by) {
  for (double& value : values) value *= by;
  return values;
}

}  // namespace

void draw_shear(const ShearRecord& record, const ShearResult& result, const std::string& path) {
  const ShearRecordHeader& h = record.header;
  const std::vector<double> x = scaled(record.displacement, 1e3), blocks = scaled(result.displacement, 1e3);
  const std::vector<double> shear = scaled(record.shear_force, 1e-3 / h.area);
  const std::vector<double> plate = scaled(record.plate_force, 1e-3 / h.area);
  const double high =
      1.25 * std::max(*std::max_element(shear.begin(), shear.end()), *std::max_element(plate.begin(), plate.end()));
  const double low = std::min(0.0, *std::min_element(shear.begin(), shear.end()));
  const double normal = 1e-3 * h.normal_stress;
  Chart chart(
      fmt::format("{}{}, {:.2f} kPa, {} mm/s: steady shear stress {:.2f} kPa, plate force fluctuates by {:.1f} %",
                  h.material, h.provisional ? " (provisional)" : "", normal, 1e3 * h.shear_velocity,
                  1e-3 * result.steady.mean, 100 * result.plate_fluctuation));
  chart.shade("steady part", 1e3 * result.steady_from, x.back(), low, high);
  chart.line("force on the load plate over the area", x, plate, kGrey, 1);
  chart.line("shear stress", x, shear, kBlue, 1);
  chart.line("plate, mean of a block", blocks, scaled(result.plate_force, 1e-3 / h.area), kGrey, 4);
  chart.line("shear stress, mean of a block", blocks, scaled(result.shear_stress, 1e-3), kBlue, 4);
  chart.line("weight of the load plate over the area", {0, x.back()}, {normal, normal}, kOrange, 2);
  chart.horizontal_axis("displacement / mm", 0, x.back());
  chart.vertical_axis("stress / kPa", low, high);
  chart.write(path);
}

}  // namespace vielto

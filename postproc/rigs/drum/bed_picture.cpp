// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/bed_picture.h"

#include <fmt/format.h>

#include <cmath>

#include "core/mixing_numbers.h"
#include "picture/chart.h"

namespace vielto {

void draw_bed(const BedAngle& bed, const std::string& path) {
  const BedHeader& h = bed.header;
  std::vector<double> turns, angles;
  for (const BedLook& look : bed.looks) turns.push_back(look.turn), angles.push_back(look.angle.value);
  Chart chart(fmt::format("{}{} in a drum of {}, tilt {} deg: angle {:.1f} deg, standard uncertainty {:.1f} deg",
                          h.material, h.provisional ? " (provisional)" : "", h.wall, h.tilt, bed.angle.value,
                          bed.angle.u));
  chart.points("angle at each look", turns, angles, kBlue, 8);
  chart.line("mean", {turns.front(), turns.back()}, {bed.angle.value, bed.angle.value}, kOrange, 3);
  const double span = turns.back() - turns.front();
  chart.horizontal_axis("turns", turns.front() - 0.05 * span, turns.back() + 0.05 * span);
  chart.vertical_axis("angle of the free surface / deg", 0, 1.5 * bed.angle.value);
  chart.write(path);
}

}  // namespace vielto

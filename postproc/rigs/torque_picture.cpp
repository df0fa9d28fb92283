// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/torque_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/steady_part.h"
#include "picture/chart.h"

namespace vielto {
void draw_torque(const TorqueRecord& record, const MixingPower& power, const std::string& path) {
  const double scale = record.header.whole_drum(), turn_time = 1 / record.header.speed;
  const double start = record.first_turn * turn_time, block_time = record.turns_per_block * turn_time;
  std::vector<double> torque = record.rotor();
  for (double& value : torque) value *= scale;
  std::vector<double> time;
  for (std::size_t i = 0; i < torque.size(); ++i)
    time.push_back(start + (static_cast<double>(i) + 0.5) / record.block_phases() * block_time);
  // Turn means as stairs.
  std::vector<double> stairs_time, stairs;
  const std::vector<double> means = turn_means(torque, record.block_phases());
  for (std::size_t t = 0; t < means.size(); ++t)
    for (const double end : {0.0, 1.0}) {
      stairs_time.push_back(start + (static_cast<double>(t) + end) * block_time);
      stairs.push_back(means[t]);
    }
  const auto [least, most] = std::minmax_element(torque.begin(), torque.end());
  const double low = std::min(0.0, *least * 1.05), high = std::max(0.0, *most * 1.3);
  const double from = power.turn_first * turn_time, to = from + power.averaged.turns_kept() * turn_time;

  Chart chart(fmt::format("{}: {:.2f} N m, mixing power {:.1f} W, standard uncertainty {:.1f} W",
                          record.header.what_ran(), power.torque.mean, power.power.mean, power.power.u));
  chart.shade("averaged turns", from, to, low, high);
  const std::string of = record.header.slice == 0 ? "torque on the grains"
                                                  : fmt::format("torque on the grains, slice times {}/{}",
                                                                record.header.paddles, record.header.slice);
  chart.line(of, time, torque, kBlue, 1.5F);
  chart.line("turn mean", stairs_time, stairs, kOrange, 4);
  chart.horizontal_axis("time since the rotor started / s", record.first_turn * turn_time,
                        start + record.blocks * block_time);
  chart.vertical_axis("torque / (N m)", low, high);
  chart.write(path);
}

TurningRotor turning_rotor(const TorqueRecord& record) {
  const TorqueRecordHeader& h = record.header;
  TurningRotor rotor;
  rotor.start_step = static_cast<double>(record.start_step);
  rotor.steps_per_turn = static_cast<double>(h.steps_per_turn);
  rotor.caption = h.what_ran();
  rotor.axis = h.axis;
  rotor.standing.clear();
  for (const RecordedPart& part : record.parts)
    if (!part.turns) rotor.standing.push_back(part.name);
  return rotor;
}

}  // namespace vielto

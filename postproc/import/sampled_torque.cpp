// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/sampled_torque.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bad_input.h"
#include "rigs/torque_record.h"

namespace vielto {
namespace {

constexpr double kWidestGap = 0.125;  // of a turn

struct Samples {
  std::vector<double> turn, torque;
};

Samples samples_of(const ColumnText& text, const TorqueColumns& c, double speed) {
  const std::size_t time = text.column(c.time), torque = text.column(c.torque);
  Samples samples;
  std::optional<double> start = c.start;
  int last_line = 0;
  for (std::size_t i = 0; i < text.rows.size(); ++i) {
    const int line = text.lines[i];
    const double value = text.rows[i][torque], t = text.rows[i][time] * c.time_factor;
    if (std::isnan(value) && c.skip_nan) continue;
    if (std::isnan(value))
      throw BadInput(text.path, line, c.torque, "has no value (nan)",
                     "use --skip-nan if another plot.addData made this row");
    if (!std::isfinite(t))
      throw BadInput(text.path, line, c.time, "has no value (nan)", "save the time with the torque");
    if (!start) start = t;
    const double turn = (t - *start) * speed;
    if (!samples.turn.empty()) {
      if (!(turn > samples.turn.back()))
        throw BadInput(text.path, line, c.time, fmt::format("does not rise after line {}", last_line),
                       "save one run a file, its rows in the order of time");
      if (turn > 0 && turn - samples.turn.back() > kWidestGap)
        throw BadInput(text.path, line, c.time,
                       fmt::format("is {:.2g} turns after line {}", turn - samples.turn.back(), last_line),
                       fmt::format("sample at least every {} turns, or mend --speed or --time-factor", kWidestGap));
    }
    samples.turn.push_back(turn);
    samples.torque.push_back(value * c.torque_factor);
    last_line = line;
  }
  if (samples.turn.empty())
    throw BadInput(text.path, 0, c.torque, "has no value in any row", "name the column that holds the torque");
  if (samples.turn.front() > 0)
    throw BadInput(text.path, text.lines.front(), c.time,
                   fmt::format("begins {:.3g} turns after --start", samples.turn.front()), "give a later --start");
  return samples;
}

}  // namespace

SampledTorque sampled_torque(const ColumnText& text, const TorqueColumns& columns, double speed) {
  const Samples s = samples_of(text, columns, speed);
  SampledTorque result;
  // the last sample of a whole number of turns may fall short of it by the rounding of the times
  result.turns = std::max(0, static_cast<int>(std::floor(s.turn.back() + 1e-6)));
  result.signal.assign(static_cast<std::size_t>(result.turns) * kPhases, 0.0);
  const double phase = 1.0 / kPhases;
  const double end = result.turns;
  double inside = 0;
  for (std::size_t i = 0; i + 1 < s.turn.size(); ++i) {
    const double a = s.turn[i], b = std::min(s.turn[i + 1], end), width = s.turn[i + 1] - a;
    if (b > 0 && a < end) ++inside;
    double from = std::max(a, 0.0);
    for (auto bin = static_cast<std::size_t>(from / phase); from < b && bin < result.signal.size(); ++bin) {
      const double to = std::min(b, static_cast<double>(bin + 1) * phase);
      if (to <= from) continue;
      const double middle = (0.5 * (from + to) - a) / width;
      result.signal[bin] += ((1 - middle) * s.torque[i] + middle * s.torque[i + 1]) * (to - from) / phase;
      from = to;
    }
  }
  if (result.turns > 0) result.samples_per_turn = inside / end;
  return result;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "import/logger_record.h"
#include "picture/chart.h"

namespace vielto {

void draw_logger(const LoggerRecord& r, const LoggerMean& m, const std::string& quantity, const std::string& path) {
  const auto [low, high] = std::minmax_element(r.value.begin(), r.value.end());
  const double margin = 0.05 * std::max(*high - *low, 1e-12);
  Chart chart(fmt::format("{}: mean {:.4g}, standard uncertainty {:.2g}", quantity, m.mean.mean, m.mean.u));
  chart.shade("averaged", m.from, m.to, *low - margin, *high + margin);
  chart.line("record", r.time, r.value, kBlue, 1);
  chart.line("mean", {m.from, m.to}, {m.mean.mean, m.mean.mean}, kOrange, 2);
  chart.horizontal_axis("time, s", r.time.front(), r.time.back());
  chart.vertical_axis(quantity, *low - margin, *high + margin);
  chart.write(path);
}

}  // namespace vielto

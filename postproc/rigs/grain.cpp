// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/grain.h"

#include "core/bad_input.h"

namespace vielto {

std::vector<Grain> read_grains(RecordFile& file, const std::string& path) {
  const Columns& c = file.columns();
  const std::size_t x = c.at("x_m"), y = c.at("y_m"), z = c.at("z_m"), radius = c.at("radius_m");
  std::vector<Grain> grains;
  for (std::vector<double> row; file.next_row(row);) {
    if (!(row[radius] > 0)) throw BadInput(path, file.line(), "radius_m", "is not above 0", "run the case again");
    grains.push_back({{row[x], row[y], row[z]}, row[radius]});
  }
  if (grains.empty()) throw BadInput(path, 0, "holds no grain", "run the case again");
  return grains;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// A bed that never comes to rest, for tests of restarts and of ranks: 64 grains in a square box of primitive planes on
// a mesh floor that turns about the vertical axis, with its torque record and a dump of all contact history.
#pragma once

#include <cmath>

#include "tests/engine/liggghts_runner.h"

namespace vielto_test {

const double bed_half = 0.024, bed_period = 1, bed_dt = 5e-6;  // m, s, s: the stiffest contact has 3e-4 s

inline std::vector<Sphere> bed_grains() {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 64; i++)
    spheres.push_back({1,
                       0.004 + 0.0002 * (i % 3),
                       1375,
                       {0.0088 * (i % 4) - 0.0132, 0.0088 * (i / 4 % 4) - 0.0132, 0.005 + 0.0088 * (i / 16)},
                       {0.1 * std::sin(i), 0.1 * std::cos(2 * i), 0},
                       {5, 0, 10.0 * std::sin(3 * i)}});
  return spheres;
}

// With the printed dashpot, which acts while sliding, the floor drags its grains by gamma_s v = 0.5 N, a hundred times
// their weight, and jams them at the sides; so here it is off.
const char* const bed_settings = "slidingDashpot off";

// Everything after the pair style but the runs. `each` steps: dumps `state`, `pair`, `wall` with `suffix`; `row` steps
// a row.
inline std::string bed_walls(const Liggghts& run, const std::string& suffix, long each, long row) {
  run.write("floor.stl", plate_stl(0.04));
  std::string text =
      "fix floor all mesh/surface/stress file floor.stl type 1 reference_point 0 0 0\n" +
      fmt::format("fix mesh all wall/gran {} mesh n_meshes 1 meshes floor {}\n", vielto_models, bed_settings);
  for (const char* side : {"xplane", "yplane"})
    for (const double at : {-bed_half, bed_half})
      text += fmt::format("fix {0}{1} all wall/gran {2} primitive type 1 {0} {3} {4}\n", side, at > 0 ? 1 : 0,
                          vielto_models, at, bed_settings);
  text += fmt::format("timestep {}\nfix move all nve/sphere\nfix gravity all gravity 9.81 vector 0 0 -1\n", bed_dt);
  text += fmt::format("fix turn all move/mesh mesh floor rotate origin 0 0 0 axis 0 0 1 period {}\n", bed_period);
  text += fmt::format(
      "fix record all vielto/record every {} file torque.csv speed {:.17g} axis 0 0 1 part floor floor energy on\n",
      row, 1 / bed_period);
  text += "compute pair all pair/gran/local id history\ncompute wall all wall/gran/local id history\n";
  text += dump_grains("state" + suffix, each);
  for (const std::string name : {"pair", "wall"}) {
    // id: two grains and a flag, or mesh, triangle, grain; then the seven values of history
    std::string columns = name == "pair" ? "c_pair[1] c_pair[2]" : "c_wall[2] c_wall[3]", format = "%.17g %.17g";
    for (int i = 4; i <= 10; i++) columns += fmt::format(" c_{}[{}]", name, i), format += " %.17g";
    text += fmt::format("dump {0}{1} all local {2} {0}{1} {3}\ndump_modify {0}{1} format \"{4}\"\n", name, suffix, each,
                        columns, format);
  }
  return text;
}

inline std::string bed_start(const Liggghts& run) { return head(run, bed_grains(), {Material()}, 0.1, bed_settings); }

// The same from a restart file.
inline std::string bed_restart(const std::string& file) {
  return settings_head() + "read_restart " + file + "\nneighbor 0.00176 bin\nneigh_modify delay 0\n" +
         properties({Material()}) + fmt::format("pair_style gran {} {}\npair_coeff * *\n", vielto_models, bed_settings);
}

inline const Table& frame_of(const std::vector<Table>& frames, long step) {
  for (const Table& frame : frames)
    if (frame.step == step) return frame;
  ADD_FAILURE() << "no frame of step " << step;
  return frames.front();
}

// Contacts of a local dump by their partners; neighbour lists may hold them in another order. A pair may come in the
// other order of its grains: then the vectors (F_s, M_r) turn their sign, the twisting moment does not.
inline std::map<std::pair<int, int>, std::vector<double>> history(const Table& frame, bool pairs) {
  std::map<std::pair<int, int>, std::vector<double>> map;
  for (const std::vector<double>& row : frame.rows) {
    int a = static_cast<int>(row[0]), b = static_cast<int>(row[1]);
    std::vector<double> values(row.begin() + 2, row.end());
    if (pairs && a > b) {
      std::swap(a, b);
      for (std::size_t i = 0; i < 6; i++) values[i] = -values[i];
    }
    map[{a, b}] = values;
  }
  return map;
}

}  // namespace vielto_test

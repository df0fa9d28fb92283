// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/heap.h"

#include "core/bad_input.h"
#include "core/record_file.h"

namespace vielto {

Heap read_heap(const std::string& path) {
  RecordFile file(path, "a run folder or its heap.csv");
  const Keys& keys = file.keys();
  if (keys.integer("schema", 0) != 1)
    throw BadInput(path, keys.line("schema"), "the schema is not 1",
                   "write the record with this package's own version");
  Heap heap;
  heap.path = path;
  HeapHeader& h = heap.header;
  h.lift_speed = keys.number("lift_speed", 0, true);
  h.grain_diameter = keys.number("grain_diameter", 0, true);
  h.cylinder_diameter = keys.number("cylinder_diameter", 0, true);
  h.youngs_modulus = keys.number("youngs_modulus", 0, true);
  h.dt_over_tc = keys.number("dt_over_tc", 0);
  h.rest_time = keys.number("rest_time", 0);
  h.base = keys.text("base");
  h.seed = keys.text("seed");
  h.material = keys.text("material");
  h.wall = keys.text("wall");
  h.provisional = keys.integer("provisional", 0) != 0;

  if (keys.has("spheres_per_grain")) h.spheres_per_grain = keys.integer("spheres_per_grain", 1);
  heap.grains = read_grains(file, path);
  return heap;
}

}  // namespace vielto

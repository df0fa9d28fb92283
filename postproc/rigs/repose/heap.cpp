// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/repose/heap.h"

#include "core/record_file.h"

namespace vielto {

Heap read_heap(const std::string& path) {
  RecordFile file(path, "a run folder or its heap.csv");
  const Keys& keys = file.keys();
  Heap heap;
  heap.path = path;
  HeapHeader& h = heap.header;
  read_run_header(keys, h);
  h.lift_speed = keys.number("lift_speed", 0, true);
  h.cylinder_diameter = keys.number("cylinder_diameter", 0, true);
  h.rest_time = keys.number("rest_time", 0);
  h.base = keys.text("base");
  if (keys.has("spheres_per_grain")) h.spheres_per_grain = keys.integer("spheres_per_grain", 1);
  heap.grains = read_grains(file, path);
  return heap;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Grains of a heap at rest, `heap.csv`, schema 1: lines `# key=value`, then x_m,y_m,z_m,radius_m of each grain, or of
// each sphere of a clump; z counts from the base, the cylinder's axis is x = y = 0. Errors: BadInput as record_file.h,
// and for no grain.
#pragma once

#include <string>
#include <vector>

#include "rigs/grain.h"
#include "rigs/run_result.h"

namespace vielto {

struct HeapHeader : RunHeader {
  double lift_speed = 0;         // m/s
  double cylinder_diameter = 0;  // m
  double rest_time = 0;          // s, after the start of lifting, when the heap was found at rest
  std::string base;              // plain or rough
  int spheres_per_grain = 1;     // of a clump; its spheres are rows of their own
};

struct Heap {
  std::string path;
  HeapHeader header;
  std::vector<Grain> grains;
};

Heap read_heap(const std::string& path);

}  // namespace vielto

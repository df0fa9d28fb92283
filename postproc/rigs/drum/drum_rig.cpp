// SPDX-License-Identifier: GPL-2.0-or-later
// The rotating drum: looks at its bed -> dynamic angle, shape of the surface, observation rows, pictures.
#include <fmt/format.h>

#include "rigs/drum/bed_output.h"
#include "rigs/drum/bed_picture.h"
#include "rigs/drum/drum_geometry.h"
#include "rigs/rig_code.h"
#include "rigs/rig_picture.h"

namespace vielto {
namespace {

PostResult post_drum(const PostInput& input) {
  const BedAngle bed = read_bed_angle(input.record);
  PostResult result;
  result.rows = bed_observations(bed, input.label_or(fmt::format("drum-{}-tilt{}", bed.header.wall, bed.header.tilt)));
  result.table = bed_table(bed);
  result.numbers = bed_json(bed);
  result.files = {{"looks.csv", bed_looks_csv(bed)}};
  if (bed.surface) result.files.push_back({"surface.csv", bed_surface_csv(*bed.surface)});
  result.pictures = {{"bed.png", [bed](const std::string& path) { draw_bed(bed, path); }}};
  add_grains(input.run(), result);
  return result;
}

}  // namespace

RigCode drum_rig() { return {drum_geometry, post_drum}; }

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Looks at the bed of a rotating drum -> dynamic angle, observation row, picture.
#include <fmt/format.h>

#include <cstdio>

#include "core/csv.h"
#include "post.h"
#include "rigs/drum/bed_output.h"
#include "rigs/drum/bed_picture.h"
#include "rigs/rig_picture.h"

namespace vielto {

namespace fs = std::filesystem;

void post_drum(const fs::path& path, const PostOptions& options) {
  const BedAngle bed = read_bed_angle(path.string());
  TestLabel label = options.label;
  if (label.test.empty()) label.test = fmt::format("drum-{}-tilt{}", bed.header.wall, bed.header.tilt);
  const fs::path folder = path.parent_path() / "post";
  fs::create_directories(folder);
  const std::string table = bed_table(bed), json = bed_json(bed).dump(2) + "\n";
  // First what may still be refused.
  write_observations((folder / "observations.csv").string(), bed_observations(bed, label));
  write_whole_file((folder / "looks.csv").string(), bed_looks_csv(bed));
  if (bed.surface) write_whole_file((folder / "surface.csv").string(), bed_surface_csv(*bed.surface));
  write_whole_file((folder / "table.txt").string(), table);
  write_whole_file((folder / "drum.json").string(), json);
  if (options.pictures) {
    draw_bed(bed, (folder / "bed.png").string());
    draw_rig(path.parent_path().string(), nullptr, (folder / "grains.png").string());
  }
  std::fputs((options.json ? json : table).c_str(), stdout);
}

}  // namespace vielto

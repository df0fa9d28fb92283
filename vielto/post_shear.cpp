// SPDX-License-Identifier: GPL-2.0-or-later
// Record of a direct shear test -> shear stress, friction, plate force, observation rows, picture.
#include <cstdio>

#include "core/csv.h"
#include "post.h"
#include "rigs/rig_picture.h"
#include "rigs/shearbox/shear_picture.h"
#include "rigs/shearbox/shear_result_output.h"

namespace vielto {

namespace fs = std::filesystem;

void post_shear(const fs::path& path, const PostOptions& options) {
  const ShearRecord record = read_shear_record(path.string());
  const ShearResult result = shear_result(record);
  TestLabel label = options.label;
  if (label.test.empty()) label.test = default_test_name(result);
  const fs::path folder = path.parent_path() / "post";
  fs::create_directories(folder);
  const std::string table = shear_table(result), json = shear_json(result).dump(2) + "\n";
  // First what may still be refused.
  write_observations((folder / "observations.csv").string(), shear_observations(result, label));
  write_whole_file((folder / "curve.csv").string(), shear_curve_csv(result));
  write_whole_file((folder / "table.txt").string(), table);
  write_whole_file((folder / "shear.json").string(), json);
  if (options.pictures) {
    draw_shear(record, result, (folder / "shear.png").string());
    draw_rig(path.parent_path().string(), nullptr, (folder / "grains.png").string());
  }
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "vielto: WARNING: %s: %s\n", path.string().c_str(), warning.c_str());
  std::fputs((options.json ? json : table).c_str(), stdout);
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Grains of a heap -> angle of repose, observation row, picture.
#include <fmt/format.h>

#include <cstdio>

#include "core/csv.h"
#include "post.h"
#include "rigs/repose/heap_picture.h"
#include "rigs/repose/repose_output.h"
#include "rigs/rig_picture.h"

namespace vielto {

namespace fs = std::filesystem;

void post_repose(const fs::path& path, const PostOptions& options) {
  const Heap heap = read_heap(path.string());
  const ConeFit fit = cone_fit(heap);
  TestLabel label = options.label;
  if (label.test.empty()) label.test = fmt::format("repose-{}", heap.header.lift_speed);
  const fs::path folder = path.parent_path() / "post";
  fs::create_directories(folder);
  const std::string table = repose_table(heap, fit), json = repose_json(heap, fit).dump(2) + "\n";
  // First what may still be refused.
  write_observations((folder / "observations.csv").string(), repose_observations(heap, fit, label));
  write_whole_file((folder / "profile.csv").string(), repose_profile_csv(fit));
  write_whole_file((folder / "table.txt").string(), table);
  write_whole_file((folder / "repose.json").string(), json);
  if (options.pictures) {
    draw_heap(heap, fit, (folder / "heap.png").string());
    draw_rig(path.parent_path().string(), nullptr, (folder / "grains.png").string());
  }
  std::fputs((options.json ? json : table).c_str(), stdout);
}

}  // namespace vielto

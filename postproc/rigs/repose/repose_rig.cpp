// SPDX-License-Identifier: GPL-2.0-or-later
// The lifted cylinder: grains of a heap -> angle of repose, observation row, pictures.
#include <fmt/format.h>

#include "rigs/repose/heap_picture.h"
#include "rigs/repose/repose_geometry.h"
#include "rigs/repose/repose_output.h"
#include "rigs/rig_code.h"
#include "rigs/rig_picture.h"

namespace vielto {
namespace {

PostResult post_repose(const PostInput& input) {
  const Heap heap = read_heap(input.record);
  const ConeFit fit = cone_fit(heap);
  PostResult result;
  result.warnings = fit.warnings;
  result.rows = repose_observations(heap, fit, input.label_or(fmt::format("repose-{}", heap.header.lift_speed)));
  result.table = repose_table(heap, fit);
  result.numbers = repose_json(heap, fit);
  result.files = {{"profile.csv", repose_profile_csv(fit)}};
  result.pictures = {{"heap.png", [heap, fit](const std::string& path) { draw_heap(heap, fit, path); }}};
  add_grains(input.run(), result);
  return result;
}

}  // namespace

RigCode repose_rig() { return {repose_geometry, post_repose}; }

}  // namespace vielto

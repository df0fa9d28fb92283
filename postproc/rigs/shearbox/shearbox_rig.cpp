// SPDX-License-Identifier: GPL-2.0-or-later
// The direct shear box: record of a test -> shear stress, friction, plate force, observation rows, pictures.
#include "rigs/rig_code.h"
#include "rigs/rig_picture.h"
#include "rigs/shearbox/shear_picture.h"
#include "rigs/shearbox/shear_result_output.h"
#include "rigs/shearbox/shearbox_geometry.h"

namespace vielto {
namespace {

PostResult post_shear(const PostInput& input) {
  const ShearRecord record = read_shear_record(input.record);
  const ShearResult shear = shear_result(record);
  PostResult result;
  result.rows = shear_observations(shear, input.label_or(default_test_name(shear)));
  result.table = shear_table(shear);
  result.numbers = shear_json(shear);
  result.files = {{"curve.csv", shear_curve_csv(shear)}};
  result.pictures = {{"shear.png", [record, shear](const std::string& path) { draw_shear(record, shear, path); }}};
  add_grains(input.run(), result);
  result.warnings = shear.warnings;
  return result;
}

}  // namespace

RigCode shearbox_rig() { return {shearbox_geometry, post_shear}; }

}  // namespace vielto

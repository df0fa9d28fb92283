// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto post` makes of the torque record of any rotor, the mixer's or a machine of a user's own: power, numbers,
// phase curves, observation rows, pictures.
#pragma once

#include "rigs/post.h"

namespace vielto {

// Errors: BadInput of read_torque_record() and mixing_power().
PostResult post_power(const PostInput& input);

}  // namespace vielto

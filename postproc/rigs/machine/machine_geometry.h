// SPDX-License-Identifier: GPL-2.0-or-later
// A machine of a user's own: its parts (machine_parts.h) -> meshes for the run, checks, places for the grain.
//
// Checked, with one line each: something turns and something stands; the rotor stands in a vessel that holds grain; it
// clears what stands over a whole turn; it does not rise over the rim of an open vessel; it leaves room for the grain;
// the vessel's volume is the one stated, within kMostVolumeDifference.
//
// Places of the grain: the closest packing of spheres a little larger than the largest grain, each moved at random
// within the play that this leaves, those that are in the room, off every mesh and in no closed part that turns, one in
// twenty left out at random, from the lowest up (places.csv). They fall by some tenth of the bed's height until they
// lie.
#pragma once

#include "geometry/rig_geometry.h"

namespace vielto {

constexpr double kMostVolumeDifference = 0.05;  // of the volume stated

// Errors: BadInput.
RigGeometry machine_geometry(GeometryInput& input);

}  // namespace vielto

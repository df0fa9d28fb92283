// SPDX-License-Identifier: GPL-2.0-or-later
// Picture of a rig with its grains, for people.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "rigs/post.h"

namespace vielto {

// How far a rotor has turned since its start, from the step of a dump, and what
// is written over the picture.
struct TurningRotor {
  double start_step = 0, steps_per_turn = 1;
  std::string caption;                           // without the turns, which are added
  std::array<double, 3> axis = {1, 0, 0};        // through the origin
  std::vector<std::string> standing = {"drum"};  // meshes that stand still, drawn translucent
};

// The last dump of grains in RUN/vtk (`dump custom/vtk` with v and radius),
// coloured by speed, in the meshes of RUN/mesh: what stands translucent, every
// other part turned about the axis to where the rotor stood; without a rotor
// nothing is turned. Draws what is there of grains and meshes; false if there
// is no mesh. Errors: BadInput for a dump without radius or velocity;
// std::runtime_error if the file cannot be written.
bool draw_rig(const std::string& run, const TurningRotor* rotor, const std::string& path);

// The same for every dump of RUN/vtk, of a rotor for those of its last whole
// turn, with one scale of speed: a film of WebM (VP9), about four seconds long,
// to be played over and over. Errors: as above, and BadInput for fewer than two
// dumps; without ffmpeg need_film_program() says so before.
void draw_film(const std::string& run, const TurningRotor* rotor, const std::string& path);

// Gives a result the picture and the film of its run's grains, of a rig without a rotor.
void add_grains(const std::string& run, PostResult& result);

// Whether RUN holds a dump of grains.
bool has_dump(const std::string& run);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures for people, drawn with VTK into PNG files. VTK needs a display, even to draw into a file.
#pragma once

#include <string>

#include "rigs/drum/bed_angle.h"
#include "rigs/mixer/mixing_power.h"
#include "rigs/mixer/torque_record.h"
#include "rigs/repose/cone_fit.h"
#include "rigs/shearbox/shear_result.h"

namespace vielto {

// Errors: BadInput if there is no display (VTK would abort the program).
void need_display();

// Torque of the grains on the whole shaft (slice torque times N/k) over time, its turn means, and the averaged turns
// shaded. Errors: std::runtime_error if the file cannot be written.
void draw_torque(const TorqueRecord& record, const MixingPower& power, const std::string& path);

// The grains of the last dump in RUN/vtk (`dump custom/vtk` with v and radius), coloured by speed, in the meshes of
// RUN/mesh: the drum translucent, every other part turned about the x axis to where the rotor stood. False if there is
// no dump or no drum. Errors: BadInput for a dump without radius or velocity; std::runtime_error if the file cannot be
// written.
bool draw_grains(const std::string& run, const TorqueRecord& record, const std::string& path);

// Shear stress and the plate's force over its area against the displacement: rows thin, block means thick, the steady
// part shaded. Errors: std::runtime_error if the file cannot be written.
void draw_shear(const ShearRecord& record, const ShearResult& result, const std::string& path);

// The heap's profile: the surface of all strips, their mean, the fitted line, the flank shaded. Errors as above.
void draw_heap(const Heap& heap, const ConeFit& fit, const std::string& path);
// The angle of the bed in a drum at each look. Errors as above.
void draw_bed(const BedAngle& bed, const std::string& path);

// The same of any rig, whatever is there of grains and meshes; without a record nothing is turned. False if there is no
// mesh. Errors: as draw_grains.
bool draw_rig(const std::string& run, const TorqueRecord* record, const std::string& path);

}  // namespace vielto

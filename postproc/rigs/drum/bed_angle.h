// SPDX-License-Identifier: GPL-2.0-or-later
// Dynamic angle of the bed in a rotating drum, from looks at its grains: bed_1.csv ... bed_N.csv of cases/drum, schema
// 1, lines `# key=value`, then x_m,y_m,z_m,radius_m of each grain. The drum's axis is x; gravity is (-sin tilt, 0, -cos
// tilt).
//
// Angle: the slope of the straight line through the free surface seen along the axis, in the plane across it
// (drum_surface_angle in bed_shape.h), over the grains of the whole drum where the axis lies level, and of
// those that show through the lower end face (centre within kEndDiameters grain diameters of x = 0) where it is tilted.
// Its mean over the looks, u with the autocorrelated scatter over time (over_time).
// Shape of the surface (free_surface.h): its contour in the looks' mean picture, the three slopes of that contour and
// the dark part of the drum's section. u: the looks in kBlocks blocks one after the other, the scatter of the blocks'
// own values over sqrt(kBlocks). Only where the axis lies level, the looks are three or more for each block and the
// surface reaches across the windows.
//
// Errors: BadInput as record_file.h, for looks that are not all there or of different runs, and for a surface of less
// than four strips.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rigs/drum/bed_shape.h"
#include "rigs/drum/free_surface.h"
#include "rigs/run_result.h"

namespace vielto {

constexpr double kEndDiameters = 1.5;
constexpr int kBlocks = 6;

struct BedHeader : RunHeader {
  double speed = 0, fill = 0, tilt = 0;       // 1/s, 1, deg
  double drum_diameter = 0, drum_length = 0;  // m
};

struct BedLook {
  double turn = 0;
  Estimate angle;  // deg
};

struct BedSurface {
  std::vector<SurfacePoint> points;
  SurfaceAngles angles, u;  // deg
  Estimate area;            // 1, of the drum's section
};

struct BedAngle {
  BedHeader header;
  std::size_t grains = 0;
  std::vector<BedLook> looks;
  Estimate angle;  // deg
  std::optional<BedSurface> surface;
  std::string no_surface;   // why there is none
  std::vector<Grain> last;  // grains of the last look that were looked at
};

// `path`: bed_1.csv of a run folder.
BedAngle read_bed_angle(const std::string& path);

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/drum/bed_angle.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/record_file.h"

namespace vielto {
namespace {

struct Look {
  BedHeader header;
  int frames = 0;
  double turn = 0;
  std::vector<Grain> grains;
};

Look read_look(const std::string& path) {
  RecordFile file(path, "a run folder or its bed_1.csv");
  const Keys& keys = file.keys();
  Look look;
  BedHeader& h = look.header;
  read_run_header(keys, h);
  h.speed = keys.number("speed", 0, true);
  h.fill = keys.number("fill", 0, true);
  h.tilt = keys.number("tilt", 0);
  h.drum_diameter = keys.number("drum_diameter", 0, true);
  h.drum_length = keys.number("drum_length", 0, true);
  look.frames = keys.integer("frames", 1);
  look.turn = keys.number("turn", 0);
  look.grains = read_grains(file, path);
  return look;
}

// Mean and scatter of the mean of the blocks' values.
Estimate over_blocks(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

// Looks -> the surface of their mean picture, and its scatter over blocks of them.
class SurfaceOverTime {
 public:
  SurfaceOverTime(int looks, double radius)
      : looks_(looks), radius_(radius), whole_(radius), blocks_(kBlocks, Silhouette(radius)) {}

  void add(int look, const std::vector<Grain>& grains) {
    whole_.add_look(grains);
    blocks_[static_cast<std::size_t>(look * kBlocks / looks_)].add_look(grains);
  }

  BedSurface result() const {
    BedSurface surface;
    surface.points = whole_.surface();
    surface.angles = surface_angles(surface.points, radius_);
    std::vector<SurfaceAngles> angles;
    std::vector<double> areas;
    for (const Silhouette& block : blocks_) {
      angles.push_back(surface_angles(block.surface(), radius_));
      areas.push_back(block.dark_area());
    }
    for (const SurfaceWindow& window : kSurfaceWindows) {
      std::vector<double> values;
      for (const SurfaceAngles& a : angles) values.push_back(a.*window.angle);
      surface.u.*window.angle = over_blocks(values).u;
    }
    surface.area = {whole_.dark_area(), over_blocks(areas).u};
    return surface;
  }

 private:
  int looks_;
  double radius_;
  Silhouette whole_;
  std::vector<Silhouette> blocks_;
};

}  // namespace

BedAngle read_bed_angle(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  BedAngle bed;
  int frames = 1;
  std::vector<Estimate> angles;
  std::optional<SurfaceOverTime> surface;
  for (int k = 1; k <= frames; ++k) {
    const std::string file = (folder / fmt::format("bed_{}.csv", k)).string();
    Look look = read_look(file);
    if (k == 1) {
      bed.header = look.header;
      bed.grains = look.grains.size();
      frames = look.frames;
      if (look.header.tilt != 0)
        bed.no_surface = "the axis is tilted";
      else if (frames < 3 * kBlocks)
        bed.no_surface = fmt::format("less than {} looks", 3 * kBlocks);
      else
        surface.emplace(frames, look.header.drum_diameter / 2);
    } else if (look.header.seed != bed.header.seed || look.header.tilt != bed.header.tilt ||
               look.grains.size() != bed.grains || look.frames != frames || !(look.turn > bed.looks.back().turn)) {
      throw BadInput(file, 0, "is not of the run that bed_1.csv is of", "run the case again");
    }
    std::vector<Grain> seen;
    for (const Grain& g : look.grains)
      if (bed.header.tilt == 0 || g.x[0] < kEndDiameters * bed.header.grain_diameter) seen.push_back(g);
    try {
      angles.push_back(drum_surface_angle(seen, bed.header.drum_diameter / 2));
    } catch (const std::invalid_argument& e) {
      throw BadInput(file, 0, e.what(), "use finer grains or more fill");
    }
    if (surface) surface->add(k - 1, seen);
    bed.looks.push_back({look.turn, angles.back()});
    bed.last = std::move(seen);
  }
  bed.angle = over_time(angles);
  if (surface) try {
      bed.surface = surface->result();
    } catch (const std::invalid_argument& e) {
      bed.no_surface = e.what();
    }
  return bed;
}

}  // namespace vielto

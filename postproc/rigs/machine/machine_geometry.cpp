// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/machine/machine_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "core/bad_input.h"
#include "geometry/bodies.h"
#include "geometry/room.h"
#include "rigs/machine/machine_parts.h"

namespace vielto {
namespace {

constexpr double kPlay = 1.03;                        // distance of places over the largest grain's diameter
constexpr double kLeftOut = 0.05;                     // share of places
constexpr double kDensestBed = 0.74;                  // bulk over grain density: no bed is denser
constexpr double kWedgedFrom = 0.3, kWedgedTo = 1.5;  // clearance over the grain's diameter
constexpr double kClearanceTolerance = 5e-4;          // of the rotor's radius

struct Bed {
  double fill = 0, mass = 0;         // of the vessel's volume; kg, in its place if not 0
  double diameter = 0, largest = 0;  // m
  unsigned seed = 1;
  bool empty() const { return fill == 0 && mass == 0; }
  double mean_grain(double spread) const { return kPi / 6 * std::pow(diameter, 3) * (1 + 3 * spread * spread); }
};

// Farthest reach of a turning point in a direction, over a whole turn.
double reach(const Point& p, const TurnAxis& axis, const Point& direction) {
  const double s = p.dot(axis.direction), r = (p - s * axis.direction).norm(), cosine = axis.direction.dot(direction);
  return s * cosine + r * std::sqrt(std::max(0.0, 1 - cosine * cosine));
}

struct Rotor {
  Triangles all, free;  // free: without what passes through walls
  Triangles closed;     // the closed parts
  double radius = 0;    // m, of `free`, or of all
  double volume = 0;    // m3, of its closed parts
};

Rotor rotor_of(const MachineParts& machine) {
  Rotor rotor;
  rotor.all = machine.of(true), rotor.free = machine.of(true, false);
  for (const Triangle& t : rotor.free.empty() ? rotor.all : rotor.free)
    for (const Point& p : t)
      rotor.radius = std::max(rotor.radius, (p - p.dot(machine.axis.direction) * machine.axis.direction).norm());
  for (const MachinePart& part : machine.parts)
    if (part.turns && part.mesh.measure.open_edges == 0) {
      rotor.volume += part.mesh.measure.volume;
      rotor.closed.insert(rotor.closed.end(), part.mesh.triangles.begin(), part.mesh.triangles.end());
    }
  return rotor;
}

std::vector<Point> points_of(const Triangles& triangles) {
  std::vector<Point> points;
  for (const Triangle& t : triangles) {
    points.insert(points.end(), t.begin(), t.end());
    points.push_back((t[0] + t[1] + t[2]) / 3);
  }
  return points;
}

// The two parts that come nearest to each other: what turns, what stands.
std::pair<std::string, std::string> nearest_parts(const MachineParts& machine, double tolerance) {
  std::pair<std::string, std::string> names;
  double least = INFINITY;
  for (const MachinePart& turning : machine.parts)
    for (const MachinePart& standing : machine.parts) {
      if (!turning.turns || turning.through || standing.turns) continue;
      const double gap =
          turn_clearance(standing.mesh.triangles, turning.mesh.triangles, machine.axis, tolerance).distance;
      if (gap < least) least = gap, names = {turning.name, standing.name};
    }
  return names;
}

std::optional<TurnClearance> checked_clearance(const MachineParts& machine, const Rotor& rotor) {
  if (rotor.free.empty()) return {};
  const TurnClearance gap =
      turn_clearance(machine.of(false), rotor.free, machine.axis, std::max(2e-6, kClearanceTolerance * rotor.radius));
  if (gap.distance <= gap.tolerance) {
    const auto [turning, standing] = nearest_parts(machine, gap.tolerance);
    throw BadInput(machine.path, 0,
                   fmt::format("part {} meets {} within a turn, {:.4f} m along the axis and {:.4f} m from it", turning,
                               standing, gap.s, gap.r),
                   "mend axis, unit or parts; a shaft that runs through a wall is marked through = true");
  }
  return gap;
}

void check_rim(const MachineParts& machine, const Room& room) {
  if (!room.rim()) return;
  for (const MachinePart& part : machine.parts) {
    if (!part.turns || part.through) continue;
    double highest = -INFINITY;
    for (const Triangle& t : part.mesh.triangles)
      for (const Point& p : t) highest = std::max(highest, reach(p, machine.axis, Point::UnitZ()));
    if (highest > *room.rim())
      throw BadInput(
          part.file, 0,
          fmt::format("part {} rises {:.4g} m over the rim of the vessel, which it would throw grain out of", part.name,
                      highest - *room.rim()),
          "give the vessel's lid as a part that stands, or mark a drive that comes from above through = true");
  }
}

std::vector<Point> places(const Room& room, const Triangles& all, const Triangles& closed, const Bed& bed,
                          std::size_t most) {
  const SurfaceDistance distance(all);
  Bodies bodies(closed);
  const double a = kPlay * bed.largest, play = 0.5 * (a - bed.largest), radius = 0.5 * bed.largest;
  const double row = a * std::sqrt(3.0) / 2, layer = a * std::sqrt(2.0 / 3.0);
  const Measure extent = measure(all);
  std::mt19937 random(bed.seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Point> found;
  const auto count = [](double length, double step) { return static_cast<int>(std::ceil(length / step)) + 1; };
  const Point size = extent.high - extent.low;
  const double top = room.top();
  int k = 0;
  for (double z = extent.low.z(); z < top && found.size() < most; z += layer, ++k)
    for (int j = 0; j < count(size.y(), row); ++j)
      for (int i = 0; i < count(size.x(), a); ++i) {
        Point p(extent.low.x() + a * (i + 0.5 * ((j + k) % 2)), extent.low.y() + row * (j + (k % 2) / 3.0), z);
        Point moved(unit(random), unit(random), unit(random));
        const bool left_out = std::fabs(unit(random)) < kLeftOut;
        if (moved.norm() > 1) moved.normalize();
        p += play * moved;
        if (!left_out && room.holds(p, radius) && !distance.within(p, radius) && !bodies.hold(p)) found.push_back(p);
      }
  std::sort(found.begin(), found.end(), [](const Point& p, const Point& q) { return p.z() < q.z(); });
  if (found.size() > most) found.resize(most);
  return found;
}

std::string places_text(const std::vector<Point>& points) {
  std::string text = "x_m,y_m,z_m\n";
  for (const Point& p : points) text += fmt::format("{:.9g},{:.9g},{:.9g}\n", p.x(), p.y(), p.z());
  return text;
}

std::string what(const MachinePart& part) {
  const Measure& m = part.mesh.measure;
  std::string text = fmt::format("{} {}: {} triangles, area {:.4g} m2, ", part.name, part.turns ? "turns" : "stands",
                                 m.triangles, m.area);
  text += m.open_edges == 0 ? fmt::format("volume {:.4g} m3", std::fabs(m.volume))
                            : fmt::format("open ({} edges)", m.open_edges);
  text += fmt::format(", x {:.4g} to {:.4g}, y {:.4g} to {:.4g}, z {:.4g} to {:.4g} m", m.low.x(), m.high.x(),
                      m.low.y(), m.high.y(), m.low.z(), m.high.z());
  for (const std::string& mend : part.mesh.mended) text += "; " + mend;
  return text;
}

void add_box(RigGeometry& g, const MachineParts& machine, double margin) {
  const Measure standing = measure(machine.of(false));
  for (int d = 0; d < 3; ++d) {
    const Point e = Point::Unit(d);
    double low = standing.low[d], high = standing.high[d];
    for (const Triangle& t : machine.of(true))
      for (const Point& p : t) {
        high = std::max(high, reach(p, machine.axis, e));
        low = std::min(low, -reach(p, machine.axis, -e));
      }
    g.derived.emplace_back(fmt::format("box{}0", "XYZ"[d]), fmt::format("{:.12g}", low - margin));
    g.derived.emplace_back(fmt::format("box{}1", "XYZ"[d]), fmt::format("{:.12g}", high + margin));
  }
}

// Numbered names for `vielto repeat`, and words for the fixes.
void add_parts(RigGeometry& g, const MachineParts& machine) {
  std::string meshes, turning, words;
  int count = 0, turn = 0;
  for (const MachinePart& part : machine.parts) {
    g.derived.emplace_back(fmt::format("part{}", ++count), part.name);
    meshes += fmt::format(" part_{}", part.name);
    words += fmt::format(" {} {} part_{}", part.turns ? "part" : "standing", part.name, part.name);
    if (!part.turns) continue;
    g.derived.emplace_back(fmt::format("turning{}", ++turn), part.name);
    turning += fmt::format(" part_{}", part.name);
  }
  const auto quoted = [](const std::string& list) { return "\"" + list.substr(1) + "\""; };
  g.derived.insert(g.derived.end(), {{"partCount", fmt::format("{}", count)},
                                     {"turningCount", fmt::format("{}", turn)},
                                     {"meshList", quoted(meshes)},
                                     {"turningList", quoted(turning)},
                                     {"recordParts", quoted(words)}});
}

nlohmann::ordered_json told(const MachineParts& machine, const Room& room, const Rotor& rotor,
                            const std::optional<TurnClearance>& gap) {
  nlohmann::ordered_json parts;
  for (const MachinePart& part : machine.parts) {
    const Measure& m = part.mesh.measure;
    parts[part.name] = {{"file", part.file},
                        {"turns", part.turns},
                        {"triangles", m.triangles},
                        {"area_m2", m.area},
                        {"volume_m3", m.open_edges == 0 ? nlohmann::ordered_json(std::fabs(m.volume)) : nullptr},
                        {"low_m", {m.low.x(), m.low.y(), m.low.z()}},
                        {"high_m", {m.high.x(), m.high.y(), m.high.z()}},
                        {"mended", part.mesh.mended}};
  }
  using Json = nlohmann::ordered_json;
  return {{"schema", 1},
          {"parts_file", machine.path},
          {"vessel_volume_m3", room.volume()},
          {"rim_m", room.rim() ? Json(*room.rim()) : Json(nullptr)},
          {"rotor_volume_m3", rotor.volume},
          {"rotor_radius_m", rotor.radius},
          {"clearance_m", gap ? Json(gap->distance) : Json(nullptr)},
          {"clearance_tolerance_m", gap ? Json(gap->tolerance) : Json(nullptr)},
          {"axis", {machine.axis.direction.x(), machine.axis.direction.y(), machine.axis.direction.z()}},
          {"parts", parts}};
}

}  // namespace

RigGeometry machine_geometry(GeometryInput& input) {
  MachineParts machine = read_machine_parts(input.file("parts"));
  Bed bed;
  bed.fill = input.not_negative("fill");
  bed.mass = input.not_negative("mass");
  bed.diameter = input.positive("grainDiameter");
  const double spread = input.not_negative("grainSpread");
  bed.largest = bed.diameter * (1 + spread * std::sqrt(3.0));
  bed.seed = static_cast<unsigned>(input.count("seed", 1, 1000));
  const double stated_volume = input.not_negative("vesselVolume"), stated_lever = input.not_negative("powerLever");

  const Rotor rotor = rotor_of(machine);
  const std::optional<TurnClearance> gap = checked_clearance(machine, rotor);
  const Room room(machine.of(false), points_of(rotor.free.empty() ? rotor.all : rotor.free));
  if (!room.found())
    throw BadInput(machine.path, 0, "what turns does not lie in a vessel that holds grain",
                   "mend up, the parts' common frame, or a hole in the vessel's bottom");
  check_rim(machine, room);
  if (stated_volume > 0 && std::fabs(room.volume() / stated_volume - 1) > kMostVolumeDifference)
    input.refuse("vesselVolume", fmt::format("the meshes hold {:.5g} m3", room.volume()),
                 "state the volume without the rotor, up to the rim, or mend unit or parts; 0 takes the meshes'");
  const double volume = stated_volume > 0 ? stated_volume : room.volume();
  if (bed.fill * volume > room.volume() - rotor.volume)
    input.refuse("fill", fmt::format("the rotor leaves {:.3g} of the vessel", 1 - rotor.volume / room.volume()),
                 "state a smaller fill");

  RigGeometry g;
  for (MachinePart& part : machine.parts) {
    if (!part.turns && !room.shows_front(part.mesh.triangles))
      for (Triangle& t : part.mesh.triangles) std::swap(t[1], t[2]);
    g.parts.push_back({part.name, part.turns ? "paddle" : "drum", part.turns, part.mesh.triangles});
    g.inputs.push_back(part.file);
    g.notes.push_back(what(part));
  }
  g.derived = {{"axisX", fmt::format("{:.15g}", machine.axis.direction.x())},
               {"axisZ", fmt::format("{:.15g}", machine.axis.direction.z())},
               {"vesselHolds", fmt::format("{:.9g}", volume)},
               {"vesselOpen", room.rim() ? "1" : "0"},
               {"rimHeight", fmt::format("{:.9g}", room.top())},
               {"rotorRadius", fmt::format("{:.9g}", rotor.radius)},
               {"lever", fmt::format("{:.9g}", stated_lever > 0 ? stated_lever : rotor.radius)}};
  add_box(g, machine, 2 * bed.largest);
  add_parts(g, machine);
  g.notes.push_back(fmt::format(
      "vessel holds {:.5g} dm3 {}, the rotor takes {:.4g} dm3 and reaches {:.4g} m from its axis", room.volume() * 1e3,
      room.rim() ? fmt::format("up to its rim, {:.4g} m over the axis' origin", *room.rim()) : "and is closed",
      rotor.volume * 1e3, rotor.radius));
  if (gap) {
    g.notes.push_back(
        fmt::format("least clearance over a turn {:.3f} mm (to {:.3f} mm), {:.3g} m along the axis and "
                    "{:.3g} m from it",
                    gap->distance * 1e3, gap->tolerance * 1e3, gap->s, gap->r));
    if (gap->distance > kWedgedFrom * bed.diameter && gap->distance < kWedgedTo * bed.diameter)
      g.notes.push_back(
          fmt::format("note: the clearance is {:.2g} grain diameters, where grain gets wedged; below a diameter of "
                      "{:.2g} m it passes, over {:.2g} m most is kept out",
                      gap->distance / bed.diameter, gap->distance / kWedgedTo, gap->distance / kWedgedFrom));
  }
  std::vector<Point> found;
  if (!bed.empty()) {
    const double needed = kDensestBed * bed.fill * volume / bed.mean_grain(spread);
    Triangles all = machine.of(false);
    all.insert(all.end(), rotor.all.begin(), rotor.all.end());
    found = places(room, all, rotor.closed, bed, bed.mass > 0 ? SIZE_MAX : static_cast<std::size_t>(needed) + 1);
    g.notes.push_back(fmt::format("{} places for grain of up to {:.3g} mm", found.size(), bed.largest * 1e3));
  }
  g.derived.emplace_back("places", fmt::format("{}", found.size()));
  g.files = {{"places.csv", places_text(found)}, {"machine.json", told(machine, room, rotor, gap).dump(2) + "\n"}};
  return g;
}

}  // namespace vielto

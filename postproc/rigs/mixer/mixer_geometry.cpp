// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/mixer/mixer_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rigs/torque_record.h"

namespace vielto {
namespace {

constexpr int kMostSegments = 360;
constexpr double kNoEndWall = 1000;  // m

struct Mixer {
  double drum_length, drum_radius, drum_top;
  double paddle_length, paddle_width, paddle_thickness, inclination, angle_step, clearance;
  double stem_width, stem_thickness, stem_overlap, shaft_radius;
  std::string handing;
  int drum_segments, shaft_segments;
  bool periodic;  // a slice, else the whole drum
  int paddles;    // in the mesh
  double length;  // of the mesh along x
  double pitch;   // axial distance of the paddles
  double tip() const { return drum_radius - clearance; }
};

struct Rotor {
  std::vector<Surface> paddles, stems;
  std::vector<double> angles;  // deg
  Surface shaft;
};

Mixer read_mixer(GeometryInput& input) {
  Mixer m;
  m.drum_length = input.positive("drumLength");
  m.drum_radius = input.positive("drumWidth") / 2;
  m.drum_top = input.positive("drumHeight") - m.drum_radius;
  const int paddle_count = input.count("paddleCount", 1, 1000);
  m.paddle_length = input.positive("paddleLength");
  m.paddle_width = input.positive("paddleWidth");
  m.paddle_thickness = input.positive("paddleThickness");
  m.inclination = input.number("paddleInclination") * kPi / 180;
  m.handing = input.choice("paddleHanding", {"uniform", "alternating", "mirrored"});
  const double pitch_of_whole = input.positive("paddlePitch");
  m.angle_step = input.number("paddleAngleStep");
  m.clearance = input.not_negative("clearance");
  m.stem_width = input.positive("stemWidth");
  m.stem_thickness = input.positive("stemThickness");
  m.stem_overlap = input.positive("stemOverlap");
  m.shaft_radius = input.positive("shaftDiameter") / 2;
  const int slice = input.count("slicePaddles", 0, paddle_count);
  m.drum_segments = input.count("drumSegments", 3, kMostSegments);
  m.shaft_segments = input.count("shaftSegments", 3, kMostSegments);

  m.periodic = slice > 0;
  m.paddles = m.periodic ? slice : paddle_count;
  m.length = m.periodic ? slice * m.drum_length / paddle_count : m.drum_length;
  m.pitch = m.periodic ? m.length / slice : pitch_of_whole;

  if (slice == 1)
    input.refuse("slicePaddles", "a paddle would overlap its own periodic image", "state 0, or 2 or more");
  if (slice % 2 == 1 && m.handing != "uniform")
    input.refuse("slicePaddles", fmt::format("an odd number of paddles of handing '{}' does not repeat", m.handing),
                 "state an even slicePaddles, or paddleHanding uniform");
  if (m.drum_top <= 0)
    input.refuse("drumHeight", "the drum is lower than its half circle", "state a drumHeight above drumWidth/2");
  if (m.stem_overlap >= m.paddle_width)
    input.refuse("stemOverlap", "the stem reaches to the paddle's tip", "state a stemOverlap below paddleWidth");
  if (m.tip() - m.paddle_width <= m.shaft_radius)
    input.refuse("shaftDiameter", "the paddles reach into the shaft", "state a smaller shaftDiameter or paddleWidth");
  if (m.stem_width / 2 >= m.shaft_radius * std::cos(kPi / m.shaft_segments))
    input.refuse("stemWidth", "the stem is wider than the shaft", "state a stemWidth below shaftDiameter");
  return m;
}

int hand(const Mixer& m, int i) {
  if (m.handing == "alternating") return i % 2 == 0 ? 1 : -1;
  if (m.handing == "mirrored") return 2 * i < m.paddles ? 1 : -1;
  return 1;
}

Rotor make_rotor(const Mixer& m) {
  Rotor rotor;
  // A stem begins half-way down inside the shaft, too deep for a grain to feel its end, and ends over the paddle.
  const double shaft_flat = m.shaft_radius * std::cos(kPi / m.shaft_segments);
  const double stem_start = std::sqrt(shaft_flat * shaft_flat - m.stem_width * m.stem_width / 4) / 2;
  const double stem_end = m.tip() - m.paddle_width + m.stem_overlap;
  const Point x(1, 0, 0);
  for (int i = 0; i < m.paddles; ++i) {
    rotor.angles.push_back(std::fmod(i * m.angle_step, 360.0));
    const double angle = rotor.angles.back() * kPi / 180;
    const Point radial(0, std::cos(angle), std::sin(angle));
    const Point ahead = x.cross(radial);  // the way a point at this angle moves
    const double tilt = hand(m, i) * m.inclination;
    const Point along = std::cos(tilt) * x - std::sin(tilt) * ahead;
    const Point face = std::cos(tilt) * ahead + std::sin(tilt) * x;
    const Point foot = (m.length / 2 + (i - (m.paddles - 1) / 2.0) * m.pitch) * x;
    rotor.paddles.push_back(box(foot + (m.tip() - m.paddle_width / 2) * radial, m.paddle_length / 2 * along,
                                m.paddle_width / 2 * radial, m.paddle_thickness / 2 * face));
    rotor.stems.push_back(box(foot + (stem_start + stem_end) / 2 * radial, m.stem_thickness / 2 * x,
                              (stem_end - stem_start) / 2 * radial, m.stem_width / 2 * ahead));
  }
  const double chord = 2 * m.shaft_radius * std::sin(kPi / m.shaft_segments);
  rotor.shaft =
      sweep(arc(m.shaft_radius, 0, 2 * kPi, m.shaft_segments), true, 0, m.length, strip_pieces(m.length, chord));
  return rotor;
}

// A paddle may touch its own stem only.
void refuse_touching_paddles(const Mixer& m, const Rotor& rotor, const GeometryInput& input) {
  const int images = m.periodic ? 1 : 0;
  for (int i = 0; i < m.paddles; ++i)
    for (int j = 0; j < m.paddles; ++j)
      for (int image = -images; image <= images; ++image) {
        if (i == j && image == 0) continue;
        const Surface other = moved(rotor.paddles[j], {image * m.length, 0, 0});
        if (overlap(rotor.paddles[i], other) || overlap(rotor.stems[i], other))
          input.refuse("paddleAngleStep", fmt::format("paddles {} and {} of the mesh intersect", i + 1, j + 1),
                       "state another paddleAngleStep, or a shorter paddle");
      }
}

// The drum's faces, and those that only close its volume: the lid, and in a slice the ends.
struct Drum {
  Surface walls, lid, ends;
};

Drum make_drum(const Mixer& m) {
  std::vector<Eigen::Vector2d> outline{{m.drum_radius, m.drum_top}};
  const auto chords = arc(m.drum_radius, kPi, kPi, m.drum_segments);
  outline.insert(outline.end(), chords.rbegin(), chords.rend());  // clockwise: normals towards the grains
  outline.emplace_back(-m.drum_radius, m.drum_top);
  const int pieces = strip_pieces(m.length, 2 * m.drum_radius * std::sin(kPi / (2 * m.drum_segments)));
  return {sweep(outline, false, 0, m.length, pieces),
          sweep({outline.back(), outline.front()}, false, 0, m.length, pieces),
          {plate(outline, 0, true), plate(outline, m.length, false)}};
}

// Distance of the x axis from the triangle, seen along the axis (the axis does not pierce it).
double distance_from_axis(const Triangle& t) {
  double nearest = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d p = t[i].tail<2>(), d = t[(i + 1) % 3].tail<2>() - p;
    const double s = d.squaredNorm() > 0 ? std::clamp(-p.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (p + s * d).norm());
  }
  return nearest;
}

// Least distance along the axis between the outer paddles and the end walls; infinite in a slice, which has none.
/* Into how many equal parts a turn falls after each of which a slice looks as before, but for a shift along the shaft:
   its paddles, all inclined the same way, stand at each of these angles equally often. 1 with end walls, and where a
   record's phases would reach over two parts. */
int turn_parts(const Mixer& m) {
  if (!m.periodic || m.handing != "uniform") return 1;
  for (int parts = std::min(m.paddles, kPhases); parts > 1; --parts)
    if (kPhases % parts == 0 && m.paddles % parts == 0 && std::fabs(std::fabs(m.angle_step) * parts - 360) < 1e-9)
      return parts;
  return 1;
}

double end_gap(const Mixer& m, const Triangles& blades, const GeometryInput& input) {
  if (m.periodic) return INFINITY;
  const Measure extent = measure(blades);
  const double gap = std::min(extent.low.x(), m.length - extent.high.x());
  if (gap <= 0)
    input.refuse("paddlePitch", fmt::format("the outer paddles pierce the end walls by {:.6f} m", -gap),
                 "state a smaller paddlePitch");
  return gap;
}

// Least distance between the drum's round wall and the body the rotor sweeps: every angle of the rotor passes every
// chord.
double true_clearance(const Mixer& m, const Triangles& walls, double tip_radius, const GeometryInput& input) {
  double gap = INFINITY;
  for (const Triangle& t : walls) gap = std::min(gap, distance_from_axis(t) - tip_radius);
  if (gap <= 0) {
    const double ratio = tip_radius / m.drum_radius;
    const int enough = ratio < 1 ? static_cast<int>(std::floor(kPi / (2 * std::acos(ratio)))) + 1 : kMostSegments + 1;
    if (enough > kMostSegments)
      input.refuse("clearance",
                   fmt::format("the rotor's largest radius {:.6f} m leaves no room in the drum's {:.6f} m (a paddle's "
                               "corners stick out beyond its tip)",
                               tip_radius, m.drum_radius),
                   "state a larger clearance");
    input.refuse("drumSegments",
                 fmt::format("the chords eat up the clearance, the rotor would cut the drum by {:.6f} m", -gap),
                 fmt::format("state {} drumSegments or more", enough));
  }
  return gap;
}

Surface joined(const std::vector<Surface>& bodies) {
  Surface all;
  for (const Surface& body : bodies) append(all, body);
  return all;
}

}  // namespace

RigGeometry mixer_geometry(GeometryInput& input) {
  const Mixer m = read_mixer(input);
  const Rotor rotor = make_rotor(m);
  refuse_touching_paddles(m, rotor, input);
  const Drum drum = make_drum(m);

  Surface blades = joined(rotor.stems);
  append(blades, joined(rotor.paddles));
  const Triangles blade_faces = triangulate(blades);
  const double tip_radius = largest_radius(blade_faces);
  const double ends = end_gap(m, blade_faces, input);
  const double gap = std::min(true_clearance(m, triangulate(drum.walls), tip_radius, input), ends);

  RigGeometry g;
  const auto in_the_box = [&m](const Surface& s) { return triangulate(m.periodic ? wrap(s, m.length) : s); };
  Surface drum_faces = drum.walls;
  if (!m.periodic) append(drum_faces, drum.ends);
  g.parts.push_back({"drum", "drum", false, triangulate(drum_faces)});
  g.parts.push_back({"shaft", "shaft", true, triangulate(rotor.shaft)});
  g.parts.push_back({"stems", "stems", true, in_the_box(joined(rotor.stems))});
  if (m.periodic)
    for (int i = 0; i < m.paddles; ++i)
      g.parts.push_back({fmt::format("paddle_{}", i + 1), "paddle", true, in_the_box(rotor.paddles[i])});
  else
    g.parts.push_back({"paddle_1", "paddle", true, in_the_box(joined(rotor.paddles))});

  const double volume =
      -measure(triangulate(joined({drum.walls, drum.lid, drum.ends}))).volume;  // the normals point inward
  const double section = kPi * m.drum_radius * m.drum_radius / 2 + 2 * m.drum_radius * m.drum_top;
  const double outline = m.length * section;
  const int meshes = m.periodic ? m.paddles : 1;
  std::string list = "paddle1";
  for (int i = 2; i <= meshes; ++i) list += fmt::format(" paddle{}", i);
  g.derived = {{"sliceLength", fmt::format("{:.12g}", m.length)},
               {"rotorTipRadius", fmt::format("{:.12g}", tip_radius)},
               {"drumRadius", fmt::format("{:.12g}", m.drum_radius)},
               {"drumTop", fmt::format("{:.12g}", m.drum_top)},
               {"meshClearance", fmt::format("{:.6g}", gap)},
               // a slice has no end walls: farther than any
               {"endGap", fmt::format("{:.6g}", std::min(ends, kNoEndWall))},
               {"paddleMeshes", fmt::format("{}", meshes)},
               {"paddleList", fmt::format("\"{}\"", list)},
               {"paddleAngles", fmt::format("\"{}\"", fmt::join(rotor.angles, " "))},
               {"turnParts", fmt::format("{}", turn_parts(m))},
               {"meshedDrumVolume", fmt::format("{:.9g}", volume)},
               {"outlineVolume", fmt::format("{:.9g}", m.drum_length * section)}};  // of the whole drum
  g.notes.push_back(fmt::format("drum {:.4f} dm3 in {} chords, outline {:.4f} dm3 ({:.4f} dm3 for the whole drum)",
                                volume * 1e3, m.drum_segments, outline * 1e3,
                                outline * 1e3 * m.drum_length / m.length));
  g.notes.push_back(
      fmt::format("clearance {:.3f} mm stated (paddle tip), {:.3f} mm left between the swept rotor and the drum's mesh",
                  m.clearance * 1e3, gap * 1e3));
  if (m.periodic && std::fabs(std::remainder(m.paddles * m.angle_step, 360.0)) > 1e-9)
    g.notes.push_back(
        fmt::format("note: {} paddles at steps of {} deg do not close a turn, so the angular pattern repeats early",
                    m.paddles, m.angle_step));
  return g;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rig_geometry.h"

namespace vielto {
namespace {

struct Mixer {
  double length;      // meshed length along x
  double pitch;       // axial distance of the paddles
  double first;       // x of the first paddle
  int paddles;        // in the mesh
  bool periodic;
  double radius;      // of the drum's half circle
  double top;         // z of the drum's open rim
};

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

bool is_end_wall(const Triangle& t) { return t[0].x() == t[1].x() && t[1].x() == t[2].x(); }

// The chords' end points from one rim to the other, counterclockwise seen from +x (left rim, bottom, right rim).
std::vector<Eigen::Vector2d> drum_outline(double radius, double top, int segments) {
  std::vector<Eigen::Vector2d> outline{{-radius, top}};
  for (const auto& p : arc(radius, kPi, kPi, segments)) outline.push_back(p);
  outline.emplace_back(radius, top);
  return outline;
}

int handed(const std::string& handing, int i, int count) {
  if (handing == "alternating") return i % 2 == 0 ? 1 : -1;
  if (handing == "mirrored") return 2 * i < count ? 1 : -1;
  return 1;
}

}  // namespace

RigGeometry mixer_geometry(GeometryInput& input) {
  const double drum_length = input.positive("drumLength");
  const double drum_width = input.positive("drumWidth");
  const double drum_height = input.positive("drumHeight");
  const int paddle_count = input.count("paddleCount", 1);
  const double paddle_length = input.positive("paddleLength");
  const double paddle_width = input.positive("paddleWidth");
  const double paddle_thickness = input.positive("paddleThickness");
  const double inclination = input.number("paddleInclination") * kPi / 180;
  const std::string& handing = input.choice("paddleHanding", {"uniform", "alternating", "mirrored"});
  const double paddle_pitch = input.positive("paddlePitch");
  const double angle_step = input.number("paddleAngleStep");
  const double clearance = input.not_negative("clearance");
  const double stem_width = input.positive("stemWidth");
  const double stem_thickness = input.positive("stemThickness");
  const double stem_overlap = input.positive("stemOverlap");
  const double shaft_radius = input.positive("shaftDiameter") / 2;
  const int slice = input.count("slicePaddles", 0);
  const int drum_segments = input.count("drumSegments", 3);
  const int shaft_segments = input.count("shaftSegments", 3);

  Mixer m;
  m.radius = drum_width / 2;
  m.top = drum_height - m.radius;
  m.periodic = slice > 0;
  m.paddles = m.periodic ? slice : paddle_count;
  m.length = m.periodic ? slice * drum_length / paddle_count : drum_length;
  m.pitch = m.periodic ? m.length / slice : paddle_pitch;
  m.first = (m.length - (m.paddles - 1) * m.pitch) / 2;

  if (slice == 1)
    input.refuse("slicePaddles", "'slicePaddles' is 1: a paddle would overlap its own periodic image", "state 0, or 2 or more");
  if (slice > paddle_count)
    input.refuse("slicePaddles", fmt::format("'slicePaddles' is {} of {} paddles", slice, paddle_count),
                 "state 0 for the whole drum, or fewer paddles");
  if (m.periodic && slice % 2 == 1 && handing != "uniform")
    input.refuse("slicePaddles", fmt::format("{} paddles of handing '{}' do not repeat", slice, handing),
                 "state an even slicePaddles, or paddleHanding uniform");
  if (m.top <= 0) input.refuse("drumHeight", "the drum is lower than its half circle", "state a drumHeight above drumWidth/2");

  const double tip = m.radius - clearance;
  const double paddle_centre = tip - paddle_width / 2;
  const double stem_end = tip - paddle_width + stem_overlap;
  const double shaft_apothem = shaft_radius * std::cos(kPi / shaft_segments);
  if (stem_overlap >= paddle_width)
    input.refuse("stemOverlap", "the stem reaches to the paddle's tip", "state a stemOverlap below paddleWidth");
  if (tip - paddle_width <= shaft_radius)
    input.refuse("shaftDiameter", "the paddles reach into the shaft", "state a smaller shaftDiameter or paddleWidth");
  if (stem_width / 2 >= shaft_apothem)
    input.refuse("stemWidth", "the stem is wider than the shaft", "state a stemWidth below shaftDiameter");

  // Rotor. The stem begins half-way down inside the shaft, too deep for a grain to feel its end, and ends over the paddle.
  const double stem_start = std::sqrt(shaft_apothem * shaft_apothem - stem_width * stem_width / 4) / 2;
  const Point x(1, 0, 0);
  std::vector<Surface> paddles, stems;
  std::vector<double> angles;
  for (int i = 0; i < m.paddles; ++i) {
    const double degrees = std::fmod(i * angle_step, 360.0);
    angles.push_back(degrees);
    const double angle = degrees * kPi / 180;
    const Point radial(0, std::cos(angle), std::sin(angle));
    const Point ahead = x.cross(radial);  // the way a point at this angle moves
    const double tilt = handed(handing, i, m.paddles) * inclination;
    const Point along = std::cos(tilt) * x - std::sin(tilt) * ahead;
    const Point face = std::cos(tilt) * ahead + std::sin(tilt) * x;
    const Point at(m.first + i * m.pitch, 0, 0);
    paddles.push_back(box(at + paddle_centre * radial, paddle_length / 2 * along, paddle_width / 2 * radial,
                          paddle_thickness / 2 * face));
    stems.push_back(box(at + (stem_start + stem_end) / 2 * radial, stem_thickness / 2 * x,
                        (stem_end - stem_start) / 2 * radial, stem_width / 2 * ahead));
  }

  // A paddle may touch its own stem only.
  const int images = m.periodic ? 1 : 0;
  for (int i = 0; i < m.paddles; ++i)
    for (int j = 0; j < m.paddles; ++j)
      for (int image = -images; image <= images; ++image) {
        if (i == j && image == 0) continue;
        const Surface other = moved(paddles[j], image * m.length * x);
        if (overlap(paddles[i], other) || overlap(stems[i], other))
          input.refuse("paddleAngleStep", fmt::format("paddles {} and {} of the mesh intersect", i + 1, j + 1),
                       "state another paddleAngleStep, or a shorter paddle");
      }

  const double shaft_chord = 2 * shaft_radius * std::sin(kPi / shaft_segments);
  const Surface shaft = sweep(arc(shaft_radius, 0, 2 * kPi, shaft_segments), true, 0, m.length,
                              strip_pieces(m.length, shaft_chord));

  // The drum: counterclockwise would give outward normals, so the outline runs the other way round.
  auto outline = drum_outline(m.radius, m.top, drum_segments);
  auto inward = outline;
  std::reverse(inward.begin(), inward.end());
  const double drum_chord = 2 * m.radius * std::sin(kPi / (2 * drum_segments));
  const int drum_pieces = strip_pieces(m.length, drum_chord);
  Surface drum = sweep(inward, false, 0, m.length, drum_pieces);
  const Surface end_walls{plate(outline, 0, true), plate(outline, m.length, false)};
  Surface closed_drum = drum;
  append(closed_drum, end_walls);
  // the lid only closes the volume: it is not written
  append(closed_drum, sweep({inward.back(), inward.front()}, false, 0, m.length, drum_pieces));
  if (!m.periodic) append(drum, end_walls);

  RigGeometry g;
  g.parts.push_back({"drum", "drum", false, triangulate(drum)});
  g.parts.push_back({"shaft", "shaft", true, triangulate(shaft)});
  Surface all_stems, all_paddles;
  for (const Surface& stem : stems) append(all_stems, stem);
  for (const Surface& paddle : paddles) append(all_paddles, paddle);
  const auto wrapped = [&m](const Surface& s) { return triangulate(m.periodic ? wrap(s, m.length) : s); };
  g.parts.push_back({"stems", "stems", true, wrapped(all_stems)});
  if (m.periodic)
    for (std::size_t i = 0; i < paddles.size(); ++i)
      g.parts.push_back({fmt::format("paddle_{}", i + 1), "paddle", true, wrapped(paddles[i])});
  else
    g.parts.push_back({"paddle_1", "paddle", true, wrapped(all_paddles)});

  // True clearance, from the meshes: every angle of the rotor passes every chord.
  const Triangles rotor = triangulate([&] { Surface s = all_stems; append(s, all_paddles); return s; }());
  const double tip_radius = std::max(largest_radius(rotor), largest_radius(g.parts[1].triangles));
  double gap = INFINITY;
  for (const Triangle& t : g.parts[0].triangles)
    if (!is_end_wall(t)) gap = std::min(gap, distance_from_axis(t) - tip_radius);
  if (gap <= 0) {
    if (tip_radius >= m.radius)
      input.refuse("clearance", fmt::format("the rotor's largest radius {:.6f} m is not below the drum's {:.6f} m (a paddle's corners "
                                            "stick out beyond its tip)", tip_radius, m.radius), "state a larger clearance");
    const int enough = static_cast<int>(std::floor(kPi / (2 * std::acos(tip_radius / m.radius)))) + 1;
    input.refuse("drumSegments", fmt::format("{} chords eat up the clearance: the rotor would cut the drum by {:.6f} m", drum_segments,
                                             -gap), fmt::format("state {} drumSegments or more", enough));
  }
  if (!m.periodic) {
    const Measure extent = measure(rotor);
    const double end_gap = std::min(extent.low.x(), m.length - extent.high.x());
    if (end_gap <= 0)
      input.refuse("paddlePitch", fmt::format("the outer paddles pierce the end walls by {:.6f} m", -end_gap),
                   "state a smaller paddlePitch");
    gap = std::min(gap, end_gap);
  }

  const double meshed_volume = measure(triangulate(closed_drum)).volume;
  // inward normals: the divergence theorem gives minus the volume
  g.derived = {{"sliceLength", fmt::format("{:.12g}", m.length)},
               {"rotorTipRadius", fmt::format("{:.12g}", tip_radius)},
               {"drumRadius", fmt::format("{:.12g}", m.radius)},
               {"drumTop", fmt::format("{:.12g}", m.top)},
               {"meshClearance", fmt::format("{:.6g}", gap)},
               {"paddleMeshes", fmt::format("{}", m.periodic ? m.paddles : 1)},
               {"paddleAngles", fmt::format("\"{}\"", fmt::join(angles, " "))},
               {"meshedDrumVolume", fmt::format("{:.9g}", -meshed_volume)}};
  const double outline_volume = m.length * (kPi * m.radius * m.radius / 2 + 2 * m.radius * m.top);
  g.notes.push_back(fmt::format("drum {:.4f} dm3 in {} chords, outline {:.4f} dm3 ({:.4f} dm3 for the whole drum)", -meshed_volume * 1e3,
                                drum_segments, outline_volume * 1e3, outline_volume * 1e3 * drum_length / m.length));
  g.notes.push_back(fmt::format("clearance {:.3f} mm stated (paddle tip), {:.3f} mm left between the swept rotor and the chords",
                                clearance * 1e3, gap * 1e3));
  if (m.periodic && std::fabs(std::remainder(slice * angle_step, 360.0)) > 1e-9)
    g.notes.push_back(fmt::format("note: {} paddles at steps of {} deg do not close a turn, so the angular pattern repeats early", slice,
                                  angle_step));
  return g;
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// A ribbon mixer from formulas, and other bodies, as STL files that a machine's parts file names.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace machine_shapes {

using Vertex = std::array<double, 3>;
using Facet = std::array<Vertex, 3>;
using Facets = std::vector<Facet>;

const double pi = std::acos(-1.0);

inline Vertex around_x(double x, double r, double angle) { return {x, r * std::cos(angle), r * std::sin(angle)}; }

inline void add_quad(Facets& to, const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  to.push_back({a, b, c});
  to.push_back({a, c, d});
}

inline Facets turned_round(Facets facets) {
  for (Facet& f : facets) std::swap(f[1], f[2]);
  return facets;
}

// A strip from radius r0 to r1 that is t thick along the axis and rises by `pitch` a turn, in n segments of the angle
// d: n copies of a prism over the ring's sector, so that its volume is n t (r1^2 - r0^2) sin(d) / 2. Normals outward.
inline Facets ribbon(double r0, double r1, double t, double pitch, double x0, int n, double d) {
  Facets f;
  const auto at = [&](int i, double r, double up) { return around_x(x0 + pitch * i * d / (2 * pi) + up, r, i * d); };
  for (int i = 0; i < n; ++i) {
    add_quad(f, at(i, r0, t), at(i, r1, t), at(i + 1, r1, t), at(i + 1, r0, t));
    add_quad(f, at(i, r0, 0), at(i + 1, r0, 0), at(i + 1, r1, 0), at(i, r1, 0));  // cut along the same diagonal
    add_quad(f, at(i, r1, 0), at(i + 1, r1, 0), at(i + 1, r1, t), at(i, r1, t));
    add_quad(f, at(i + 1, r0, 0), at(i, r0, 0), at(i, r0, t), at(i + 1, r0, t));
  }
  add_quad(f, at(0, r0, 0), at(0, r1, 0), at(0, r1, t), at(0, r0, t));
  add_quad(f, at(n, r0, t), at(n, r1, t), at(n, r1, 0), at(n, r0, 0));
  return f;
}

// The bottom and top face of a ribbon are helicoids: both together have this area, the smooth surface's.
inline double helicoids_area(double r0, double r1, double pitch, double angle) {
  const double c = pitch / (2 * pi);
  const auto primitive = [c](double r) { return 0.5 * (r * std::hypot(r, c) + c * c * std::asinh(r / c)); };
  return 2 * angle * (primitive(r1) - primitive(r0));
}

// Mantle of n chords, and ends if they are asked for. Normals outward.
inline Facets cylinder(double x0, double x1, double r, int n, bool first_end = true, bool last_end = true) {
  Facets f;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * pi * i / n, b = 2 * pi * (i + 1) / n;
    add_quad(f, around_x(x0, r, a), around_x(x0, r, b), around_x(x1, r, b), around_x(x1, r, a));
    if (first_end) f.push_back({Vertex{x0, 0, 0}, around_x(x0, r, b), around_x(x0, r, a)});
    if (last_end) f.push_back({Vertex{x1, 0, 0}, around_x(x1, r, a), around_x(x1, r, b)});
  }
  return f;
}

// A trough: half a circle of n chords below, upright walls to `top`, ends; open above. Normals inward.
inline Facets trough(double x0, double x1, double r, double top, int n) {
  std::vector<std::array<double, 2>> line = {{-r, top}};
  for (int i = 0; i <= n; ++i) line.push_back({r * std::cos(pi + pi * i / n), r * std::sin(pi + pi * i / n)});
  line.push_back({r, top});
  Facets f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const auto &p = line[i], &q = line[i + 1];
    add_quad(f, {x0, p[0], p[1]}, {x1, p[0], p[1]}, {x1, q[0], q[1]}, {x0, q[0], q[1]});
    if (i == 0) continue;
    f.push_back({Vertex{x0, -r, top}, {x0, p[0], p[1]}, {x0, q[0], q[1]}});
    f.push_back({Vertex{x1, -r, top}, {x1, q[0], q[1]}, {x1, p[0], p[1]}});
  }
  return f;
}

inline std::string text_stl(const Facets& facets, double scale = 1, const std::string& end_of_line = "\n") {
  std::ostringstream out;
  out.precision(12);
  out << "solid made by a test" << end_of_line;
  for (const Facet& f : facets) {
    out << "  facet normal 0 0 0" << end_of_line << "    outer loop" << end_of_line;
    for (const Vertex& v : f)
      out << "      vertex " << scale * v[0] << ' ' << scale * v[1] << ' ' << scale * v[2] << end_of_line;
    out << "    endloop" << end_of_line << "  endfacet" << end_of_line;
  }
  out << "endsolid made by a test" << end_of_line;
  return out.str();
}

inline std::string binary_stl(const Facets& facets, double scale = 1, std::string header = "by a test") {
  header.resize(80, ' ');
  std::string out = header;
  const auto append = [&out](const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); };
  const auto count = static_cast<std::uint32_t>(facets.size());
  append(&count, 4);
  for (const Facet& f : facets) {
    const float normal[3] = {0, 0, 0};
    append(normal, 12);
    for (const Vertex& v : f)
      for (const double x : v) {
        const auto number = static_cast<float>(scale * x);
        append(&number, 4);
      }
    append("\0\0", 2);
  }
  return out;
}

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

// A drum of radius 0.1 m and length 0.16 m, closed; a ribbon of one turn and a shaft through both ends. The drum has
// vertices where the ribbon has none, so that the least distance is between the middle of a chord and the ribbon's
// edge.
struct RibbonMixer {
  double R = 0.1, L = 0.16, r0 = 0.07, r1 = 0.096, t = 0.006, start = 0.012, pitch = 0.13, shaft = 0.012;
  int chords = 48, segments = 36;

  Facets drum() const { return turned_round(cylinder(0, L, R, chords)); }
  Facets blade() const { return ribbon(r0, r1, t, pitch, start, segments, 2 * pi / segments); }
  Facets axle() const { return cylinder(-0.02, L + 0.02, shaft, 24); }

  double drum_volume() const { return L * chords / 2.0 * R * R * std::sin(2 * pi / chords); }
  double blade_volume() const { return segments * t * 0.5 * std::sin(2 * pi / segments) * (r1 * r1 - r0 * r0); }
  double clearance() const { return R * std::cos(pi / chords) - r1; }

  static std::string parts_file(const std::string& unit = "m", const std::string& more = "") {
    return "unit = \"" + unit +
           "\"\nup = [0, 0, 1]\n[axis]\norigin = [0, 0, 0]\ndirection = [1, 0, 0]\n"
           "[[part]]\nname = \"drum\"\nfile = \"drum.stl\"\nmotion = \"stands\"\n"
           "[[part]]\nname = \"helix\"\nfile = \"helix.stl\"\nmotion = \"turns\"\n"
           "[[part]]\nname = \"axle\"\nfile = \"axle.stl\"\nmotion = \"turns\"\nthrough = true\n" +
           more;
  }
  void write_to(const std::filesystem::path& folder) const {
    write(folder / "drum.stl", text_stl(drum()));
    write(folder / "helix.stl", text_stl(blade()));
    write(folder / "axle.stl", text_stl(axle()));
    write(folder / "machine.toml", parts_file());
  }
};

}  // namespace machine_shapes

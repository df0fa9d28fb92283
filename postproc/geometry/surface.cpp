// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace vielto {
namespace {

constexpr double kOnPlane = 1e-9;  // m, well below LIGGGHTS' own 1e-8 for equal nodes

double smallest_angle(const Point& a, const Point& b, const Point& c) {
  const auto angle = [](const Point& at, const Point& p, const Point& q) {
    const Point u = p - at, v = q - at;
    return std::atan2(u.cross(v).norm(), u.dot(v));
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

bool before(const Point& a, const Point& b) { return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z()); }

// The part of a convex face with sign * (x - plane) >= 0. The cut point of an edge does not depend on the edge's
// direction, so that neighbours stay joined to the last bit.
Face cut(const Face& face, double plane, double sign) {
  Face kept;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Point& p = face[i];
    const Point& q = face[(i + 1) % face.size()];
    const double dp = sign * (p.x() - plane), dq = sign * (q.x() - plane);
    if (dp >= 0) kept.push_back(p);
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
      const Point& a = before(p, q) ? p : q;
      const Point& b = before(p, q) ? q : p;
      Point middle = a + (plane - a.x()) / (b.x() - a.x()) * (b - a);
      middle.x() = plane;
      kept.push_back(middle);
    }
  }
  return kept;
}

void put_on_plane(Face& face, double plane) {
  for (Point& p : face)
    if (std::fabs(p.x() - plane) < kOnPlane) p.x() = plane;
}

bool lies_in(const Face& face, double plane) {
  return std::all_of(face.begin(), face.end(), [plane](const Point& p) { return p.x() == plane; });
}

void project(const Surface& surface, const Point& axis, double& low, double& high) {
  low = std::numeric_limits<double>::infinity();
  high = -low;
  for (const Face& face : surface)
    for (const Point& p : face) {
      low = std::min(low, axis.dot(p));
      high = std::max(high, axis.dot(p));
    }
}

}  // namespace

Surface box(const Point& centre, const Point& u, const Point& v, const Point& w) {
  const auto side = [&centre](const Point& out, const Point& a, const Point& b) -> Face {
    const Point c = centre + out;
    return {c - a - b, c + a - b, c + a + b, c - a + b};
  };
  Surface faces{side(u, v, w), side(-u, w, v), side(v, w, u), side(-v, u, w), side(w, u, v), side(-w, v, u)};
  const auto area = [](const Face& f) { return (f[1] - f[0]).cross(f[3] - f[0]).norm(); };
  std::stable_sort(faces.begin(), faces.end(),
                   [&area](const Face& a, const Face& b) { return area(a) < 0.999 * area(b); });
  return faces;
}

Surface sweep(const std::vector<Eigen::Vector2d>& line, bool closed, double x0, double x1, int pieces) {
  Surface surface;
  const std::size_t last = closed ? line.size() : line.size() - 1;
  for (int piece = 0; piece < pieces; ++piece) {
    const double a = piece == 0 ? x0 : x0 + (x1 - x0) * piece / pieces;
    const double b = piece + 1 == pieces ? x1 : x0 + (x1 - x0) * (piece + 1) / pieces;
    for (std::size_t i = 0; i < last; ++i) {
      const Eigen::Vector2d& p = line[i];
      const Eigen::Vector2d& q = line[(i + 1) % line.size()];
      surface.push_back({{a, p.x(), p.y()}, {a, q.x(), q.y()}, {b, q.x(), q.y()}, {b, p.x(), p.y()}});
    }
  }
  return surface;
}

int strip_pieces(double length, double width) {
  return std::max(1, static_cast<int>(std::ceil(length / (40 * width))));
}

std::vector<Eigen::Vector2d> arc(double radius, double from, double angle, int segments) {
  const bool whole_turn = angle > 2 * kPi - 1e-12;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < segments + (whole_turn ? 0 : 1); ++i) {
    const double a = from + angle * i / segments;
    points.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  return points;
}

std::vector<Eigen::Vector2d> rectangle(double width, double height) {
  const double a = width / 2, b = height / 2;
  return {{-a, -b}, {a, -b}, {a, b}, {-a, b}};
}

Surface upright(Surface surface) {
  for (Face& face : surface)
    for (Point& p : face) p = Point(p.y(), p.z(), p.x());
  return surface;
}

Face plate(std::vector<Eigen::Vector2d> outline, double x, bool up) {
  double twice_area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& p = outline[i];
    const auto& q = outline[(i + 1) % outline.size()];
    twice_area += p.x() * q.y() - q.x() * p.y();
  }
  if ((twice_area > 0) != up) std::reverse(outline.begin(), outline.end());
  Face face;
  for (const auto& p : outline) face.emplace_back(x, p.x(), p.y());
  return face;
}

Surface wrap(const Surface& surface, double length) {
  Surface wrapped;
  for (Face face : surface) {
    const auto [low, high] =
        std::minmax_element(face.begin(), face.end(), [](const Point& a, const Point& b) { return a.x() < b.x(); });
    const int first = static_cast<int>(std::floor((low->x() + kOnPlane) / length));
    const int last = static_cast<int>(std::ceil((high->x() - kOnPlane) / length));
    for (int period = first; period <= last; ++period) put_on_plane(face, period * length);
    for (int period = first; period < std::max(last, first + 1); ++period) {
      const double start = period * length, end = (period + 1) * length;
      Face piece = cut(cut(face, start, +1), end, -1);
      if (piece.size() < 3 || (lies_in(piece, start) && !lies_in(face, start)) ||
          (lies_in(piece, end) && !lies_in(face, end)))
        continue;
      for (Point& p : piece) p.x() = p.x() == start ? 0 : p.x() == end ? length : p.x() - start;
      wrapped.push_back(piece);
    }
  }
  return wrapped;
}

Triangles triangulate(const Surface& surface) {
  Triangles triangles;
  for (const Face& face : surface) {
    // best[i][j]: the largest possible smallest angle in the part between vertices i and j, and the vertex that gives
    // it.
    const std::size_t n = face.size();
    std::vector<std::vector<double>> best(n, std::vector<double>(n, std::numeric_limits<double>::infinity()));
    std::vector<std::vector<std::size_t>> apex(n, std::vector<std::size_t>(n, 0));
    for (std::size_t span = 2; span < n; ++span)
      for (std::size_t i = 0; i + span < n; ++i) {
        const std::size_t j = i + span;
        best[i][j] = -1;
        for (std::size_t k = i + 1; k < j; ++k) {
          const double angle = std::min({best[i][k], best[k][j], smallest_angle(face[i], face[k], face[j])});
          if (angle > best[i][j]) {
            best[i][j] = angle;
            apex[i][j] = k;
          }
        }
      }
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j < i + 2) continue;
      const std::size_t k = apex[i][j];
      triangles.push_back({face[i], face[k], face[j]});
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
  }
  return triangles;
}

Measure measure(const Triangles& triangles) {
  Measure m;
  m.triangles = triangles.size();
  m.low = Point::Constant(std::numeric_limits<double>::infinity());
  m.high = -m.low;
  m.smallest_angle = std::numeric_limits<double>::infinity();
  const auto key = [](const Point& p) {
    const auto rounded = [](double x) { return std::llround(x * 1e8); };
    return std::make_tuple(rounded(p.x()), rounded(p.y()), rounded(p.z()));
  };
  using Key = decltype(key(Point()));
  std::map<std::pair<Key, Key>, std::pair<int, int>> edges;  // uses in one direction, in the other
  for (const Triangle& t : triangles) {
    m.volume += t[0].dot(t[1].cross(t[2])) / 6;
    m.area += (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
    m.smallest_angle = std::min(m.smallest_angle, smallest_angle(t[0], t[1], t[2]));
    for (int i = 0; i < 3; ++i) {
      m.low = m.low.cwiseMin(t[i]);
      m.high = m.high.cwiseMax(t[i]);
      const Key a = key(t[i]), b = key(t[(i + 1) % 3]);
      if (a < b)
        ++edges[{a, b}].first;
      else
        ++edges[{b, a}].second;
    }
  }
  for (const auto& edge : edges) {
    const auto [forth, back] = edge.second;
    if (forth + back == 1)
      ++m.open_edges;
    else if (forth != 1 || back != 1)
      ++m.crowded_edges;
  }
  return m;
}

double largest_radius(const Triangles& triangles) {
  double radius = 0;
  for (const Triangle& t : triangles)
    for (const Point& p : t) radius = std::max(radius, std::hypot(p.y(), p.z()));
  return radius;
}

bool overlap(const Surface& a, const Surface& b) {
  std::vector<Point> axes, edges_a, edges_b;
  const auto collect = [&axes](const Surface& s, std::vector<Point>& edges) {
    for (const Face& face : s) {
      axes.push_back((face[1] - face[0]).cross(face[2] - face[0]).normalized());
      for (std::size_t i = 0; i < face.size(); ++i)
        edges.push_back((face[(i + 1) % face.size()] - face[i]).normalized());
    }
  };
  collect(a, edges_a);
  collect(b, edges_b);
  for (const Point& p : edges_a)
    for (const Point& q : edges_b) {
      const Point axis = p.cross(q);
      if (axis.norm() > 1e-6) axes.push_back(axis.normalized());
    }
  return std::none_of(axes.begin(), axes.end(), [&a, &b](const Point& axis) {
    double low_a, high_a, low_b, high_b;
    project(a, axis, low_a, high_a);
    project(b, axis, low_b, high_b);
    return high_a < low_b || high_b < low_a;
  });
}

Surface moved(Surface surface, const Point& by) {
  for (Face& face : surface)
    for (Point& p : face) p += by;
  return surface;
}

void append(Surface& surface, const Surface& more) { surface.insert(surface.end(), more.begin(), more.end()); }

}  // namespace vielto

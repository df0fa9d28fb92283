// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/turn_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace vielto {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A triangle in coordinates with the axis as x, and the box of its image.
struct Piece {
  Triangle t;
  double s0 = 0, s1 = 0, r0 = 0, r1 = 0;
};

double distance_from_axis(const Triangle& t) {
  const auto cross = [](const Point& a, const Point& b) { return a.y() * b.z() - a.z() * b.y(); };
  const double a = cross(t[0], t[1]), b = cross(t[1], t[2]), c = cross(t[2], t[0]);
  if ((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0)) return 0;  // the axis goes through
  double nearest = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d p = t[i].tail<2>(), d = t[(i + 1) % 3].tail<2>() - p;
    const double k = d.squaredNorm() > 0 ? std::clamp(-p.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (p + k * d).norm());
  }
  return nearest;
}

Piece piece_of(const Triangle& t) {
  const auto [low, high] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  double r1 = 0;
  for (const Point& p : t) r1 = std::max(r1, p.tail<2>().norm());
  return {t, low, high, distance_from_axis(t), r1};
}

std::pair<Piece, Piece> halves(const Triangle& t) {
  int k = 0;
  for (int i = 1; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).norm() > (t[(k + 1) % 3] - t[k]).norm()) k = i;
  const Point &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3], middle = (a + b) / 2;
  return {piece_of({a, middle, c}), piece_of({middle, b, c})};
}

struct Set {
  std::vector<Piece> pieces;
  double s0 = kInfinity, s1 = -kInfinity, r0 = kInfinity, r1 = -kInfinity;
  std::unique_ptr<Set> first, second;  // made when they are asked for

  void add(const Piece& p) {
    pieces.push_back(p);
    s0 = std::min(s0, p.s0), s1 = std::max(s1, p.s1), r0 = std::min(r0, p.r0), r1 = std::max(r1, p.r1);
  }
  double size() const { return std::hypot(s1 - s0, r1 - r0); }
};

// By the middle of the longer side of the box, after every piece is shorter than half of that side. A piece hangs
// together, so that it takes every value between the ends of its box: of those whose boxes are no wider than `same` one
// way, and equal to that, one is enough.
void halve(Set& set, double same) {
  set.first = std::make_unique<Set>(), set.second = std::make_unique<Set>();
  const bool by_s = set.s1 - set.s0 > set.r1 - set.r0;
  const double low = by_s ? set.s0 : set.r0, half = 0.5 * (by_s ? set.s1 - set.s0 : set.r1 - set.r0);
  std::set<std::array<long, 4>> seen;
  std::vector<Piece>& rest = set.pieces;
  while (!rest.empty()) {
    const Piece p = rest.back();
    rest.pop_back();
    const double p0 = by_s ? p.s0 : p.r0, p1 = by_s ? p.s1 : p.r1;
    if (p1 - p0 > half) {
      const auto [one, other] = halves(p.t);
      rest.push_back(one), rest.push_back(other);
      continue;
    }
    if (std::min(p.s1 - p.s0, p.r1 - p.r0) <= same) {
      const auto rounded = [same](double x) { return std::lround(x / same); };
      if (!seen.insert({rounded(p.s0), rounded(p.s1), rounded(p.r0), rounded(p.r1)}).second) continue;
    }
    (0.5 * (p0 + p1) < low + half ? set.first : set.second)->add(p);
  }
}

struct Pair {
  double distance;  // of the boxes
  Set *a, *b;
  Pair(Set* of_a, Set* of_b) : a(of_a), b(of_b) {
    const double ds = std::max({0.0, a->s0 - b->s1, b->s0 - a->s1}), dr = std::max({0.0, a->r0 - b->r1, b->r0 - a->r1});
    distance = std::hypot(ds, dr);
  }
  double size() const { return a->size() + b->size(); }
  // of two pairs as near, the smaller one first: so that two bodies that meet are known to soon
  bool operator<(const Pair& other) const {
    return std::make_pair(distance, size()) > std::make_pair(other.distance, other.size());
  }
};

Set seen_along(const Triangles& triangles, const TurnAxis& axis) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(axis.direction, Point::UnitX());
  Set set;
  for (const Triangle& t : triangles)
    set.add(piece_of({turn * (t[0] - axis.origin), turn * (t[1] - axis.origin), turn * (t[2] - axis.origin)}));
  return set;
}

}  // namespace

TurnClearance turn_clearance(const Triangles& standing, const Triangles& turning, const TurnAxis& axis,
                             double tolerance) {
  const double same = tolerance / 8, least = tolerance;
  Set a = seen_along(standing, axis), b = seen_along(turning, axis);
  std::priority_queue<Pair> pairs;
  pairs.emplace(&a, &b);
  for (;;) {
    const Pair nearest = pairs.top();
    pairs.pop();
    if (nearest.size() <= least) {
      const double error = nearest.size() / 2 + 2 * same;
      return {nearest.distance + nearest.size() / 2, error, (nearest.b->s0 + nearest.b->s1) / 2,
              (nearest.b->r0 + nearest.b->r1) / 2};
    }
    const bool first = nearest.a->size() > nearest.b->size();
    Set& larger = first ? *nearest.a : *nearest.b;
    if (!larger.first) halve(larger, same);
    for (Set* half : {larger.first.get(), larger.second.get()})
      if (half->s0 <= half->s1) pairs.emplace(first ? half : nearest.a, first ? nearest.b : half);
  }
}

}  // namespace vielto

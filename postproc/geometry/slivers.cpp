// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/slivers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace vielto {

double smallest_angle(const Triangle& t) {
  double least = kPi;
  for (int i = 0; i < 3; ++i) {
    const Point u = t[(i + 1) % 3] - t[i], v = t[(i + 2) % 3] - t[i];
    least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
  }
  return least;
}

double height(const Triangle& t) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, (t[(i + 1) % 3] - t[i]).norm());
  return longest > 0 ? (t[1] - t[0]).cross(t[2] - t[0]).norm() / longest : 0;
}

namespace {

constexpr double kWish = 5 * kPi / 180;  // rad; pairs with no angle below it are left as they are

class Widening {
 public:
  Widening(Indexed& mesh, double least, double flat, std::size_t most)
      : mesh_(mesh), least_(least), flat_(flat), most_(most) {
    for (int f = 0; f < static_cast<int>(mesh_.faces.size()); ++f)
      for (int i = 0; i < 3; ++i) join(edge(f, i), f);
  }

  void run() {
    for (int f = 0; f < static_cast<int>(mesh_.faces.size()); ++f) look_at(f);
    flip();
    while (!narrow_.empty() && mesh_.faces.size() < most_) {
      const int f = narrow_.back();
      narrow_.pop_back();
      const Triangle t = mesh_.triangle(mesh_.faces[f]);
      if (smallest_angle(t) >= least_ || height(t) <= flat_) continue;
      const Edge e = edge_to_divide(f);
      if (length(e) < 8 * flat_) continue;
      divide(e);
      flip();
      look_at(f);
    }
  }

 private:
  using Edge = std::pair<int, int>;  // the smaller number first
  struct Hash {
    std::size_t operator()(const Edge& e) const {
      return (static_cast<std::uint64_t>(e.first) << 32 | static_cast<std::uint32_t>(e.second)) * 0x9E3779B97F4A7C15ull;
    }
  };

  static Edge ends(int a, int b) { return a < b ? Edge(a, b) : Edge(b, a); }
  Edge edge(int f, int i) const { return ends(mesh_.faces[f][i], mesh_.faces[f][(i + 1) % 3]); }
  double length(const Edge& e) const { return (mesh_.points[e.first] - mesh_.points[e.second]).norm(); }
  void join(const Edge& e, int f) {
    auto& of = users_.try_emplace(e, std::array<int, 2>{-1, -1}).first->second;
    of[of[0] < 0 ? 0 : 1] = f;
  }
  void replace(const Edge& e, int f, int by) {
    auto& of = users_.at(e);
    (of[0] == f ? of[0] : of[1]) = by;
  }
  int corner_off(int f, const Edge& e) const {
    for (int i = 0; i < 3; ++i)
      if (edge(f, i) == e) return (i + 2) % 3;
    return -1;
  }
  void look_at(int f) {
    const double angle = smallest_angle(mesh_.triangle(mesh_.faces[f]));
    if (angle < least_) narrow_.push_back(f);
    if (angle < least_)
      for (int i = 0; i < 3; ++i) edges_.push_back(edge(f, i));
  }

  void flip() {
    while (!edges_.empty()) {
      const Edge e = edges_.back();
      edges_.pop_back();
      const auto found = users_.find(e);
      if (found != users_.end() && found->second[0] >= 0 && found->second[1] >= 0) flip(e, found->second);
    }
  }

  // Triangles a b c and b a d become a d c and d b c, if that is the same surface and no worse.
  void flip(const Edge& e, const std::array<int, 2> of) {
    const int f = of[0], g = of[1], i = corner_off(f, e), j = corner_off(g, e);
    const int c = mesh_.faces[f][i], a = mesh_.faces[f][(i + 1) % 3], b = mesh_.faces[f][(i + 2) % 3];
    const int d = mesh_.faces[g][j];
    if (mesh_.faces[g][(j + 1) % 3] != b || c == d || users_.count(ends(c, d))) return;
    const std::array<int, 3> first = {a, d, c}, second = {d, b, c};
    const Triangle of_f = mesh_.triangle(mesh_.faces[f]), of_g = mesh_.triangle(mesh_.faces[g]);
    const double now = std::min(smallest_angle(of_f), smallest_angle(of_g));
    const Triangle t = mesh_.triangle(first), u = mesh_.triangle(second);
    if (now >= kWish || !(std::min(smallest_angle(t), smallest_angle(u)) > 1.0001 * now + 1e-12)) return;
    const auto twice_area = [](const Triangle& x) -> Point { return (x[1] - x[0]).cross(x[2] - x[0]); };
    const bool f_wider = height(of_f) > height(of_g);
    const Point normal = twice_area(f_wider ? of_f : of_g).normalized();
    const Point off = mesh_.points[f_wider ? d : c] - mesh_.points[a];
    if (!(std::fabs(off.dot(normal)) <= flat_)) return;
    if (!(twice_area(t).dot(normal) > 0 && twice_area(u).dot(normal) > 0)) return;
    if (!(twice_area(f_wider ? of_g : of_f).dot(normal) > 0) && height(f_wider ? of_g : of_f) > flat_) return;
    users_.erase(e);
    replace(ends(a, d), g, f);
    replace(ends(b, c), f, g);
    mesh_.faces[f] = first, mesh_.faces[g] = second;
    join(ends(c, d), f), join(ends(c, d), g);
    for (const int k : {f, g}) {
      for (int n = 0; n < 3; ++n) edges_.push_back(edge(k, n));
      if (smallest_angle(mesh_.triangle(mesh_.faces[k])) < least_) narrow_.push_back(k);
    }
  }

  bool in_a_plane(const std::array<int, 2>& of) const {
    if (of[0] < 0 || of[1] < 0) return false;
    const auto normal = [&](int f) {
      const Triangle t = mesh_.triangle(mesh_.faces[f]);
      return Point((t[1] - t[0]).cross(t[2] - t[0]).normalized());
    };
    return normal(of[0]).dot(normal(of[1])) > 1 - 1e-9;
  }

  // Of a strip its longer side, so that the flips cut it across; else where the path of longest edges ends.
  Edge edge_to_divide(int f) const {
    double longest = 0;
    for (int i = 0; i < 3; ++i) longest = std::max(longest, length(edge(f, i)));
    Edge side(0, 0);
    for (int i = 0; i < 3; ++i)
      if (!in_a_plane(users_.at(edge(f, i))) && length(edge(f, i)) > std::max(0.5 * longest, length(side)))
        side = edge(f, i);
    return side.first != side.second ? side : end_of_longest_edges(f);
  }

  // From face to face over the longest edge, until it is that of both.
  Edge end_of_longest_edges(int f) const {
    for (;;) {
      Edge longest = edge(f, 0);
      for (int i = 1; i < 3; ++i)
        if (std::make_pair(length(edge(f, i)), edge(f, i)) > std::make_pair(length(longest), longest))
          longest = edge(f, i);
      const auto& of = users_.at(longest);
      const int next = of[0] == f ? of[1] : of[0];
      if (next < 0) return longest;
      bool same = true;
      for (int i = 0; i < 3; ++i)
        same = same && std::make_pair(length(edge(next, i)), edge(next, i)) <= std::make_pair(length(longest), longest);
      if (same) return longest;
      f = next;
    }
  }

  void divide(const Edge& e) {
    const std::array<int, 2> of = users_.at(e);
    users_.erase(e);
    const int m = static_cast<int>(mesh_.points.size());
    mesh_.points.push_back((mesh_.points[e.first] + mesh_.points[e.second]) / 2);
    for (const int f : of) {
      if (f < 0) continue;
      const int i = corner_off(f, e), g = static_cast<int>(mesh_.faces.size());
      const int c = mesh_.faces[f][i], a = mesh_.faces[f][(i + 1) % 3], b = mesh_.faces[f][(i + 2) % 3];
      mesh_.faces.push_back({m, b, c});
      mesh_.faces[f] = {a, m, c};
      replace(ends(b, c), f, g);
      join(ends(a, m), f), join(ends(b, m), g);
      join(ends(c, m), f), join(ends(c, m), g);
      look_at(f), look_at(g);
    }
  }

  Indexed& mesh_;
  double least_, flat_;
  std::size_t most_;
  std::unordered_map<Edge, std::array<int, 2>, Hash> users_;
  std::vector<Edge> edges_;  // to be looked at
  std::vector<int> narrow_;  // faces, some of them no more
};

}  // namespace

void widen(Indexed& mesh, double least, double flat, std::size_t most) { Widening(mesh, least, flat, most).run(); }

}  // namespace vielto

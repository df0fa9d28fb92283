// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/room.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

namespace vielto {

struct SurfaceDistance::Search {
  vtkNew<vtkPolyData> data;
  vtkNew<vtkStaticCellLocator> locator;
  vtkNew<vtkGenericCell> cell;
};

SurfaceDistance::SurfaceDistance(const Triangles& triangles) : search_(std::make_unique<Search>()) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : triangles) {
    vtkIdType ids[3];
    for (int i = 0; i < 3; ++i) ids[i] = points->InsertNextPoint(t[i].data());
    cells->InsertNextCell(3, ids);
  }
  search_->data->SetPoints(points);
  search_->data->SetPolys(cells);
  search_->locator->SetDataSet(search_->data);
  search_->locator->BuildLocator();
}

SurfaceDistance::~SurfaceDistance() = default;

double SurfaceDistance::operator()(const Point& p) const {
  double closest[3], square = 0;
  vtkIdType id = -1;
  int sub = 0;
  search_->locator->FindClosestPoint(p.data(), closest, search_->cell, id, sub, square);
  return id < 0 ? std::numeric_limits<double>::infinity() : std::sqrt(square);
}

bool SurfaceDistance::within(const Point& p, double radius) const {
  double at[3] = {p.x(), p.y(), p.z()}, closest[3], square = 0;
  vtkIdType id = -1;
  int sub = 0, inside = 0;
  return search_->locator->FindClosestPointWithinRadius(at, radius, closest, search_->cell, id, sub, square, inside) !=
             0 &&
         square < radius * radius;
}

bool SurfaceDistance::between(const Point& a, const Point& b) const {
  double t = 0, x[3], weights[3];
  int sub = 0;
  vtkIdType id = -1;
  return search_->locator->IntersectWithLine(a.data(), b.data(), 0, t, x, weights, sub, id, search_->cell) != 0;
}

namespace {

constexpr double kMostCubes = 1e6;
constexpr int kMargin = 3;  // cubes beyond the vessel, which are outside
constexpr int kNone = -1;
constexpr int kMostHidden = 12;  // cubes of the room behind another surface, the nearest ones

// By the region of the triangle's plane in which the point lies (Ericson 2005, Real-Time Collision Detection, 5.1.5).
double distance_to_triangle(const Point& p, const Triangle& t) {
  const Point normal = (t[1] - t[0]).cross(t[2] - t[0]);
  double least = std::numeric_limits<double>::infinity();
  bool over = normal.squaredNorm() > 0;
  for (int i = 0; i < 3; ++i) {
    const Point edge = t[(i + 1) % 3] - t[i], from = p - t[i];
    over = over && normal.cross(edge).dot(from) >= 0;
    const double length = edge.squaredNorm();
    const double k = length > 0 ? std::clamp(from.dot(edge) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (from - k * edge).norm());
  }
  return over ? std::fabs((p - t[0]).dot(normal)) / normal.norm() : least;
}

}  // namespace

struct Room::Lattice {
  Point low;
  double h = 0;
  std::array<int, 3> n{};
  std::vector<char> wall;
  std::vector<float> level;  // infinite: enclosed
  std::vector<int> pool;     // kNone: holds nothing
  int room = kNone;
  std::unique_ptr<SurfaceDistance> surface;
  std::vector<std::array<int, 3>> near;  // steps to cubes around one, the nearest first

  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * n[1] + y) * n[0] + static_cast<std::size_t>(x);
  }
  Point middle(int x, int y, int z) const { return low + h * Point(x + 0.5, y + 0.5, z + 0.5); }
  std::array<int, 3> cell(const Point& p) const {
    std::array<int, 3> c;
    for (int d = 0; d < 3; ++d) c[d] = static_cast<int>(std::floor((p[d] - low[d]) / h));
    return c;
  }
  bool inside(const std::array<int, 3>& c) const {
    return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < n[0] && c[1] < n[1] && c[2] < n[2];
  }
  double height(std::size_t i) const {
    return low.z() + h * (static_cast<double>(i / (static_cast<std::size_t>(n[0]) * n[1])) + 0.5);
  }
  template <class Use>
  void neighbours(std::size_t i, const Use& use) const {
    const int x = static_cast<int>(i % n[0]), y = static_cast<int>(i / n[0] % n[1]),
              z = static_cast<int>(i / n[0] / n[1]);
    if (x > 0) use(at(x - 1, y, z));
    if (x + 1 < n[0]) use(at(x + 1, y, z));
    if (y > 0) use(at(x, y - 1, z));
    if (y + 1 < n[1]) use(at(x, y + 1, z));
    if (z > 0) use(at(x, y, z - 1));
    if (z + 1 < n[2]) use(at(x, y, z + 1));
  }

  void build(const Triangles& vessel);
  void mark_wall(const Triangle& t);
  void flood();
  void find_pools();
  void list_near();
};

// Cubes whose middle is nearer than half a cube to a triangle, which is cut as small as two cubes before.
void Room::Lattice::mark_wall(const Triangle& t) {
  int k = 0;
  for (int i = 1; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).norm() > (t[(k + 1) % 3] - t[k]).norm()) k = i;
  const Point &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
  if ((b - a).norm() > 2 * h) {
    const Point middle = (a + b) / 2;
    mark_wall({a, middle, c}), mark_wall({middle, b, c});
    return;
  }
  const double reach = 0.501 * h;
  const auto first = cell(a.cwiseMin(b).cwiseMin(c) - reach * Point::Ones());
  const auto last = cell(a.cwiseMax(b).cwiseMax(c) + reach * Point::Ones());
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        if (char& w = wall[at(x, y, z)]; !w) w = distance_to_triangle(middle(x, y, z), t) < reach;
}

void Room::Lattice::build(const Triangles& vessel) {
  const Measure extent = measure(vessel);
  const Point size = extent.high - extent.low;
  h = std::cbrt(std::max(size.x() * size.y() * size.z(), 1e-3 * std::pow(size.maxCoeff(), 3)) / kMostCubes);
  low = extent.low - kMargin * h * Point::Ones();
  for (int d = 0; d < 3; ++d) n[d] = static_cast<int>(std::ceil(size[d] / h)) + 2 * kMargin;
  wall.assign(static_cast<std::size_t>(n[0]) * n[1] * n[2], 0);
  surface = std::make_unique<SurfaceDistance>(vessel);
  for (const Triangle& t : vessel) mark_wall(t);
}

// Three cubes in each direction: in a corner of three walls the nearest cube that is no wall may be two away.
void Room::Lattice::list_near() {
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -3; z <= 3; ++z) near.push_back({x, y, z});
  const auto length = [](const std::array<int, 3>& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; };
  std::stable_sort(near.begin(), near.end(), [&](const auto& a, const auto& b) { return length(a) < length(b); });
}

void Room::Lattice::flood() {
  level.assign(wall.size(), std::numeric_limits<float>::infinity());
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::vector<char> reached(wall.size(), 0);
  const auto reach = [&](std::size_t i, float from) {
    if (wall[i] || reached[i]) return;
    reached[i] = 1;
    level[i] = std::max(from, static_cast<float>(height(i)));
    front.emplace(level[i], i);
  };
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x)
        if (x == 0 || y == 0 || z == 0 || x + 1 == n[0] || y + 1 == n[1] || z + 1 == n[2])
          reach(at(x, y, z), -std::numeric_limits<float>::infinity());
  while (!front.empty()) {
    const auto [from, i] = front.top();
    front.pop();
    neighbours(i, [&, from = from](std::size_t j) { reach(j, from); });
  }
}

void Room::Lattice::find_pools() {
  pool.assign(wall.size(), kNone);
  int count = 0;
  std::vector<std::size_t> front;
  const auto holds = [&](std::size_t i) { return !wall[i] && level[i] > height(i) + 0.25 * h; };
  for (std::size_t start = 0; start < wall.size(); ++start) {
    if (pool[start] != kNone || !holds(start)) continue;
    pool[start] = count;
    front.assign(1, start);
    while (!front.empty()) {
      const std::size_t i = front.back();
      front.pop_back();
      neighbours(i, [&](std::size_t j) {
        if (pool[j] == kNone && holds(j)) pool[j] = count, front.push_back(j);
      });
    }
    ++count;
  }
}

Room::Room(const Triangles& vessel, const std::vector<Point>& rotor) : lattice_(std::make_unique<Lattice>()) {
  Lattice& l = *lattice_;
  l.build(vessel);
  l.flood();
  l.find_pools();
  l.list_near();
  std::map<int, std::size_t> of_pool;
  for (const Point& p : rotor)
    if (const auto c = l.cell(p); l.inside(c) && l.pool[l.at(c[0], c[1], c[2])] != kNone)
      ++of_pool[l.pool[l.at(c[0], c[1], c[2])]];
  std::size_t most = 0;
  for (const auto& [pool, count] : of_pool)
    if (count > most) most = count, l.room = pool;
  if (!found()) return;

  float level = 0;
  top_ = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < l.pool.size(); ++i)
    if (l.pool[i] == l.room) level = l.level[i], top_ = std::max(top_, l.height(i) + l.h);
  if (std::isfinite(level)) {
    // It runs over through a cube whose middle is at least half a cube over the wall, and at most one and a half.
    double rim = -std::numeric_limits<double>::infinity();
    for (const Triangle& t : vessel)
      for (const Point& p : t)
        if (p.z() > level - 1.6 * l.h && p.z() <= level - 0.4 * l.h) rim = std::max(rim, p.z());
    rim_ = std::isfinite(rim) ? rim : level - l.h;
    top_ = *rim_;
  }
  for (const Triangle& t : vessel) volume_ += add_volume(t);
}

Room::~Room() = default;

bool Room::found() const { return lattice_->room != kNone; }
double Room::cube() const { return lattice_->h; }

// Whether a cube of the room near the point is in plain view just off the surface, on the normal's side.
bool Room::faces_room(const Point& at, const Point& normal) const {
  const Lattice& l = *lattice_;
  const Point from = at + 1e-3 * l.h * normal;
  const auto c = l.cell(at);
  int hidden = 0;
  for (const std::array<int, 3>& step : l.near) {
    const std::array<int, 3> cube = {c[0] + step[0], c[1] + step[1], c[2] + step[2]};
    if (!l.inside(cube) || l.pool[l.at(cube[0], cube[1], cube[2])] != l.room) continue;
    const Point middle = l.middle(cube[0], cube[1], cube[2]);
    if ((middle - at).dot(normal) <= 0) continue;
    if (!l.surface->between(from, middle)) return true;
    if (++hidden == kMostHidden) return false;  // the room lies behind a sheet
  }
  return false;
}

double Room::add_volume(const Triangle& t) const {
  const double limit = 2 * lattice_->h;
  int k = 0;
  for (int i = 1; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).norm() > (t[(k + 1) % 3] - t[k]).norm()) k = i;
  const Point &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
  if ((b - a).norm() > limit) {
    const Point middle = (a + b) / 2;
    return add_volume({a, middle, c}) + add_volume({middle, b, c});
  }
  const Point twice = (b - a).cross(c - a), centre = (a + b + c) / 3;
  const double area = twice.norm() / 2, depth = std::max(0.0, top_ - centre.z());
  if (!(area > 0) || depth == 0) return 0;
  const Point normal = twice / (2 * area);
  const int faces = faces_room(centre, normal) - faces_room(centre, -normal);
  return faces * depth * normal.z() * area;
}

bool Room::shows_front(const Triangles& part) const {
  double front = 0;
  for (const Triangle& t : part) {
    const Point twice = (t[1] - t[0]).cross(t[2] - t[0]), centre = (t[0] + t[1] + t[2]) / 3;
    if (!(twice.norm() > 0)) continue;
    const Point normal = twice.normalized();
    front += (faces_room(centre, normal) - faces_room(centre, -normal)) * twice.norm();
  }
  return front >= 0;
}

bool Room::holds(const Point& p, double distance) const {
  if (rim_ && p.z() + distance > *rim_) return false;
  const Lattice& l = *lattice_;
  const auto c = l.cell(p);
  const int reach = std::min(2, static_cast<int>(distance / l.h) + 1);
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const std::array<int, 3> near = {c[0] + x, c[1] + y, c[2] + z};
        if (!l.inside(near) || l.pool[l.at(near[0], near[1], near[2])] != l.room) continue;
        if ((l.middle(near[0], near[1], near[2]) - p).norm() < distance) return true;
      }
  return false;
}

}  // namespace vielto

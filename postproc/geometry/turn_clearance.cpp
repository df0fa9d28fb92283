// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/turn_clearance.h"

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace vielto {
namespace {

constexpr double kErrorOfSamples = 8;  // over the width of pieces

struct Image {
  double s = 0, r = 0;
};

// A triangle in coordinates with the axis as x, and the box of its image.
struct Piece {
  Triangle t;
  double s0 = 0, s1 = 0, r0 = 0, r1 = 0;
};

double distance_from_axis(const Triangle& t) {
  const auto cross = [](const Point& a, const Point& b) { return a.y() * b.z() - a.z() * b.y(); };
  const double a = cross(t[0], t[1]), b = cross(t[1], t[2]), c = cross(t[2], t[0]);
  if ((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0)) return 0;  // the axis goes through
  double nearest = std::numeric_limits<double>::infinity();
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

// Halved along the edge that is longest across the axis, until no image is wider than `width`; then along the longest
// edge, until none is longer than kLongest of that, so that far ones can be left out.
std::vector<Piece> cut(const std::vector<Piece>& pieces, double width) {
  constexpr double kLongest = 64;
  std::vector<Piece> narrow, rest = pieces;
  while (!rest.empty()) {
    const Piece p = rest.back();
    rest.pop_back();
    const double ds = p.s1 - p.s0, dr = p.r1 - p.r0;
    const bool wide = std::min(ds, dr) > width;
    if (!wide && std::max(ds, dr) <= kLongest * width) {
      narrow.push_back(p);
      continue;
    }
    const auto length = [wide](const Triangle& t, int i) {
      const Point edge = t[(i + 1) % 3] - t[i];
      return wide ? edge.tail<2>().norm() : edge.norm();
    };
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (length(p.t, i) > length(p.t, k)) k = i;
    const Point &a = p.t[k], &b = p.t[(k + 1) % 3], &c = p.t[(k + 2) % 3], middle = (a + b) / 2;
    rest.push_back(piece_of({a, middle, c}));
    rest.push_back(piece_of({middle, b, c}));
  }
  return narrow;
}

template <class Use>
void for_samples(const Piece& p, double width, const Use& use) {
  const double ds = p.s1 - p.s0, dr = p.r1 - p.r0;
  const int n = static_cast<int>(std::ceil(std::max(ds, dr) / (width / 2))) + 1;
  for (int i = 0; i < n; ++i) {
    const double k = n > 1 ? static_cast<double>(i) / (n - 1) : 0.5;
    if (ds >= dr)
      use(Image{p.s0 + k * ds, (p.r0 + p.r1) / 2});
    else
      use(Image{(p.s0 + p.s1) / 2, p.r0 + k * dr});
  }
}

// Cells of the half plane, `width` wide, that hold something.
using Cell = std::array<long, 4>;
struct HashOfCell {
  std::size_t operator()(const Cell& c) const {
    std::size_t hash = 0;
    for (const long i : c) hash = (hash ^ static_cast<std::size_t>(i)) * 0x9E3779B97F4A7C15ull + (hash >> 29);
    return hash;
  }
};

// Samples of pieces, one a cell, and their distances to those of other pieces. Of pieces with the same box, to the
// width, one is sampled: their images are the same to that.
class Samples {
 public:
  Samples(const std::vector<Piece>& pieces, double width) : width_(width) {
    points_->SetDataTypeToDouble();
    std::unordered_map<Cell, std::size_t, HashOfCell> index;
    for (const Piece& p : pieces) {
      std::vector<std::size_t>& of_box = boxes_[box(p)];
      if (!of_box.empty()) continue;
      for_samples(p, width, [&](const Image& i) {
        const auto [at, added] =
            index.emplace(Cell{std::lround(i.s / width), std::lround(i.r / width), 0, 0}, images_.size());
        of_box.push_back(at->second);
        if (!added) return;
        images_.push_back(i);
        points_->InsertNextPoint(i.s, i.r, 0);
      });
    }
    data_->SetPoints(points_);
    locator_->SetDataSet(data_);
    locator_->BuildLocator();
  }
  void measure_to(Samples& others) {
    for (const Image& i : images_) {
      const double x[3] = {i.s, i.r, 0};
      const double* y = others.points_->GetPoint(others.locator_->FindClosestPoint(x));
      distance_.push_back(std::hypot(x[0] - y[0], x[1] - y[1]));
    }
  }
  std::pair<double, Image> least() const {
    const auto at = std::min_element(distance_.begin(), distance_.end());
    return {*at, images_[static_cast<std::size_t>(at - distance_.begin())]};
  }
  double least_of(const Piece& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t i : boxes_.at(box(p))) least = std::min(least, distance_[i]);
    return least;
  }

 private:
  Cell box(const Piece& p) const {
    return {std::lround(p.s0 / width_), std::lround(p.s1 / width_), std::lround(p.r0 / width_),
            std::lround(p.r1 / width_)};
  }

  double width_;
  std::unordered_map<Cell, std::vector<std::size_t>, HashOfCell> boxes_;  // of samples
  std::vector<Image> images_;
  std::vector<double> distance_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkPolyData> data_;
  vtkNew<vtkStaticPointLocator> locator_;
};

std::vector<Piece> seen_along(const Triangles& triangles, const TurnAxis& axis) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(axis.direction, Point::UnitX());
  std::vector<Piece> pieces;
  for (const Triangle& t : triangles)
    pieces.push_back(piece_of({turn * (t[0] - axis.origin), turn * (t[1] - axis.origin), turn * (t[2] - axis.origin)}));
  return pieces;
}

}  // namespace

TurnClearance turn_clearance(const Triangles& standing, const Triangles& turning, const TurnAxis& axis,
                             double tolerance) {
  std::vector<Piece> a = seen_along(standing, axis), b = seen_along(turning, axis);
  double size = 0;
  for (const Piece& p : b) size = std::max({size, p.r1, std::fabs(p.s0), std::fabs(p.s1)});
  const double finest = tolerance / kErrorOfSamples;
  for (double width = std::max(size / 200, finest);; width = std::max(width / 8, finest)) {
    a = cut(a, width), b = cut(b, width);
    Samples of_a(a, width), of_b(b, width);
    of_a.measure_to(of_b), of_b.measure_to(of_a);
    const auto [distance, where] =
        std::min(of_a.least(), of_b.least(), [](const auto& x, const auto& y) { return x.first < y.first; });
    const TurnClearance best{distance, kErrorOfSamples * width, where.s, where.r};
    if (width <= finest) return best;
    const auto keep = [&best](std::vector<Piece>& pieces, const Samples& samples) {
      pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                                  [&](const Piece& p) { return samples.least_of(p) > best.distance + best.tolerance; }),
                   pieces.end());
    };
    keep(a, of_a), keep(b, of_b);
  }
}

}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
// The room for grain in a vessel of any shape, z upward.
//
// The vessel's surfaces lie in a lattice of cubes; a cube's middle nearer to a surface than half a cube is wall, so
// that no path over the cubes' faces passes a wall. From outside, each cube gets the level to which it can be filled
// before it runs over (priority flood: Barnes, Lehman and Mulla 2014, Comput. Geosci. 62:117); one that is not reached
// is enclosed. What holds grain hangs together in pools; the room is the pool that most of the rotor lies in.
//
// Volume: the surfaces are cut into pieces, and those that face the room give the integral of (rim - z) n_z dA, n into
// the room (Gauss); the open top at the rim gives nothing. Exact but for pieces at corners, where the lattice may not
// tell what they face.
#pragma once

#include <memory>
#include <optional>

#include "geometry/surface.h"

namespace vielto {

class Room {
 public:
  // `vessel`: all surfaces that stand still; `rotor`: points of what turns in it.
  Room(const Triangles& vessel, const std::vector<Point>& rotor);
  ~Room();

  bool found() const;                                 // whether a pool holds a point of the rotor
  double volume() const { return volume_; }           // m3, the rotor left out
  std::optional<double> rim() const { return rim_; }  // m, height at which it runs over; nothing if it is closed
  double top() const { return top_; }                 // m, of the room
  double cube() const;                                // m, edge of the lattice's cubes
  // Whether a point at least `distance` from every surface of the vessel lies in the room (and below the rim).
  bool holds(const Point& p, double distance) const;
  // Whether most of this part's area that faces the room does so with its front.
  bool shows_front(const Triangles& part) const;

 private:
  struct Lattice;
  double add_volume(const Triangle& t) const;
  bool faces_room(const Point& at, const Point& normal) const;

  std::unique_ptr<Lattice> lattice_;
  double volume_ = 0, top_ = 0;
  std::optional<double> rim_;
};

// Nearest distance from a point to triangles.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const Triangles& triangles);
  ~SurfaceDistance();
  double operator()(const Point& p) const;
  // Whether a triangle is nearer than `radius`; faster.
  bool within(const Point& p, double radius) const;
  // Whether a triangle lies between two points.
  bool between(const Point& a, const Point& b) const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace vielto

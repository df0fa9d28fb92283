// SPDX-License-Identifier: GPL-2.0-or-later
/* A grain's shape as a clump of spheres, for LIGGGHTS' particletemplate/multisphere.

   File: `NAME.clump`, one sphere a line, `x y z r` in m, of the real grain; # begins a comment. Spheres may overlap.

   Volume: of the union, counted once. Columns along z on a grid of `columns` x `columns` over the spheres, exact in
   each column; a sphere comes out within 2e-5 with 500. LIGGGHTS' own way is Monte Carlo, 1e-3 at a million tries.

   Scale: the union gets the volume of a sphere of the diameter asked for, the mass of that sphere, and the tensor of
   inertia of a homogeneous body of its shape about its centre of mass. */
#ifndef VIELTO_CLUMP_H
#define VIELTO_CLUMP_H

#include <array>
#include <string>
#include <vector>

namespace vielto {

const int kClumpColumns = 500;

struct ClumpSphere {
  double x[3], r;  // m
};

struct Clump {
  std::vector<ClumpSphere> spheres;  // about the union's centre of mass
  double volume = 0;                 // m3, of the union
  std::array<double, 6> inertia{};   // m2, tensor over mass: xx xy xz yy yz zz

  double diameter() const;  // m, of the sphere of equal volume
  double smallest() const;  // m, radius
  // The same shape with the volume of a sphere of diameter d.
  Clump scaled_to(double d) const;

  // Errors: BadInput for a file that cannot be read, a line that is not four numbers, a radius <= 0, fewer than two
  // spheres (LIGGGHTS wants two), spheres that do not hang together.
  static Clump read(const std::string& path, int columns = kClumpColumns);
};

}  // namespace vielto

#endif

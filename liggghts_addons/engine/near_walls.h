// SPDX-License-Identifier: GPL-2.0-or-later
/* Which grains may touch which triangles of the meshes of one wall fix: those nearer than a margin when all were looked
   at last, for as long as grains and triangles together have not gone, or grown, that far since. The margin follows
   their speed so that a look at all comes every 16 steps; it changes nothing but the time. */
#ifndef VIELTO_NEAR_WALLS_H
#define VIELTO_NEAR_WALLS_H

#include <vector>

#include "engine/near_search.h"

namespace LAMMPS_NS {
class Atom;
class FixMeshSurface;
class TriMesh;
}  // namespace LAMMPS_NS

namespace vielto {

class NearWalls {
 public:
  struct Entry {
    int triangle, grain;
    double gap;  // m, from the reach of the grain to the triangle at the last look at all
  };

  explicit NearWalls(const NearSearch& search) : search_(search) {}

  /* Call once a step; `renewed`: the lists of the meshes are others than in the step before; `reach`: a contact is
     handled up to this part of a grain's radius from the wall. Tells whether the entries are others. */
  bool begin(const LAMMPS_NS::Atom* grains, LAMMPS_NS::FixMeshSurface* const* meshes, int count, double reach,
             bool renewed);
  // Of one mesh, by triangle and then as in the triangle's list.
  const std::vector<Entry>& of(int mesh) const { return entries_[mesh]; }
  // An entry with a greater gap is not in reach yet, m.
  double nearer() const { return nearer_; }

 private:
  double approach(const LAMMPS_NS::Atom* grains, LAMMPS_NS::FixMeshSurface* const* meshes, int count);
  void corners(LAMMPS_NS::FixMeshSurface* mesh, std::vector<Place>& places) const;
  void look(const LAMMPS_NS::Atom* grains, LAMMPS_NS::FixMeshSurface* mesh, double reach, std::vector<Entry>& entries);

  const NearSearch& search_;
  std::vector<Place> held_;                  // grains at the last look at all
  std::vector<Place> nodes_;                 // corners of a mesh now
  std::vector<std::vector<Place>> corners_;  // of each mesh, then
  std::vector<std::vector<Entry>> entries_;
  double margin_ = 0;
  double nearer_ = 0;  // what grains and triangles have come nearer since, at most
  int age_ = 0;        // steps since the last look at all
};

}  // namespace vielto

#endif

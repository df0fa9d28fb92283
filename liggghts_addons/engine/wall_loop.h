// SPDX-License-Identifier: GPL-2.0-or-later
/* Wall loop over meshes for the laws of this package, behind LIGGGHTS' own `fix wall/gran`.

   Purpose   The same forces and histories, bit for bit, as FixWallGran::post_force_mesh, in less time. That loop
   renews, for every mesh and step, the bookkeeping of all grains, and works out the nearest point of a triangle for
   every grain in its list; here only grains near the mesh are kept in the books, and a grain whose distance to the
             triangle's plane is more than a contact reaches is passed over.
   Falls back to LIGGGHTS' loop where a feature is on that this one leaves out: superquadrics and other shapes, stored
             contact forces, multicontact radii, meshes without history. */
#ifndef LMP_FIX_VIELTO_WALL_H
#define LMP_FIX_VIELTO_WALL_H

#include <vector>

#include "fix_wall_gran.h"

namespace LAMMPS_NS {

class FixViEltoWall : public FixWallGran {
 public:
  FixViEltoWall(class LAMMPS*, int, char**);

 protected:
  void post_force_mesh(int) override;

 private:
  // A grain in the list of some triangle of a mesh, and the length of its row in the contact history.
  struct Near {
    int grain, length;
  };

  void open_books(class FixContactHistoryMesh*, std::vector<Near>&) const;
  void close_books(class FixContactHistoryMesh*, const std::vector<Near>&) const;
  void meet(class FixMeshSurface*, int imesh);

  std::vector<std::vector<Near> > near_;  // by mesh; made anew with the neighbour lists
  bool renew_ = true;
  bigint build_ = -1;  // the neighbour list that near_ belongs to
};

}  // namespace LAMMPS_NS
#endif

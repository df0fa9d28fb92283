// SPDX-License-Identifier: GPL-2.0-or-later
/* Wall loop over meshes for the laws of this package, behind LIGGGHTS' own `fix wall/gran`.

   Purpose   The same forces and histories, bit for bit, as FixWallGran::post_force_mesh, in less time. That loop
   renews, for every mesh and step, the bookkeeping of all grains, and works out the nearest point of a triangle for
   every grain in its list; here only grains that may touch the mesh within the next steps are looked at and kept in the
   books. Contacts of ViElTo are evaluated several at once (packed_law.h) but in a step of energy accounts.
   Falls back to LIGGGHTS' loop where a feature is on that this one leaves out: superquadrics and other shapes, stored
             contact forces, multicontact radii, meshes without history. */
#ifndef LMP_FIX_VIELTO_WALL_H
#define LMP_FIX_VIELTO_WALL_H

#include <vector>

#include "engine/near_walls.h"
#include "engine/packed_law.h"
#include "fix_wall_gran.h"
#include "vielto_wall_motion.h"

namespace LAMMPS_NS {

class FixViEltoWall : public FixWallGran {
 public:
  FixViEltoWall(class LAMMPS*, int, char**);

 protected:
  void post_force_mesh(int) override;

 private:
  // A grain that has, or may come into, contact with a mesh, and the length of its row in the contact history.
  struct Row {
    int grain, length;
  };
  struct Touch {
    int grain, triangle;
    double* history;
    double gap, delta[3], v[3];  // delta: from the grain to the wall; v: of the wall
  };

  bool packs() const;
  void list_rows(class FixContactHistoryMesh*, int imesh);
  void open_books(class FixContactHistoryMesh*, const std::vector<Row>&) const;
  void close_books(class FixContactHistoryMesh*, const std::vector<Row>&) const;
  void meet(class FixMeshSurface*, int imesh);
  void press(class FixMeshSurface*);
  void fill(const Touch* touches, int count, const vielto::Vec& spin);
  void add(class FixMeshSurface*, Touch* touches, int count);

  vielto::NearWalls near_;
  std::vector<std::vector<Row> > rows_;  // by mesh
  std::vector<char> listed_;             // grains in the row list that is being made
  bool renew_ = true;
  bigint build_ = -1;  // the neighbour list that near_ and rows_ belong to

  const vielto::PackedLaw* packed_ = nullptr;
  bool pack_ = false;  // in this step
  vielto::PackedStep step_ = vielto::PackedStep();
  vielto::WallMotion motion_;
  std::vector<Touch> touches_;  // of one mesh, in the order met
  vielto::Block block_ = vielto::Block();
};

}  // namespace LAMMPS_NS
#endif

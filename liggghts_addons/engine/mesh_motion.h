// SPDX-License-Identifier: GPL-2.0-or-later
/* `fix move/mesh` and `fix mesh/surface/stress`, behind LIGGGHTS' own names: the same numbers to the last bit, in less
   time.

   FixViEltoMoveMesh   A mesh that only turns, about the origin, with one mover: its corners, edges and normals turned
                       several at once in vector registers (packed_law.h).
   FixViEltoMesh       Stresses of the triangles, which nothing but an output reads, worked out for outputs only.

   LIGGGHTS' own where anything else is asked for, and with VIELTO_LANES=1. */
#ifndef LMP_VIELTO_MESH_MOTION_H
#define LMP_VIELTO_MESH_MOTION_H

#include <vector>

#include "container.h"
#include "engine/packed_law.h"
#include "fix_mesh_surface.h"
#include "fix_move_mesh.h"

namespace LAMMPS_NS {

class TriMesh;

class FixViEltoMoveMesh : public FixMoveMesh {
 public:
  FixViEltoMoveMesh(class LAMMPS*, int, char**);
  void setup(int);
  void initial_integrate(int);

 private:
  typedef MultiVectorContainer<double, 3, 3> Corners;

  bool turns_only();
  void quaternion(double dt);
  void centres(TriMesh*) const;
  void bounds(TriMesh*) const;

  const vielto::PackedLaw* packed_;
  bool quick_ = false;
  double dt_ = 0, quaternion_[4] = {}, spin_[3] = {};  // of a step of dt_; rad/s
  Corners* velocities_ = nullptr;
  std::vector<Corners*> edges_;  // three vectors a triangle, and one
  std::vector<VectorContainer<double, 3>*> normals_;
};

class FixViEltoMesh : public FixMeshSurface {
 public:
  FixViEltoMesh(class LAMMPS*, int, char**);
  int setmask();
  void setup(int);
  void pre_force(int);
  void final_integrate();
  void post_run();

 private:
  bool stress_only();
  bool must_rebuild() const;

  const vielto::PackedLaw* packed_;
  class MeshModuleStress* stress_ = nullptr;
  bool quick_ = false, owed_ = false;  // owed: the stresses of this step have not been worked out
};

}  // namespace LAMMPS_NS

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
/* What LIGGGHTS does not pass between a grain and a mesh wall: the wall's angular velocity to the contact law
   (a grain riding a paddle would see false rolling), and rolling and twisting couples back to the mesh (its
   torque sum holds forces only). A mesh moved by `fix move/mesh` is rigid, so one triangle tells the spin of all. */
#ifndef VIELTO_WALL_MOTION_H
#define VIELTO_WALL_MOTION_H

#include "container.h"
#include "fix_mesh_surface.h"
#include "mesh_module_stress.h"
#include "pointers.h"
#include "tri_mesh.h"
#include "update.h"
#include "vielto_law.h"

namespace vielto {

class WallMotion : protected LAMMPS_NS::Pointers {
 public:
  explicit WallMotion(LAMMPS_NS::LAMMPS* program)
      : LAMMPS_NS::Pointers(program), mesh_(NULL), step_(-1), stress_(NULL), stressOf_(NULL) {
    spin_ = {0, 0, 0};
  }

  // Angular velocity of the touched mesh, rad/s; zero for a primitive wall.
  template <class ContactData>
  const Vec& spin(const ContactData& sidata) {
    LAMMPS_NS::TriMesh* mesh = sidata.fix_mesh ? sidata.mesh : NULL;
    if (mesh != mesh_ || update->ntimestep != step_) {
      mesh_ = mesh;
      step_ = update->ntimestep;
      spin_ = mesh ? of_triangle(mesh, sidata.j) : Vec{0, 0, 0};
    }
    return spin_;
  }

  // Hands the couple that the grain exerts on the mesh (N m) to the mesh's torque sum.
  template <class ContactData>
  void add_couple(const ContactData& sidata, const Vec& couple) {
    if (!sidata.fix_mesh) return;
    if (sidata.fix_mesh != stressOf_) {
      stressOf_ = sidata.fix_mesh;
      stress_ = dynamic_cast<LAMMPS_NS::MeshModuleStress*>(stressOf_->get_module("stress"));
    }
    if (!stress_ || !stress_->trackStress()) return;
    double* const total = stress_->torque_total_ptr();
    total[0] += couple.x;
    total[1] += couple.y;
    total[2] += couple.z;
  }

 private:
  static Vec of_triangle(LAMMPS_NS::TriMesh* mesh, int iTri) {
    typedef LAMMPS_NS::MultiVectorContainer<double, 3, 3> Corners;
    Corners* velocities = mesh->prop().getElementProperty<Corners>("v");
    if (!velocities) return Vec{0, 0, 0};
    double** v = velocities->begin()[iTri];
    double r[3][3];
    for (int k = 0; k < 3; k++) mesh->node(iTri, k, r[k]);
    return triangle_spin(vec(r[0]), vec(r[1]), vec(r[2]), vec(v[0]), vec(v[1]), vec(v[2]));
  }
  static Vec vec(const double* a) { return {a[0], a[1], a[2]}; }

  LAMMPS_NS::TriMesh* mesh_;
  LAMMPS_NS::bigint step_;
  Vec spin_;
  LAMMPS_NS::MeshModuleStress* stress_;
  LAMMPS_NS::FixMeshSurface* stressOf_;
};

}  // namespace vielto

#endif

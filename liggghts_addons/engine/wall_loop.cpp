// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/wall_loop.h"

#include <math.h>
#include <string.h>

#include "atom.h"
#include "engine/private_access.h"
#include "fix_contact_history_mesh.h"
#include "fix_mesh_surface.h"
#include "fix_neighlist_mesh.h"
#include "neighbor.h"
#include "tri_mesh.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace vielto {
namespace {
// see vielto_open.h; true: a contact of this step, which the history keeps
struct KeepFlags {
  typedef bool** FixContactHistoryMesh::*type;
};
}  // namespace
template struct Opened<KeepFlags, &FixContactHistoryMesh::keepflag_>;
}  // namespace vielto

FixViEltoWall::FixViEltoWall(LAMMPS* lammps, int narg, char** arg) : FixWallGran(lammps, narg, arg) {}

void FixViEltoWall::post_force_mesh(int vflag) {
  bool plain = impl && !atom->shapetype_flag && !store_force_contact_ && !store_force_contact_stress_;
#ifdef SUPERQUADRIC_ACTIVE_FLAG
  plain = plain && !atom->superquadric_flag;
#endif
  for (int m = 0; m < n_FixMesh_; m++)
    plain = plain && FixMesh_list_[m]->contactHistory() && !FixMesh_list_[m]->meshMulticontactData();
  if (!plain) {
    build_ = -1;
    return FixWallGran::post_force_mesh(vflag);
  }
  // slots of grains, triangles' lists and the history's rows change with the neighbour lists only
  renew_ = update->setupflag || build_ != neighbor->lastcall || neighbor->lastcall == update->ntimestep;
  build_ = neighbor->lastcall;
  near_.resize(n_FixMesh_);
  for (int m = 0; m < n_FixMesh_; m++) {
    open_books(FixMesh_list_[m]->contactHistory(), near_[m]);
    meet(FixMesh_list_[m], m);
    close_books(FixMesh_list_[m]->contactHistory(), near_[m]);
  }
}

// Every contact is thought to have ended until it is met in this step.
void FixViEltoWall::open_books(FixContactHistoryMesh* history, std::vector<Near>& near) const {
  if (renew_) {
    history->markAllContacts();
    near.clear();
    for (int i = 0; i < nlocal_; i++) {
      const Near one = {i, history->nneighs(i)};
      if (one.length > 0) near.push_back(one);
    }
    return;
  }
  bool* const* const keep = history->*vielto::Handed<vielto::KeepFlags>::pointer;
  for (const Near& one : near) memset(keep[one.grain], 0, one.length * sizeof(bool));
}

void FixViEltoWall::close_books(FixContactHistoryMesh* history, const std::vector<Near>& near) const {
  bool* const* const keep = history->*vielto::Handed<vielto::KeepFlags>::pointer;
  for (const Near& one : near)
    for (int k = 0; k < one.length; k++)
      if (!keep[one.grain][k] && history->partner(one.grain, k) > -1) {
        history->cleanUpContacts(one.grain, one.grain + 1);
        break;
      }
}

void FixViEltoWall::meet(FixMeshSurface* fixMesh, int imesh) {
  TriMesh* const mesh = fixMesh->triMesh();
  FixContactHistoryMesh* const history = fixMesh->contactHistory();
  FixNeighlistMesh* const lists = fixMesh->meshNeighlist();
  MultiVectorContainer<double, 3, 3>* const moving =
      mesh->prop().getElementProperty<MultiVectorContainer<double, 3, 3> >("v");
  double*** const corners = moving ? moving->begin() : NULL;
  const double reach = neighbor->contactDistanceFactor - 1.0;
  atom_type_wall_ = fixMesh->atomTypeWall();
  fix_store_multicontact_data_ = NULL;
  double v[3] = {0, 0, 0};

  LIGGGHTS::ContactModels::SurfacesIntersectData contact;
  contact.is_wall = true;
  contact.mesh = mesh;
  contact.fix_mesh = fixMesh;
  const int triangles = mesh->sizeLocal() + mesh->sizeGhost();
  for (int t = 0; t < triangles; t++) {
    const std::vector<int>& list = lists->get_contact_list(t);
    if (list.empty()) continue;
    const int triangle = mesh->id(t);
    double origin[3], normal[3];
    mesh->node(t, 0, origin);
    mesh->surfaceNorm(t, normal);
    for (const int i : list) {
      if (i >= nlocal_) continue;
      const double radius = radius_ ? radius_[i] : r0_;
      const double height =
          (x_[i][0] - origin[0]) * normal[0] + (x_[i][1] - origin[1]) * normal[1] + (x_[i][2] - origin[2]) * normal[2];
      // 1e-6: the normal turns with the mesh and carries its round-off
      if (fabs(height) > radius * (1 + reach + 1e-6)) continue;
      double delta[3], bary[3];
      int side = -1;
      const double gap = mesh->resolveTriSphereContactBary(i, t, radius, x_[i], delta, bary, side, true);
      if (gap > cutneighmax_ || (gap > 0 && gap >= reach * radius)) continue;
      const bool touching = gap <= 0;
      if (!history->handleContact(i, triangle, contact.contact_history, touching, side == 7)) continue;
      if (corners)
        for (int d = 0; d < 3; d++)
          v[d] = bary[0] * corners[t][0][d] + bary[1] * corners[t][1][d] + bary[2] * corners[t][2][d];
      contact.i = i;
      contact.radi = radius;
      contact.deltan = -gap;
      for (int d = 0; d < 3; d++) contact.delta[d] = -delta[d];
      impl->compute_force(this, contact, touching, v, fixMesh, imesh, mesh, t);
    }
  }
}

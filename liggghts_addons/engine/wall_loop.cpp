// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/wall_loop.h"

#include <math.h>
#include <string.h>

#include <algorithm>

#include "atom.h"
#include "engine/packed_wall.h"
#include "engine/private_access.h"
#include "fix_contact_history_mesh.h"
#include "fix_mesh_surface.h"
#include "fix_neighlist_mesh.h"
#include "neighbor.h"
#include "tri_mesh.h"
#include "update.h"

namespace vielto {
namespace {
// see vielto_open.h; true: a contact of this step, which the history keeps
struct KeepFlags {
  typedef bool** LAMMPS_NS::FixContactHistoryMesh::*type;
};
}  // namespace
template struct Opened<KeepFlags, &LAMMPS_NS::FixContactHistoryMesh::keepflag_>;
}  // namespace vielto

namespace LAMMPS_NS {

using vielto::Block;
using vielto::Handed;
using vielto::KeepFlags;
using vielto::LawSettings;
using vielto::NearWalls;
using vielto::PackedWall;
using vielto::tally;
using vielto::Vec;

FixViEltoWall::FixViEltoWall(LAMMPS* lammps, int narg, char** arg)
    : FixWallGran(lammps, narg, arg),
      near_(vielto::near_search(lammps)),
      packed_(vielto::packed_law(lammps)),
      motion_(lammps) {}

void FixViEltoWall::post_force_mesh(int vflag) {
  bool plain = impl && radius_ && !atom->shapetype_flag && !store_force_contact_ && !store_force_contact_stress_;
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
  rows_.resize(n_FixMesh_);
  const double reach = neighbor->contactDistanceFactor - 1.0;
  pack_ = packs();
  const bool looked = near_.begin(atom, FixMesh_list_, n_FixMesh_, reach, renew_);
  for (int m = 0; m < n_FixMesh_; m++) {
    FixContactHistoryMesh* const history = FixMesh_list_[m]->contactHistory();
    if (looked) list_rows(history, m);
    open_books(history, rows_[m]);
    meet(FixMesh_list_[m], m);
    close_books(history, rows_[m]);
  }
}

void FixViEltoWall::list_rows(FixContactHistoryMesh* history, int imesh) {
  listed_.assign(nlocal_, 0);
  for (const NearWalls::Entry& entry : near_.of(imesh)) listed_[entry.grain] = 1;
  rows_[imesh].clear();
  for (int i = 0; i < nlocal_; i++) {
    const int length = history->nneighs(i);
    for (int k = 0; k < length && !listed_[i]; k++) listed_[i] = history->partner(i, k) > -1;
    if (listed_[i] && length > 0) rows_[imesh].push_back({i, length});
  }
}

// Every contact is thought to have ended until it is met in this step.
void FixViEltoWall::open_books(FixContactHistoryMesh* history, const std::vector<Row>& rows) const {
  if (renew_) return history->markAllContacts();
  bool* const* const keep = history->*Handed<KeepFlags>::pointer;
  for (const Row& row : rows) memset(keep[row.grain], 0, row.length * sizeof(bool));
}

void FixViEltoWall::close_books(FixContactHistoryMesh* history, const std::vector<Row>& rows) const {
  bool* const* const keep = history->*Handed<KeepFlags>::pointer;
  for (const Row& row : rows)
    for (int k = 0; k < row.length; k++)
      if (!keep[row.grain][k] && history->partner(row.grain, k) > -1) {
        history->cleanUpContacts(row.grain, row.grain + 1);
        break;
      }
}

// Whether this step needs nothing of a contact but its force, couple and history.
bool FixViEltoWall::packs() const {
  return packed_ && dynamic_cast<PackedWall*>(impl) && computeflag_ && shearupdate_ && !tally().energy &&
         !store_force_ && !store_sum_normal_force() && !heattransfer_flag_ && !(cwl_ && addflag_) &&
         impl->get_history_offset("dissipation_force") < 0;
}

void FixViEltoWall::meet(FixMeshSurface* fixMesh, int imesh) {
  const std::vector<NearWalls::Entry>& entries = near_.of(imesh);
  atom_type_wall_ = fixMesh->atomTypeWall();
  fix_store_multicontact_data_ = NULL;
  if (entries.empty()) return;
  TriMesh* const mesh = fixMesh->triMesh();
  FixContactHistoryMesh* const history = fixMesh->contactHistory();
  MultiVectorContainer<double, 3, 3>* const moving =
      mesh->prop().getElementProperty<MultiVectorContainer<double, 3, 3> >("v");
  double*** const corners = moving ? moving->begin() : NULL;
  const double reach = neighbor->contactDistanceFactor - 1.0;
  touches_.clear();

  LIGGGHTS::ContactModels::SurfacesIntersectData contact;
  contact.is_wall = true;
  contact.mesh = mesh;
  contact.fix_mesh = fixMesh;
  int t = -1;
  double origin[3] = {0, 0, 0}, normal[3] = {0, 0, 0};
  for (const NearWalls::Entry& entry : entries) {
    if (entry.gap > near_.nearer()) continue;
    const int i = entry.grain;
    if (entry.triangle != t) {
      t = entry.triangle;
      mesh->node(t, 0, origin);
      mesh->surfaceNorm(t, normal);
    }
    const double radius = radius_[i];
    const double height =
        (x_[i][0] - origin[0]) * normal[0] + (x_[i][1] - origin[1]) * normal[1] + (x_[i][2] - origin[2]) * normal[2];
    // 1e-6: the normal turns with the mesh and carries its round-off
    if (fabs(height) > radius * (1 + reach + 1e-6)) continue;
    double bary[3];
    Touch touch = {i, t, NULL, 0, {0, 0, 0}, {0, 0, 0}};
    int side = -1;
    touch.gap = mesh->resolveTriSphereContactBary(i, t, radius, x_[i], touch.delta, bary, side, true);
    if (touch.gap > cutneighmax_ || (touch.gap > 0 && touch.gap >= reach * radius)) continue;
    const bool touching = touch.gap <= 0;
    if (!history->handleContact(i, mesh->id(t), touch.history, touching, side == 7)) continue;
    if (corners)
      for (int d = 0; d < 3; d++)
        touch.v[d] = bary[0] * corners[t][0][d] + bary[1] * corners[t][1][d] + bary[2] * corners[t][2][d];
    if (pack_ && touching) {
      touches_.push_back(touch);
      continue;
    }
    contact.i = i;
    contact.radi = radius;
    contact.deltan = -touch.gap;
    contact.contact_history = touch.history;
    for (int d = 0; d < 3; d++) contact.delta[d] = -touch.delta[d];
    impl->compute_force(this, contact, touching, touch.v, fixMesh, imesh, mesh, t);
  }
  if (!touches_.empty()) press(fixMesh);
}

// The contacts of one mesh, several at once.
void FixViEltoWall::press(FixMeshSurface* fixMesh) {
  step_ = dynamic_cast<PackedWall*>(impl)->packed_step();
  step_.dt = update->dt;
  LIGGGHTS::ContactModels::SurfacesIntersectData first;
  first.mesh = fixMesh->triMesh();
  first.fix_mesh = fixMesh;
  first.j = touches_[0].triangle;
  const Vec spin = motion_.spin(first);
  const int all = static_cast<int>(touches_.size());
  for (int from = 0; from < all; from += Block::size) {
    const int count = std::min(all - from, Block::size);
    fill(&touches_[from], count, spin);
    step_.greatestOverlap = tally().overlapMax;
    packed_->walls(step_, block_, count);
    add(fixMesh, &touches_[from], count);
  }
}

void FixViEltoWall::fill(const Touch* touches, int count, const Vec& spin) {
  const PackedWall& law = *dynamic_cast<PackedWall*>(impl);
  const LawSettings& s = step_.settings;
  const double turning[3] = {spin.x, spin.y, spin.z};
  Block& b = block_;
  b.alike = true;
  for (int k = 0; k < count; k++) {
    const Touch& touch = touches[k];
    const int i = touch.grain;
    b.gap[k] = -touch.gap;
    b.R1[k] = radius_[i];
    b.m1[k] = fix_rigid_ && body_[i] >= 0 ? masstotal_[body_[i]] : atom->rmass[i];
    b.pair[k] = law.place(atom->type[i], atom_type_wall_);
    b.alike = b.alike && b.pair[k] == b.pair[0];
    for (int d = 0; d < 3; d++) {
      b.delta[d][k] = -touch.delta[d];
      b.v[d][k] = atom->v[i][d] - touch.v[d];
      b.spin1[d][k] = atom->omega[i][d];
      b.spin2[d][k] = turning[d];
      b.sliding[d][k] = touch.history[s.slidingAt + d];
      if (s.rolling) b.rolling[d][k] = touch.history[s.rollingAt + d];
    }
    if (s.rolling) b.twisting[k] = touch.history[s.rollingAt + 3];
  }
}

// In the order in which the contacts were met, as LIGGGHTS adds them one by one.
void FixViEltoWall::add(FixMeshSurface* fixMesh, Touch* touches, int count) {
  const LawSettings& s = step_.settings;
  const Block& b = block_;
  LIGGGHTS::ContactModels::SurfacesIntersectData contact;
  contact.is_wall = true;
  contact.mesh = fixMesh->triMesh();
  contact.fix_mesh = fixMesh;
  for (int k = 0; k < count; k++) {
    Touch& touch = touches[k];
    const int i = touch.grain;
    const double diameter = 2 * b.R1[k];
    if (tally().overlaps || b.overlap[k] > tally().overlapMax * diameter || b.normal[k] > tally().wallForce) {
      contact.i = i;
      contact.j = touch.triangle;
      contact.radi = b.R1[k];
      contact.deltan = b.overlap[k];
      contact.Fn = b.normal[k];
      dynamic_cast<PackedWall*>(impl)->watch(contact, diameter);
    }
    if (s.rolling) motion_.add_couple(contact, {b.torque2[0][k], b.torque2[1][k], b.torque2[2][k]});
    double *f = atom->f[i], *torque = atom->torque[i], onGrain[3];
    for (int d = 0; d < 3; d++) {
      touch.history[s.slidingAt + d] = b.sliding[d][k];
      if (s.rolling) touch.history[s.rollingAt + d] = b.rolling[d][k];
      const double before = f[d];
      f[d] += b.force[d][k];
      torque[d] += b.torque1[d][k];
      // what the mesh is told of is the difference, rounded as LIGGGHTS rounds it
      onGrain[d] = f[d] - before;
    }
    if (s.rolling) touch.history[s.rollingAt + 3] = b.twisting[k];
    fixMesh->add_particle_contribution(i, onGrain, touch.delta, touch.triangle, touch.v);
  }
}

}  // namespace LAMMPS_NS

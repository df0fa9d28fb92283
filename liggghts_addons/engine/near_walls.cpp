// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/near_walls.h"

#include <math.h>

#include <algorithm>

#include "atom.h"
#include "fix_mesh_surface.h"
#include "fix_neighlist_mesh.h"
#include "tri_mesh.h"

using namespace LAMMPS_NS;

namespace vielto {

namespace {

int triangles(TriMesh* mesh) { return mesh->sizeLocal() + mesh->sizeGhost(); }

}  // namespace

bool NearWalls::begin(const Atom* grains, FixMeshSurface* const* meshes, int count, double reach, bool renewed) {
  age_++;
  const size_t all = static_cast<size_t>(grains->nlocal);
  if (!renewed && held_.size() == all) {
    // 1e-9: margin and gaps are compared with rounded distances
    nearer_ = approach(grains, meshes, count) * (1 + 1e-9);
    if (nearer_ < margin_) return false;
    margin_ = 16 * nearer_ / age_;
  }
  age_ = 0;
  nearer_ = 0;
  held_.resize(all);
  // LIGGGHTS keeps the three values of a grain after those of the one before
  if (all > 0) search_.places(grains->x[0], grains->radius, all, held_.data());
  corners_.resize(count);
  entries_.resize(count);
  for (int m = 0; m < count; m++) {
    corners(meshes[m], corners_[m]);
    look(grains, meshes[m], reach, entries_[m]);
  }
  return true;
}

// How much nearer any grain may be to any triangle than at the last look, at most.
double NearWalls::approach(const Atom* atoms, FixMeshSurface* const* meshes, int count) {
  Drift grains = {0, 0};
  if (!held_.empty()) grains = search_.moved(atoms->x[0], atoms->radius, held_.size(), held_.data(), nullptr);
  double turned = 0;
  for (int m = 0; m < count; m++) {
    TriMesh* const mesh = meshes[m]->triMesh();
    if (!mesh->isMoving() && !mesh->isDeforming()) continue;
    // a point of a triangle goes no farther than the corner that goes farthest
    corners(meshes[m], nodes_);
    if (nodes_.size() != corners_[m].size()) return INFINITY;
    turned = std::max(turned, search_.drift(nodes_.data(), corners_[m].data(), nodes_.size()).square);
  }
  return sqrt(grains.square) + sqrt(turned) + grains.growth;
}

void NearWalls::corners(FixMeshSurface* fix, std::vector<Place>& places) const {
  TriMesh* const mesh = fix->triMesh();
  places.resize(3 * triangles(mesh));
  for (int t = 0; t < triangles(mesh); t++)
    for (int k = 0; k < 3; k++) {
      double node[3];
      mesh->node(t, k, node);
      places[3 * t + k] = {node[0], node[1], node[2], 0};
    }
}

void NearWalls::look(const Atom* grains, FixMeshSurface* fix, double reach, std::vector<Entry>& entries) {
  TriMesh* const mesh = fix->triMesh();
  FixNeighlistMesh* const lists = fix->meshNeighlist();
  entries.clear();
  for (int t = 0; t < triangles(mesh); t++) {
    const std::vector<int>& list = lists->get_contact_list(t);
    if (list.empty()) continue;
    double origin[3], normal[3];
    mesh->node(t, 0, origin);
    mesh->surfaceNorm(t, normal);
    for (const int i : list) {
      if (i >= grains->nlocal) continue;
      double* const x = grains->x[i];
      const double radius = grains->radius[i], far = radius * (1 + reach + 1e-6);
      const double height =
          (x[0] - origin[0]) * normal[0] + (x[1] - origin[1]) * normal[1] + (x[2] - origin[2]) * normal[2];
      // 1e-6: the normal turns with the mesh and carries its round-off
      if (fabs(height) > far + margin_) continue;
      double delta[3], bary[3];
      int side = -1;
      // the whole triangle, with the corners and edges that another triangle answers for
      const double gap = mesh->resolveTriSphereContactBary(i, t, radius, x, delta, bary, side, false) + radius - far;
      if (gap < margin_) entries.push_back({t, i, gap});
    }
  }
}

}  // namespace vielto

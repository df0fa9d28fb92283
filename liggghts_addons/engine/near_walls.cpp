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

double square(double dx, double dy, double dz) { return dx * dx + dy * dy + dz * dz; }

}  // namespace

bool NearWalls::begin(const Atom* grains, FixMeshSurface* const* meshes, int count, double reach, bool renewed) {
  age_++;
  if (!renewed && held_.size() == static_cast<std::size_t>(grains->nlocal)) {
    const double nearer = approach(grains, meshes, count);
    // 1e-9: the margin was compared with rounded distances
    if (nearer < margin_ * (1 - 1e-9)) return false;
    margin_ = 16 * nearer / age_;
  }
  age_ = 0;
  held_.resize(grains->nlocal);
  for (int i = 0; i < grains->nlocal; i++) {
    const double* const x = grains->x[i];
    held_[i] = {x[0], x[1], x[2], grains->radius[i]};
  }
  corners_.resize(count);
  entries_.resize(count);
  for (int m = 0; m < count; m++) {
    TriMesh* const mesh = meshes[m]->triMesh();
    corners_[m].resize(9 * triangles(mesh));
    for (int t = 0; t < triangles(mesh); t++)
      for (int k = 0; k < 3; k++) mesh->node(t, k, &corners_[m][9 * t + 3 * k]);
    look(grains, meshes[m], reach, entries_[m]);
  }
  return true;
}

// How much nearer any grain may be to any triangle than at the last look, at most.
double NearWalls::approach(const Atom* grains, FixMeshSurface* const* meshes, int count) const {
  double farthest = 0, growth = 0, turned = 0;
  for (int i = 0; i < grains->nlocal; i++) {
    const double* const x = grains->x[i];
    const Place& h = held_[i];
    farthest = std::max(farthest, square(x[0] - h.x, x[1] - h.y, x[2] - h.z));
    growth = std::max(growth, grains->radius[i] - h.radius);
  }
  for (int m = 0; m < count; m++) {
    TriMesh* const mesh = meshes[m]->triMesh();
    if (!mesh->isMoving() && !mesh->isDeforming()) continue;
    if (corners_[m].size() != static_cast<std::size_t>(9 * triangles(mesh))) return INFINITY;
    // a point of a triangle goes no farther than the corner that goes farthest
    for (int t = 0; t < triangles(mesh); t++)
      for (int k = 0; k < 3; k++) {
        double now[3];
        mesh->node(t, k, now);
        const double* const then = &corners_[m][9 * t + 3 * k];
        turned = std::max(turned, square(now[0] - then[0], now[1] - then[1], now[2] - then[2]));
      }
  }
  return sqrt(farthest) + sqrt(turned) + growth;
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
      const double radius = grains->radius[i], far = radius * (1 + reach + 1e-6) + margin_;
      const double height =
          (x[0] - origin[0]) * normal[0] + (x[1] - origin[1]) * normal[1] + (x[2] - origin[2]) * normal[2];
      // 1e-6: the normal turns with the mesh and carries its round-off
      if (fabs(height) > far) continue;
      double delta[3], bary[3];
      int side = -1;
      // the whole triangle, with the corners and edges that another triangle answers for
      if (mesh->resolveTriSphereContactBary(i, t, radius, x, delta, bary, side, false) + radius < far)
        entries.push_back({t, i});
    }
  }
}

}  // namespace vielto

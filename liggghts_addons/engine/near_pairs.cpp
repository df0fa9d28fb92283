// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/near_pairs.h"

#include <math.h>

#include <algorithm>

#include "atom.h"
#include "lammps.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

namespace vielto {

bool NearPairs::begin(const LAMMPS_NS::LAMMPS* lmp, const LAMMPS_NS::NeighList* list) {
  const LAMMPS_NS::Neighbor* const neighbor = lmp->neighbor;
  const LAMMPS_NS::Atom* const grains = lmp->atom;
  const bool renewed =
      lmp->update->setupflag || build_ != neighbor->lastcall || neighbor->lastcall == lmp->update->ntimestep;
  build_ = neighbor->lastcall;
  const size_t count = grains->nlocal + grains->nghost;
  places_.resize(count);
  for (size_t i = 0; i < count; i++) {
    const double* const x = grains->x[i];
    places_[i] = {x[0], x[1], x[2], grains->radius[i]};
  }
  age_++;
  if (!renewed && count == held_.size() && within_margin(count)) return false;
  age_ = 0;
  held_ = places_;
  near_.clear();
  touching_.clear();
  start_.assign(list->inum + 1, 0);
  return true;
}

bool NearPairs::within_margin(size_t count) {
  double farthest = 0, growth = 0;
  for (size_t i = 0; i < count; i++) {
    const Place &now = places_[i], &then = held_[i];
    const double dx = now.x - then.x, dy = now.y - then.y, dz = now.z - then.z;
    farthest = std::max(farthest, dx * dx + dy * dy + dz * dz);
    growth = std::max(growth, now.radius - then.radius);
  }
  const double nearer = 2 * (sqrt(farthest) + growth);
  // 1e-9: the margin was compared with rounded distances
  if (nearer < margin_ * (1 - 1e-9)) return true;
  margin_ = 16 * nearer / age_;
  return false;
}

size_t NearPairs::find(const LAMMPS_NS::NeighList* list) {
  // room for all, so that hits are counted without a branch, which the processor would guess wrongly
  if (hits_.size() < near_.size() + 1) hits_.resize(near_.size() + 1);
  Hit* const hits = hits_.data();
  size_t found = 0;
  for (int row = 0; row < list->inum; row++) {
    const Place me = places_[list->ilist[row]];
    for (size_t k = start_[row]; k < start_[row + 1]; k++) {
      const Place& other = places_[near_[k].grain];
      const double dx = me.x - other.x, dy = me.y - other.y, dz = me.z - other.z;
      const double radii = me.radius + other.radius;
      hits[found] = {row, k};
      found += (dx * dx + dy * dy + dz * dz < radii * radii) | touching_[k];
    }
  }
  return found;
}

}  // namespace vielto

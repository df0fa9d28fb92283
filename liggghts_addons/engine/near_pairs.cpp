// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/near_pairs.h"

#include <math.h>

#include <algorithm>

#include "atom.h"
#include "engine/pair_list.h"
#include "lammps.h"
#include "neighbor.h"
#include "update.h"

namespace vielto {

bool NearPairs::begin(const LAMMPS_NS::LAMMPS* lmp) {
  const LAMMPS_NS::Neighbor* const neighbor = lmp->neighbor;
  const LAMMPS_NS::Atom* const grains = lmp->atom;
  const bool renewed =
      lmp->update->setupflag || build_ != neighbor->lastcall || neighbor->lastcall == lmp->update->ntimestep;
  build_ = neighbor->lastcall;
  // at the start of a run LIGGGHTS has set up its own anew
  if (lmp->update->setupflag) take_pair_lists(lmp->neighbor);
  const size_t count = grains->nlocal + grains->nghost;
  places_.resize(count);
  age_++;
  // LIGGGHTS keeps the three values of a grain after those of the one before
  if (!renewed && count == held_.size()) {
    if (count == 0) return false;
    if (within_margin(search_.moved(grains->x[0], grains->radius, count, held_.data(), places_.data()))) return false;
  } else if (count > 0) {
    search_.places(grains->x[0], grains->radius, count, places_.data());
  }
  age_ = 0;
  held_ = places_;
  nearCount_ = 0;
  std::fill(was_.begin(), was_.end(), 0);
  return true;
}

bool NearPairs::within_margin(const Drift& drift) {
  const double nearer = 2 * (sqrt(drift.square) + drift.growth);
  // 1e-9: the margin was compared with rounded distances
  if (nearer < margin_ * (1 - 1e-9)) return true;
  margin_ = 16 * nearer / age_;
  return false;
}

const Touching& NearPairs::find() {
  const size_t lanes = static_cast<size_t>(search_.lanes), count = nearCount_;
  if (pairs_.size() < count + lanes) pairs_.resize(count + lanes), parted_.resize(count + lanes);
  touching_ = {pairs_.data(), 0, parted_.data(), 0};
  if (near_.size() < count + lanes) near_.resize(count + lanes);
  std::fill_n(near_.begin() + static_cast<std::ptrdiff_t>(count), lanes, NearPair());  // see NearSearch
  search_.touching(places_.data(), near_.data(), count, was_.data(), touching_);
  return touching_;
}

}  // namespace vielto

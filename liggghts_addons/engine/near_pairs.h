// SPDX-License-Identifier: GPL-2.0-or-later
/* Which neighbours of a list may touch: those nearer than a margin when all were looked at last, for as long as no
   grain has gone, or grown, half of it since. The margin follows the grains' speed so that a look at all comes every 16
   steps; it changes nothing but the time. */
#ifndef VIELTO_NEAR_PAIRS_H
#define VIELTO_NEAR_PAIRS_H

#include <vector>

#include "engine/near_search.h"
#include "lmptype.h"

namespace LAMMPS_NS {
class LAMMPS;
class NeighList;
}  // namespace LAMMPS_NS

namespace vielto {

class NearPairs {
 public:
  explicit NearPairs(const NearSearch& search) : search_(search) {}

  /* Call once a step; takes up the grains' places. True: all have to be looked at, which `look` does for one grain of
     the list after the other, from the first to the last. */
  bool begin(const LAMMPS_NS::LAMMPS* lmp);
  /* The neighbours of a grain, with the flags and the histories (`stride` numbers each) of the list. Slots whose flag
     is set though they are out of reach are handed to `part(flags, history)`. */
  template <class Part>
  void look(int grain, const int* neighbours, int count, int* flags, double* histories, int stride, Part part);
  // The pairs that touch, and those that have parted.
  const Touching& find();
  const Place* places() const { return places_.data(); }
  const NearPair* pairs() const { return near_.data(); }
  // Somebody else has handled the contacts of a step.
  void forget() { build_ = -1; }

 private:
  bool within_margin(const Drift& drift);

  const NearSearch& search_;
  std::vector<Place> places_, held_;  // now; at the last look at all
  std::vector<NearPair> near_;        // of one grain after the other; the first nearCount_, with room for more
  size_t nearCount_ = 0;
  std::vector<unsigned char> was_;  // touching in the step before, see NearSearch
  std::vector<size_t> pairs_, parted_;
  Touching touching_ = {NULL, 0, NULL, 0};
  double margin_ = 0;
  LAMMPS_NS::bigint build_ = -1;  // the neighbour list that near_ belongs to
  int age_ = 0;                   // steps since the last look at all
};

template <class Part>
void NearPairs::look(int grain, const int* neighbours, int count, int* flags, double* histories, int stride,
                     Part part) {
  const Place me = places_[grain];
  const size_t lanes = static_cast<size_t>(search_.lanes), most = nearCount_ + static_cast<size_t>(count);
  if (near_.size() < most + lanes) near_.resize(2 * (most + lanes));
  if (was_.size() < most / lanes + 1) was_.resize(2 * (most / lanes + 1));
  // without a branch for those that are near, which the processor would guess wrongly
  for (int slot = 0; slot < count; slot++) {
    const int j = neighbours[slot] & NEIGHMASK;
    const Place& other = places_[j];
    const double dx = me.x - other.x, dy = me.y - other.y, dz = me.z - other.z;
    const double far = me.radius + other.radius + margin_;
    const bool near = dx * dx + dy * dy + dz * dz < far * far, flagged = flags[slot] != 0;
    if (flagged && !near) part(flags + slot, histories + stride * slot);
    unsigned char& was = was_[nearCount_ / lanes];
    was = static_cast<unsigned char>(was | (near && flagged) << nearCount_ % lanes);
    near_[nearCount_] = {grain, j, flags + slot, histories + stride * slot};
    nearCount_ += near;
  }
}

}  // namespace vielto

#endif

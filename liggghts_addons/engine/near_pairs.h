// SPDX-License-Identifier: GPL-2.0-or-later
/* Which neighbours of a list may touch: those nearer than a margin when all were looked at last, for as long as no
   grain has gone, or grown, half of it since. The margin follows the grains' speed so that a look at all comes every 16
   steps; it changes nothing but the time. */
#ifndef VIELTO_NEAR_PAIRS_H
#define VIELTO_NEAR_PAIRS_H

#include <stddef.h>

#include <vector>

#include "lmptype.h"

namespace LAMMPS_NS {
class LAMMPS;
class NeighList;
}  // namespace LAMMPS_NS

namespace vielto {

// Side by side, for one read of memory a neighbour.
struct Place {
  double x, y, z, radius;
};

class NearPairs {
 public:
  struct Near {
    int grain, slot;  // the neighbour, and its place in the list of its grain
  };
  // A pair that touches, or did in the step before.
  struct Hit {
    int row;      // of the first grain in the neighbour list
    size_t near;  // of the pair in near()
  };

  /* Call once a step; takes up the grains' places. True: all have to be looked at, which `look` does for one grain of
     the list after the other, from the first to the last. */
  bool begin(const LAMMPS_NS::LAMMPS* lmp, const LAMMPS_NS::NeighList* list);
  /* The neighbours of the grain in row `row`. Slots whose flag is set though they are out of reach are handed to
     `part(slot)`. */
  template <class Part>
  void look(int row, int grain, const int* neighbours, int count, const int* flags, Part part);
  // Finds the pairs that touch, or did, and tells how many.
  size_t find(const LAMMPS_NS::NeighList* list);
  const Hit& hit(size_t k) const { return hits_[k]; }
  const Place& place(int grain) const { return places_[grain]; }
  const Near& near(size_t k) const { return near_[k]; }
  void touches(size_t k, bool now) { touching_[k] = now; }
  // Somebody else has handled the contacts of a step.
  void forget() { build_ = -1; }

 private:
  bool within_margin(size_t count);

  std::vector<Place> places_, held_;  // now; at the last look at all
  std::vector<Near> near_;            // of one grain after the other
  std::vector<char> touching_;        // by pair, in the step before
  std::vector<size_t> start_;         // of a row in near_
  std::vector<Hit> hits_;
  double margin_ = 0;
  LAMMPS_NS::bigint build_ = -1;  // the neighbour list that near_ belongs to
  int age_ = 0;                   // steps since the last look at all
};

template <class Part>
void NearPairs::look(int row, int grain, const int* neighbours, int count, const int* flags, Part part) {
  const Place me = places_[grain];
  start_[row] = near_.size();
  for (int slot = 0; slot < count; slot++) {
    const int j = neighbours[slot] & NEIGHMASK;
    const Place& other = places_[j];
    const double dx = me.x - other.x, dy = me.y - other.y, dz = me.z - other.z;
    const double far = me.radius + other.radius + margin_;
    if (dx * dx + dy * dy + dz * dz < far * far) {
      near_.push_back({j, slot});
      touching_.push_back(flags[slot] != 0);
    } else if (flags[slot]) {
      part(slot);
    }
  }
  start_[row + 1] = near_.size();
}

}  // namespace vielto

#endif

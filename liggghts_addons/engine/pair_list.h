// SPDX-License-Identifier: GPL-2.0-or-later
/* The list of neighbouring grains, behind LIGGGHTS' own builder: the same neighbours in the same order, with the same
   histories, in less time. Grains lie sorted by bin, so that a row of bins is looked through several grains at once in
   vector registers (packed_law.h) where LIGGGHTS follows a chain from grain to grain.
   LIGGGHTS' own where groups or pairs are left out of the list, and with VIELTO_LANES=1. */
#ifndef VIELTO_PAIR_LIST_H
#define VIELTO_PAIR_LIST_H

#include <stddef.h>

namespace LAMMPS_NS {
class Neighbor;
}

namespace vielto {

// Grains by bin, then by number; behind the last stand as many more as a register holds, to be read and left out.
struct BinnedGrains {
  const double *x, *y, *z, *radius, *number;
};

struct GrainToPair {
  double x, y, z, radius, number;
  double factor, skin;  // neighbours are nearer than factor times both radii and the skin
};

// For the lists of the runs to come; call when LIGGGHTS has set up its own.
void take_pair_lists(LAMMPS_NS::Neighbor* neighbor);

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
/* What near_pairs.h and near_walls.h do to all grains in each step, in plain C++ (plain_search) and for several grains
   at once in vector registers; both give the same. */
#ifndef VIELTO_NEAR_SEARCH_H
#define VIELTO_NEAR_SEARCH_H

#include <stddef.h>

namespace vielto {

// Side by side, for one read of memory a neighbour, which never lies on both sides of a cache line's end.
struct alignas(32) Place {
  double x, y, z, radius;
};

// Two grains near each other, and what the neighbour list keeps of them.
struct NearPair {
  int i, j;
  int* flags;
  double* history;
};

/* Pairs that touch, and those that did in the step before and no longer do, by their number, in their order. After the
   last that touches stand `lanes` repetitions of it, for registers that are filled whole. */
struct Touching {
  size_t* pairs;
  size_t count;
  size_t* parted;
  size_t partedCount;
};

// Square of a distance that nothing has gone beyond, m2, and that of a radius' growth, m: no less than the greatest.
struct Drift {
  double square, growth;
};

struct NearSearch {
  int lanes;
  // x: three values a grain
  void (*places)(const double* x, const double* radius, size_t count, Place*);
  Drift (*drift)(const Place* now, const Place* then, size_t count);
  // From `then` to the places of x and radius, which are written to `now` unless it is NULL.
  Drift (*moved)(const double* x, const double* radius, size_t count, const Place* then, Place* now);
  /* After the last pair stand `lanes` more to be read and left out. was: one bit a pair, of `lanes` pairs in a byte, is
     renewed. The lists of `touching` have room for all pairs and `lanes` more. */
  void (*touching)(const Place*, const NearPair*, size_t count, unsigned char* was, Touching&);
};

extern const NearSearch plain_search;

}  // namespace vielto

#endif

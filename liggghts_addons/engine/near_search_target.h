// SPDX-License-Identifier: GPL-2.0-or-later
// The body of near_search.h for the registers that packed_number.h is compiled for; see there.
#ifndef VIELTO_NEAR_SEARCH_TARGET_H
#define VIELTO_NEAR_SEARCH_TARGET_H

#include <algorithm>

#include "engine/near_search.h"
#include "engine/packed_number.h"

namespace vielto {
namespace {

static_assert(sizeof(Place) == 4 * sizeof(double), "a place is a row of four numbers");
static_assert(Pack::lanes <= 8, "one bit of a byte each");

// Reads the number after the row: the next grain's first, so not for the last grain.
VIELTO_INLINE hn::Vec<RowTag> place_of(const double* x, const double* radius, size_t i) {
  const hn::Vec<RowTag> row = hn::LoadU(RowTag(), x + 3 * i), last = hn::Set(RowTag(), radius[i]);
  return hn::IfThenElse(hn::FirstN(RowTag(), 3), row, last);
}

void near_places(const double* x, const double* radius, size_t count, Place* out) {
  size_t i = 0;
  if constexpr (transposes)
    for (; i + 1 < count; i++) hn::StoreU(place_of(x, radius, i), RowTag(), &out[i].x);
  for (; i < count; i++) out[i] = {x[3 * i], x[3 * i + 1], x[3 * i + 2], radius[i]};
}

VIELTO_INLINE double greatest(const Pack& a) { return hn::GetLane(hn::MaxOfLanes(Tag(), a.v)); }

Drift near_drift(const Place* now, const Place* then, size_t count) {
  Pack square = 0.0, growth = 0.0;
  const size_t whole = count / Pack::lanes * Pack::lanes;
  for (size_t i = 0; i < whole; i += Pack::lanes) {
    Pack a[4], b[4];
    columns<4>([&](int lane) { return &now[i + lane].x; }, a);
    columns<4>([&](int lane) { return &then[i + lane].x; }, b);
    const Pack dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
    square = hn::Max(square.v, (dx * dx + dy * dy + dz * dz).v);
    growth = hn::Max(growth.v, (a[3] - b[3]).v);
  }
  const Drift rest = plain_search.drift(now + whole, then + whole, count - whole);
  return {std::max(greatest(square), rest.square), std::max(greatest(growth), rest.growth)};
}

// The greatest change of each coordinate; nothing has gone farther than the length of the three.
template <bool Write>
VIELTO_INLINE Drift moved(const double* x, const double* radius, size_t count, const Place* then, Place* now) {
  double most[4] = {0, 0, 0, 0};
  size_t i = 0;
  if constexpr (transposes) {
    // two at once: the greatest of each waits for the one before
    hn::Vec<RowTag> change[2] = {hn::Zero(RowTag()), hn::Zero(RowTag())};
    for (; i + 2 < count; i += 2)
      for (size_t k = 0; k < 2; k++) {
        const hn::Vec<RowTag> place = place_of(x, radius, i + k);
        change[k] = hn::Max(change[k], hn::Abs(hn::Sub(place, hn::LoadU(RowTag(), &then[i + k].x))));
        if (Write) hn::StoreU(place, RowTag(), &now[i + k].x);
      }
    hn::StoreU(hn::Max(change[0], change[1]), RowTag(), most);
  }
  const Drift rest = plain_search.moved(x + 3 * i, radius + i, count - i, then + i, Write ? now + i : nullptr);
  return {std::max(most[0] * most[0] + most[1] * most[1] + most[2] * most[2], rest.square),
          std::max(most[3], rest.growth)};
}

Drift near_moved(const double* x, const double* radius, size_t count, const Place* then, Place* now) {
  return now ? moved<true>(x, radius, count, then, now) : moved<false>(x, radius, count, then, now);
}

typedef hn::RebindToUnsigned<Tag> Index;

void near_touching(const Place* places, const NearPair* pairs, size_t count, unsigned char* was, Touching& found) {
  found.count = found.partedCount = 0;
  for (size_t k = 0; k < count; k += Pack::lanes) {
    const size_t lanes = std::min<size_t>(Pack::lanes, count - k);
    Pack one[4], two[4];
    columns<4>([&](int lane) { return &places[pairs[k + lane].i].x; }, one);
    columns<4>([&](int lane) { return &places[pairs[k + lane].j].x; }, two);
    const Pack dx = one[0] - two[0], dy = one[1] - two[1], dz = one[2] - two[2], radii = one[3] + two[3];
    const PackMask touches = {hn::And((dx * dx + dy * dy + dz * dz < radii * radii).m, hn::FirstN(Tag(), lanes))};
    const unsigned now = bits_of(touches);
    static_assert(sizeof(size_t) == sizeof(uint64_t), "an index has the width of a double");
    found.count += keep(Index(), hn::Iota(Index(), k), touches, reinterpret_cast<uint64_t*>(found.pairs + found.count));
    const unsigned parted = was[k / Pack::lanes] & ~now;
    for (unsigned left = parted; left; left &= left - 1)
      found.parted[found.partedCount++] = k + static_cast<size_t>(__builtin_ctz(left));
    was[k / Pack::lanes] = static_cast<unsigned char>(now);
  }
  if (found.count > 0) std::fill_n(found.pairs + found.count, Pack::lanes, found.pairs[found.count - 1]);
}

}  // namespace
}  // namespace vielto

#endif

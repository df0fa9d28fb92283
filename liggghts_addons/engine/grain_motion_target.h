// SPDX-License-Identifier: GPL-2.0-or-later
// GrainMotion of packed_law.h for the registers that packed_number.h is compiled for; see there.
#ifndef VIELTO_GRAIN_MOTION_TARGET_H
#define VIELTO_GRAIN_MOTION_TARGET_H

#include "engine/packed_law.h"
#include "engine/packed_number.h"

namespace vielto {
namespace {

VIELTO_INLINE Pack load_loose(const double* numbers) { return hn::LoadU(Tag(), numbers); }
VIELTO_INLINE void store_loose(const Pack& a, double* numbers) { hn::StoreU(a.v, Tag(), numbers); }

// One number of each grain, three times each, as the vectors of the grains lie in memory: in three registers.
class Thrice {
 public:
  Thrice() {
    alignas(64) int64_t lanes[3][Pack::lanes];
    for (int k = 0; k < 3 * Pack::lanes; k++) lanes[k / Pack::lanes][k % Pack::lanes] = k / 3;
    for (int c = 0; c < 3; c++)
      hn::Store(hn::Load(hn::RebindToSigned<Tag>(), lanes[c]), hn::RebindToSigned<Tag>(), lanes_[c]);
  }
  VIELTO_INLINE Pack operator()(const Pack& numbers, int c) const {
    return hn::TableLookupLanes(numbers.v, hn::SetTableIndices(Tag(), lanes_[c]));
  }

 private:
  alignas(64) int64_t lanes_[3][Pack::lanes];
};

VIELTO_INLINE bool all_in_group(const GrainMotion& m, size_t i) {
  int in = m.group;
  for (int lane = 0; lane < Pack::lanes; lane++) in &= m.mask[i + lane];
  return in != 0;
}

/* `block(i)` for as many grains as a register holds, where all belong to the group; `single(i)` for those of the rest
   that do. */
template <class OfBlock, class OfSingle>
VIELTO_INLINE void each_grain(const GrainMotion& m, OfBlock block, OfSingle single) {
  size_t i = 0;
  for (; i + Pack::lanes <= m.count; i += Pack::lanes) {
    if (all_in_group(m, i)) {
      block(i);
      continue;
    }
    for (int lane = 0; lane < Pack::lanes; lane++)
      if (m.mask[i + lane] & m.group) single(i + lane);
  }
  for (; i < m.count; i++)
    if (m.mask[i] & m.group) single(i);
}

template <bool Move>
void integrate(const GrainMotion& m) {
  const Thrice thrice;
  const auto block = [&](size_t i) {
    const Pack mass = load_loose(m.mass + i), radius = load_loose(m.radius + i);
    const Pack kick = m.half / mass, turn = m.halfOverInertia / (radius * radius * mass);
    for (int c = 0; c < 3; c++) {
      const size_t at = 3 * i + c * Pack::lanes;
      const Pack v = load_loose(m.v + at) + thrice(kick, c) * load_loose(m.f + at);
      store_loose(v, m.v + at);
      if (Move) store_loose(load_loose(m.x + at) + m.whole * v, m.x + at);
      store_loose(load_loose(m.omega + at) + thrice(turn, c) * load_loose(m.torque + at), m.omega + at);
    }
  };
  const auto single = [&](size_t i) {
    const double kick = m.half / m.mass[i], turn = m.halfOverInertia / (m.radius[i] * m.radius[i] * m.mass[i]);
    for (size_t at = 3 * i; at < 3 * i + 3; at++) {
      m.v[at] += kick * m.f[at];
      if (Move) m.x[at] += m.whole * m.v[at];
      m.omega[at] += turn * m.torque[at];
    }
  };
  each_grain(m, block, single);
}

void weigh(const GrainMotion& m) {
  const Thrice thrice;
  alignas(64) double row[3 * Pack::lanes];
  for (int k = 0; k < 3 * Pack::lanes; k++) row[k] = m.acceleration[k % 3];
  const auto block = [&](size_t i) {
    const Pack mass = load_loose(m.mass + i);
    for (int c = 0; c < 3; c++) {
      double* const f = m.f + 3 * i + c * Pack::lanes;
      store_loose(load_loose(f) + thrice(mass, c) * load(row + c * Pack::lanes), f);
    }
  };
  const auto single = [&](size_t i) {
    for (int d = 0; d < 3; d++) m.f[3 * i + d] += m.mass[i] * m.acceleration[d];
  };
  each_grain(m, block, single);
}

}  // namespace
}  // namespace vielto

#endif

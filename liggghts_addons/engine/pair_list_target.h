// SPDX-License-Identifier: GPL-2.0-or-later
// NearSearch::neighbours for the registers that packed_number.h is compiled for; see there.
#ifndef VIELTO_PAIR_LIST_TARGET_H
#define VIELTO_PAIR_LIST_TARGET_H

#include "engine/packed_number.h"
#include "engine/pair_list.h"

namespace vielto {
namespace {

size_t neighbours(const BinnedGrains& g, const GrainToPair& me, size_t from, size_t to, double* out) {
  const Tag d;
  const Pack x = me.x, y = me.y, z = me.z, radius = me.radius, number = me.number;
  size_t found = 0;
  for (size_t k = from; k < to; k += Pack::lanes) {
    const auto column = [&](const double* numbers) { return Pack(hn::LoadU(d, numbers + k)); };
    const Pack dx = x - column(g.x), dy = y - column(g.y), dz = z - column(g.z), other = column(g.number);
    const Pack square = dx * dx + dy * dy + dz * dz;
    const Pack reach = (radius + column(g.radius)) * me.factor + me.skin;
    const auto near = hn::And(hn::Le(square.v, (reach * reach).v), hn::Gt(other.v, number.v));
    const PackMask kept = {hn::And(near, hn::FirstN(d, to - k))};
    found += keep(d, other.v, kept, out + found);
  }
  return found;
}

}  // namespace
}  // namespace vielto

#endif

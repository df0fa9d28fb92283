// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/near_search.h"

#include <algorithm>

namespace vielto {
namespace {

void places(const double* x, const double* radius, size_t count, Place* out) {
  for (size_t i = 0; i < count; i++) out[i] = {x[3 * i], x[3 * i + 1], x[3 * i + 2], radius[i]};
}

Drift drift(const Place* now, const Place* then, size_t count) {
  Drift most = {0, 0};
  for (size_t i = 0; i < count; i++) {
    const double dx = now[i].x - then[i].x, dy = now[i].y - then[i].y, dz = now[i].z - then[i].z;
    most.square = std::max(most.square, dx * dx + dy * dy + dz * dz);
    most.growth = std::max(most.growth, now[i].radius - then[i].radius);
  }
  return most;
}

Drift moved(const double* x, const double* radius, size_t count, const Place* then, Place* now) {
  Drift most = {0, 0};
  for (size_t i = 0; i < count; i++) {
    const Place place = {x[3 * i], x[3 * i + 1], x[3 * i + 2], radius[i]};
    const Drift one = drift(&place, then + i, 1);
    most = {std::max(most.square, one.square), std::max(most.growth, one.growth)};
    if (now) now[i] = place;
  }
  return most;
}

// Counted without a branch, which the processor would guess wrongly.
void touching(const Place* places, const NearPair* pairs, size_t count, unsigned char* was, Touching& found) {
  found.count = found.partedCount = 0;
  for (size_t k = 0; k < count; k++) {
    const Place &one = places[pairs[k].i], &two = places[pairs[k].j];
    const double dx = one.x - two.x, dy = one.y - two.y, dz = one.z - two.z, radii = one.radius + two.radius;
    const bool touches = dx * dx + dy * dy + dz * dz < radii * radii;
    found.pairs[found.count] = k;
    found.count += touches;
    found.parted[found.partedCount] = k;
    found.partedCount += was[k] & !touches;
    was[k] = touches;
  }
  if (found.count > 0) found.pairs[found.count] = found.pairs[found.count - 1];
}

}  // namespace

const NearSearch plain_search = {1, &places, &drift, &moved, &touching};

}  // namespace vielto

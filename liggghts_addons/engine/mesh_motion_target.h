// SPDX-License-Identifier: GPL-2.0-or-later
// MeshMotion of packed_law.h for the registers that packed_number.h is compiled for; see there.
#ifndef VIELTO_MESH_MOTION_TARGET_H
#define VIELTO_MESH_MOTION_TARGET_H

#include <algorithm>

#include "engine/near_search_target.h"
#include "engine/packed_law.h"
#include "engine/packed_number.h"

namespace vielto {
namespace {

// `change(x, y, z)` for as many vectors as a register holds, read from `from` and written to `to`; the last by way of a
// row that is filled up with zeros.
template <class Change>
VIELTO_INLINE void each_vector(const double* from, double* to, size_t count, Change change) {
  const Tag d;
  const auto block = [&](const double* in, double* out) {
    hn::Vec<Tag> x, y, z;
    hn::LoadInterleaved3(d, in, x, y, z);
    Pack v[3] = {x, y, z};
    change(v);
    hn::StoreInterleaved3(v[0].v, v[1].v, v[2].v, d, out);
  };
  size_t i = 0;
  for (; i + Pack::lanes <= count; i += Pack::lanes) block(from + 3 * i, to + 3 * i);
  if (i == count) return;
  double row[3 * Pack::lanes] = {0};
  std::copy(from + 3 * i, from + 3 * count, row);
  block(row, row);
  std::copy(row, row + 3 * (count - i), to + 3 * i);
}

// The product of quaternions as LIGGGHTS writes it out.
VIELTO_INLINE void product(const Pack (&a)[4], const Pack (&b)[4], Pack (&c)[4]) {
  c[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
  c[1] = a[0] * b[1] + b[0] * a[1] + a[2] * b[3] - a[3] * b[2];
  c[2] = a[0] * b[2] + b[0] * a[2] + a[3] * b[1] - a[1] * b[3];
  c[3] = a[0] * b[3] + b[0] * a[3] + a[1] * b[2] - a[2] * b[1];
}

void turn(double* vectors, size_t count, const double* quaternion) {
  const Pack q[4] = {quaternion[0], quaternion[1], quaternion[2], quaternion[3]};
  const Pack back[4] = {q[0], -q[1], -q[2], -q[3]};
  each_vector(vectors, vectors, count, [&](Pack(&v)[3]) {
    const Pack vector[4] = {0.0, v[0], v[1], v[2]};
    Pack half[4], whole[4];
    product(q, vector, half);
    product(half, back, whole);
    std::copy(whole + 1, whole + 4, v);
  });
}

void swing(const double* points, size_t count, const double* spin, double* velocities) {
  const Pack w[3] = {spin[0], spin[1], spin[2]};
  each_vector(points, velocities, count, [&](Pack(&v)[3]) {
    const Pack x = v[0], y = v[1], z = v[2];
    // LIGGGHTS adds to a velocity of 0
    v[0] = 0.0 + (w[1] * z - w[2] * y);
    v[1] = 0.0 + (w[2] * x - w[0] * z);
    v[2] = 0.0 + (w[0] * y - w[1] * x);
  });
}

double farthest(const double* now, const double* then, size_t count) {
  const Tag d;
  Pack square = 0.0;
  size_t i = 0;
  for (; i + Pack::lanes <= count; i += Pack::lanes) {
    hn::Vec<Tag> x, y, z, x0, y0, z0;
    hn::LoadInterleaved3(d, now + 3 * i, x, y, z);
    hn::LoadInterleaved3(d, then + 3 * i, x0, y0, z0);
    const Pack dx = hn::Sub(x, x0), dy = hn::Sub(y, y0), dz = hn::Sub(z, z0);
    square = hn::Max(square.v, (dx * dx + dy * dy + dz * dz).v);
  }
  double most = greatest(square);
  for (; i < count; i++) {
    const double dx = now[3 * i] - then[3 * i], dy = now[3 * i + 1] - then[3 * i + 1],
                 dz = now[3 * i + 2] - then[3 * i + 2];
    most = std::max(most, dx * dx + dy * dy + dz * dz);
  }
  return most;
}

}  // namespace
}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// The body of packed_law.h; compiled once for each instruction set, which VIELTO_PACKED_SET names.
#include <algorithm>

#include "engine/grain_motion_target.h"
#include "engine/mesh_motion_target.h"
#include "engine/near_search_target.h"
#include "engine/packed_law.h"
#include "engine/packed_number.h"
#include "engine/pair_list_target.h"

namespace vielto {
namespace {

static_assert(Block::size % Pack::lanes == 0, "rows are read whole");

VIELTO_INLINE VecOf<Pack> load(const Block::Row (&rows)[3], int k) {
  return {load(rows[0] + k), load(rows[1] + k), load(rows[2] + k)};
}

VIELTO_INLINE void store(const VecOf<Pack>& a, Block::Row (&rows)[3], int k) {
  store(a.x, rows[0] + k);
  store(a.y, rows[1] + k);
  store(a.z, rows[2] + k);
}

// One constant of each contact's pair; alike: all have the first one's.
VIELTO_INLINE Pack each(const Pair* pairs, const int* index, bool alike, double Pair::*constant) {
  if (alike) return pairs[index[0]].*constant;
  alignas(64) double row[Pack::lanes];
  for (int k = 0; k < Pack::lanes; k++) row[k] = pairs[index[k]].*constant;
  return load(row);
}

PairOf<Pack> constants(const Pair* pairs, const int* index, bool alike) {
  PairOf<Pack> p;
  p.E1 = each(pairs, index, alike, &Pair::E1);
  p.E2 = each(pairs, index, alike, &Pair::E2);
  p.nu1 = each(pairs, index, alike, &Pair::nu1);
  p.nu2 = each(pairs, index, alike, &Pair::nu2);
  p.equalRatio = p.nu1 == p.nu2;
  p.sqrtRatio = each(pairs, index, alike, &Pair::sqrtRatio);
  p.betaN = each(pairs, index, alike, &Pair::betaN);
  p.betaS = each(pairs, index, alike, &Pair::betaS);
  p.tanPhi = each(pairs, index, alike, &Pair::tanPhi);
  p.betaKr = each(pairs, index, alike, &Pair::betaKr);
  p.betaKtw = each(pairs, index, alike, &Pair::betaKtw);
  p.muR = each(pairs, index, alike, &Pair::muR);
  p.muTwTanPhi = each(pairs, index, alike, &Pair::muTwTanPhi);
  return p;
}

VIELTO_INLINE Pack effective_mass(const PackedStep& step, const Block& b, int k, const Pack& m1, const Pack& m2) {
  const Pack m = m1 * m2 / (m1 + m2);
  if (!step.frozen) return m;
  alignas(64) double row[Pack::lanes];
  store(m, row);
  for (int lane = 0; lane < Pack::lanes; lane++) {
    if (b.held1[k + lane]) row[lane] = b.m2[k + lane];
    if (b.held2[k + lane]) row[lane] = b.m1[k + lane];
  }
  return load(row);
}

// Viscous moments of rolling_model_vielto.h; they act while the spring is not capped.
VIELTO_INLINE VecOf<Pack> rolling_dashpot(const PairOf<Pack>& p, const Pack& inertia, const Pack& kr, const Pack& ktw,
                                          const VecOf<Pack>& wr, const Pack& wtw, const VecOf<Pack>& n) {
  const Pack cr = 2 * p.betaS * sqrt(kr * inertia);
  const Pack ctw = 2 * p.betaS * sqrt(ktw * inertia);
  return -cr * wr - (ctw * wtw) * n;
}

// Contacts k, k + 1, ...: what surface_model_default.h, normal_, cohesion_, tangential_ and rolling_model_* do.
template <bool Wall>
VIELTO_INLINE bool evaluate(const PackedStep& step, const PairOf<Pack>& p, Block& b, int k) {
  const LawSettings& s = step.settings;
  const double dt = step.dt;
  const VecOf<Pack> delta = load(b.delta, k), v = load(b.v, k), w1 = load(b.spin1, k), w2 = load(b.spin2, k);
  const Pack R1 = load(b.R1 + k), R2 = Wall ? s.wallRadiusFactor * R1 : load(b.R2 + k);
  const Pack m1 = load(b.m1 + k), m2 = Wall ? m1 : load(b.m2 + k);
  const Pack told = Wall ? load(b.gap + k) : Pack(0.0);

  const Pack r = Wall ? R1 - told : sqrt(load(b.square + k));
  const Pack inverse = 1.0 / r;
  const VecOf<Pack> n = inverse * delta;
  const Pack overlap = (Wall ? R1 : R1 + R2) - r;
  const Pack vn = dot(v, n);
  // LIGGGHTS' velocity at the contact; its lever arms are shorter than the radii by half the overlap
  const Pack arm1 = R1 - 0.5 * (Wall ? told : overlap), arm2 = R2 - 0.5 * overlap;
  const VecOf<Pack> turning = inverse * (Wall ? arm1 * w1 : arm1 * w1 + arm2 * w2);
  VecOf<Pack> vs = (v - vn * n) - cross(turning, delta);
  if (s.radiusLever) vs = vs + (0.5 * overlap) * cross(n, Wall ? w1 : w1 + w2);

  const StiffnessOf<Pack> c = stiffness(p, R1, R2, Wall ? m1 : effective_mass(step, b, k, m1, m2));
  Pack Fn = normal_force(s.springFactor, c, overlap, vn);
  if (s.limitForce) Fn = choose(Fn < 0.0, 0.0, Fn);
  const PackMask pressed = Fn > 0.0;
  VecOf<Pack> F = Fn * n;
  if (s.adhesion > 0) F = F - (s.adhesion * (2 * R1) * (2 * (Wall ? R1 : R2))) * n;

  const Pack spinAngle = 0.5 * dt * dot(w1 + w2, n);
  PackMask slides;
  const VecOf<Pack> spring = tangential_spring(c, turned_with_contact(load(b.sliding, k), n, spinAngle), vs, dt,
                                               choose(pressed, p.tanPhi * Fn, 0.0), slides);
  store(spring, b.sliding, k);
  VecOf<Pack> Fs = spring - c.gammaS * vs;
  if (!s.slidingDashpot) Fs = choose(slides, spring, Fs);
  F = F + Fs;
  const VecOf<Pack> arm = cross(n, Fs);
  VecOf<Pack> T1 = -(s.radiusLever ? R1 : arm1) * arm, T2 = -(s.radiusLever ? R2 : arm2) * arm;
  if (Wall) T2 = {0.0, 0.0, 0.0};

  if (s.rolling) {
    const VecOf<Pack> w = w1 - w2;
    const Pack wtw = dot(w, n);
    const VecOf<Pack> wr = w - wtw * n;
    const Pack kr = rolling_stiffness(p, c.kn, R1, R2), ktw = twisting_stiffness(p, c.ks, R1, R2);
    const Pack length = choose(pressed, Fn * rolling_length(R1, R2), 0.0);
    PackMask rolls, twists;
    const VecOf<Pack> Mr = rolling_spring(kr, turned_with_contact(load(b.rolling, k), n, spinAngle), wr, dt,
                                          (Wall ? p.muR + s.wallRolling : p.muR) * length, rolls);
    const Pack Mtw = twisting_spring(ktw, load(b.twisting + k), wtw, dt, p.muTwTanPhi * length, twists);
    store(Mr, b.rolling, k);
    store(Mtw, b.twisting + k);
    VecOf<Pack> M = Mr + Mtw * n;
    if (s.rollingDashpot) {
      const Pack I1 = 0.4 * m1 * R1 * R1, I2 = 0.4 * m2 * R2 * R2;
      const VecOf<Pack> none = {0.0, 0.0, 0.0};
      M = M + rolling_dashpot(p, Wall ? I1 : I1 * I2 / (I1 + I2), kr, ktw, choose(rolls, none, wr),
                              choose(twists, 0.0, wtw), n);
    }
    T1 = T1 + M;
    T2 = T2 - M;
  }
  store(F, b.force, k);
  store(T1, b.torque1, k);
  store(T2, b.torque2, k);
  store(overlap, b.overlap + k);
  store(Fn, b.normal + k);
  return any(overlap > step.greatestOverlap * (2 * (Wall ? R1 : choose(R1 < R2, R1, R2))));
}

// A count of contacts, filled up to whole registers.
VIELTO_INLINE int whole_of(int count) { return (count + Pack::lanes - 1) / Pack::lanes * Pack::lanes; }

template <bool Wall>
bool evaluate(const PackedStep& step, Block& b, int count) {
  const int whole = whole_of(count);
  // what the lanes past the last hold is of no account, but they need a pair
  for (int k = count; k < whole; k++) b.pair[k] = b.pair[count - 1];
  bool greater = false;
  PairOf<Pack> p = constants(step.pairs, b.pair, b.alike);
  for (int k = 0; k < whole; k += Pack::lanes) {
    if (!b.alike && k > 0) p = constants(step.pairs, b.pair + k, false);
    greater |= evaluate<Wall>(step, p, b, k);
  }
  return greater;
}

VIELTO_INLINE void store(const Pack (&columns)[3], Block::Row (&rows)[3], int k) {
  for (int d = 0; d < 3; d++) store(columns[d], rows[d] + k);
}

// Lanes past the last contact hold the next, or the last again.
void fill(const PackedStep& step, const PackedGrains& g, const NearPair* pairs, const size_t* touching, int count,
          Block& b) {
  const LawSettings& s = step.settings;
  for (int k = 0; k < whole_of(count); k += Pack::lanes) {
    const NearPair* pair[Pack::lanes];
    for (int lane = 0; lane < Pack::lanes; lane++) pair[lane] = &pairs[touching[k + lane]];
    const auto at_i = [&](const double* numbers) {
      return [&pair, numbers](int lane) { return numbers + 3 * static_cast<std::ptrdiff_t>(pair[lane]->i); };
    };
    const auto at_j = [&](const double* numbers) {
      return [&pair, numbers](int lane) { return numbers + 3 * static_cast<std::ptrdiff_t>(pair[lane]->j); };
    };
    Pack one[4], two[4], v1[3], v2[3], w[3];
    columns<4>([&](int lane) { return &g.places[pair[lane]->i].x; }, one);
    columns<4>([&](int lane) { return &g.places[pair[lane]->j].x; }, two);
    const VecOf<Pack> delta = {one[0] - two[0], one[1] - two[1], one[2] - two[2]};
    store(delta, b.delta, k);
    store(delta.x * delta.x + delta.y * delta.y + delta.z * delta.z, b.square + k);
    store(one[3], b.R1 + k);
    store(two[3], b.R2 + k);
    columns<3>(at_i(g.v), v1);
    columns<3>(at_j(g.v), v2);
    store(VecOf<Pack>{v1[0] - v2[0], v1[1] - v2[1], v1[2] - v2[2]}, b.v, k);
    columns<3>(at_i(g.omega), w);
    store(w, b.spin1, k);
    columns<3>(at_j(g.omega), w);
    store(w, b.spin2, k);
    columns<3>([&](int lane) { return pair[lane]->history + s.slidingAt; }, w);
    store(w, b.sliding, k);
    if (s.rolling) {
      Pack moments[4];
      columns<4>([&](int lane) { return pair[lane]->history + s.rollingAt; }, moments);
      for (int d = 0; d < 3; d++) store(moments[d], b.rolling[d] + k);
      store(moments[3], b.twisting + k);
    }
    for (int lane = 0; lane < Pack::lanes; lane++) {
      const int i = pair[lane]->i, j = pair[lane]->j;
      b.m1[k + lane] = g.body && g.body[i] > 0.0 ? g.body[i] : g.mass[i];
      b.m2[k + lane] = g.body && g.body[j] > 0.0 ? g.body[j] : g.mass[j];
      b.pair[k + lane] = g.types * g.type[i] + g.type[j];
      if (!step.frozen) continue;
      b.held1[k + lane] = (g.mask[i] & g.frozen) != 0;
      b.held2[k + lane] = (g.mask[j] & g.frozen) != 0;
    }
  }
  b.alike = std::all_of(b.pair, b.pair + count, [&](int pair) { return pair == b.pair[0]; });
}

bool press(const PackedStep& step, const PackedGrains& grains, const NearPair* pairs, const size_t* touching, int count,
           Block& b) {
  fill(step, grains, pairs, touching, count, b);
  return evaluate<false>(step, b, count);
}

typedef hn::FixedTag<double, 2> Two;

VIELTO_INLINE void copy_three(const double* from, double* to) {
  hn::StoreU(hn::LoadU(Two(), from), Two(), to);
  to[2] = from[2];
}
VIELTO_INLINE void add_three(const double* what, double* to) {
  hn::StoreU(hn::Add(hn::LoadU(Two(), to), hn::LoadU(Two(), what)), Two(), to);
  to[2] += what[2];
}
VIELTO_INLINE void subtract_three(const double* what, double* to) {
  hn::StoreU(hn::Sub(hn::LoadU(Two(), to), hn::LoadU(Two(), what)), Two(), to);
  to[2] -= what[2];
}

void add(const PackedStep& step, const PackedGrains& g, const NearPair* pairs, const size_t* touching, int count,
         const Block& b) {
  const LawSettings& s = step.settings;
  Rows force, torque1, torque2, sliding, moments;
  for (int k = 0; k < count; k += Pack::lanes) {
    const auto rows_of = [k](const Block::Row(&rows)[3], const Pack& last, Rows& out) {
      store_rows(load(rows[0] + k), load(rows[1] + k), load(rows[2] + k), last, out);
    };
    rows_of(b.force, 0.0, force);
    rows_of(b.torque1, 0.0, torque1);
    rows_of(b.torque2, 0.0, torque2);
    rows_of(b.sliding, 0.0, sliding);
    if (s.rolling) rows_of(b.rolling, load(b.twisting + k), moments);
    const int lanes = std::min(Pack::lanes, count - k);
    for (int lane = 0; lane < lanes; lane++) {
      const NearPair& pair = pairs[touching[k + lane]];
      *pair.flags |= g.flags;
      copy_three(sliding.row(lane), pair.history + s.slidingAt);
      if (s.rolling) hn::StoreU(load_row<4>(moments.row(lane)), RowTag(), pair.history + s.rollingAt);
      add_three(force.row(lane), g.f + 3 * static_cast<std::ptrdiff_t>(pair.i));
      add_three(torque1.row(lane), g.torque + 3 * static_cast<std::ptrdiff_t>(pair.i));
      if (pair.j >= g.owned) continue;
      subtract_three(force.row(lane), g.f + 3 * static_cast<std::ptrdiff_t>(pair.j));
      add_three(torque2.row(lane), g.torque + 3 * static_cast<std::ptrdiff_t>(pair.j));
    }
  }
}

}  // namespace

extern const PackedLaw VIELTO_PACKED_SET;
const PackedLaw VIELTO_PACKED_SET = {&press,
                                     &add,
                                     &evaluate<true>,
                                     {Pack::lanes, &near_places, &near_drift, &near_moved, &near_touching},
                                     &neighbours,
                                     &integrate<true>,
                                     &integrate<false>,
                                     &weigh,
                                     {&turn, &swing, &farthest}};

}  // namespace vielto

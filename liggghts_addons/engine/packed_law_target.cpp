// SPDX-License-Identifier: GPL-2.0-or-later
// The body of packed_law.h; compiled once for each instruction set, which VIELTO_PACKED_SET names.
#include "engine/packed_law.h"
#include "engine/packed_number.h"

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

// One constant of each contact's pair.
VIELTO_INLINE Pack each(const Pair* pairs, const int* index, double Pair::*constant) {
  alignas(64) double row[Pack::lanes];
  for (int k = 0; k < Pack::lanes; k++) row[k] = pairs[index[k]].*constant;
  return load(row);
}

PairOf<Pack> constants(const Pair* pairs, const int* index) {
  PairOf<Pack> p;
  p.E1 = each(pairs, index, &Pair::E1);
  p.E2 = each(pairs, index, &Pair::E2);
  p.nu1 = each(pairs, index, &Pair::nu1);
  p.nu2 = each(pairs, index, &Pair::nu2);
  p.equalRatio = p.nu1 == p.nu2;
  p.sqrtRatio = each(pairs, index, &Pair::sqrtRatio);
  p.betaN = each(pairs, index, &Pair::betaN);
  p.betaS = each(pairs, index, &Pair::betaS);
  p.tanPhi = each(pairs, index, &Pair::tanPhi);
  p.betaKr = each(pairs, index, &Pair::betaKr);
  p.betaKtw = each(pairs, index, &Pair::betaKtw);
  p.muR = each(pairs, index, &Pair::muR);
  p.muTwTanPhi = each(pairs, index, &Pair::muTwTanPhi);
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

template <bool Wall>
bool evaluate(const PackedStep& step, Block& b, int count) {
  const int whole = (count + Pack::lanes - 1) / Pack::lanes * Pack::lanes;
  // what the lanes past the last hold is of no account, but they need a pair
  for (int k = count; k < whole; k++) b.pair[k] = b.pair[count - 1];
  bool greater = false;
  PairOf<Pack> p = constants(step.pairs, b.pair);
  for (int k = 0; k < whole; k += Pack::lanes) {
    if (!b.alike && k > 0) p = constants(step.pairs, b.pair + k);
    greater |= evaluate<Wall>(step, p, b, k);
  }
  return greater;
}

}  // namespace

extern const PackedLaw VIELTO_PACKED_SET;
const PackedLaw VIELTO_PACKED_SET = {Pack::lanes, &evaluate<false>, &evaluate<true>};

}  // namespace vielto

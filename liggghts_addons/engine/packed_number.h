// SPDX-License-Identifier: GPL-2.0-or-later
/* A number of several contacts side by side, for the formulas of vielto_law.h: as many doubles as a vector register of
   the instruction set holds that this file is compiled for (Highway). Each operation is the one that IEEE 754 names,
   and none are fused (-ffp-contract=off), so that every lane gives the numbers of the formula in double to the last
   bit.

   Only for files that are compiled once for each instruction set: everything here lies in an unnamed namespace, so that
   the linker never takes the code of one set for another's. */
#ifndef VIELTO_PACKED_NUMBER_H
#define VIELTO_PACKED_NUMBER_H

#include <hwy/highway.h>

#include "vielto_law.h"

namespace vielto {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
typedef hn::ScalableTag<double> Tag;

struct PackMask {
  hn::Mask<Tag> m;
};

struct Pack {
  static constexpr int lanes = static_cast<int>(HWY_LANES(double));
  hn::Vec<Tag> v;

  Pack() = default;
  VIELTO_INLINE Pack(hn::Vec<Tag> vector) : v(vector) {}
  VIELTO_INLINE Pack(double number) : v(hn::Set(Tag(), number)) {}
};

VIELTO_INLINE Pack load(const double* row) { return hn::Load(Tag(), row); }
VIELTO_INLINE void store(const Pack& a, double* row) { hn::Store(a.v, Tag(), row); }

VIELTO_INLINE Pack operator+(const Pack& a, const Pack& b) { return hn::Add(a.v, b.v); }
VIELTO_INLINE Pack operator-(const Pack& a, const Pack& b) { return hn::Sub(a.v, b.v); }
VIELTO_INLINE Pack operator*(const Pack& a, const Pack& b) { return hn::Mul(a.v, b.v); }
VIELTO_INLINE Pack operator/(const Pack& a, const Pack& b) { return hn::Div(a.v, b.v); }
VIELTO_INLINE Pack operator-(const Pack& a) { return hn::Neg(a.v); }
VIELTO_INLINE PackMask operator<(const Pack& a, const Pack& b) { return {hn::Lt(a.v, b.v)}; }
VIELTO_INLINE PackMask operator>(const Pack& a, const Pack& b) { return {hn::Gt(a.v, b.v)}; }
VIELTO_INLINE PackMask operator>=(const Pack& a, const Pack& b) { return {hn::Ge(a.v, b.v)}; }
VIELTO_INLINE PackMask operator==(const Pack& a, const Pack& b) { return {hn::Eq(a.v, b.v)}; }

VIELTO_INLINE Pack sqrt(const Pack& a) { return hn::Sqrt(a.v); }
VIELTO_INLINE Pack fabs(const Pack& a) { return hn::Abs(a.v); }
VIELTO_INLINE Pack copysign(const Pack& a, const Pack& sign) { return hn::CopySign(a.v, sign.v); }
VIELTO_INLINE bool any(const PackMask& c) { return !hn::AllFalse(Tag(), c.m); }
VIELTO_INLINE bool all(const PackMask& c) { return hn::AllTrue(Tag(), c.m); }
VIELTO_INLINE Pack choose(const PackMask& c, const Pack& a, const Pack& b) { return hn::IfThenElse(c.m, a.v, b.v); }

VIELTO_INLINE unsigned bits_of(const PackMask& c) {
  unsigned char bytes[8];  // Highway may write all
  hn::StoreMaskBits(Tag(), c.m, bytes);
  return bytes[0];
}

/* Writes the numbers of the lanes that are set one after the other and tells how many; up to a register is written.
   D: doubles, or another number of their width. */
template <class D>
VIELTO_INLINE size_t keep(D d, const hn::Vec<D>& numbers, const PackMask& c, hn::TFromD<D>* out) {
  // not hn::Compress, whose table the compiler copies to the stack at every call, nor what rests on it in 4 lanes
  if constexpr (Pack::lanes == 8) return hn::CompressStore(numbers, hn::RebindMask(d, c.m), d, out);
  alignas(64) hn::TFromD<D> row[Pack::lanes];
  hn::Store(numbers, d, row);
  const unsigned bits = bits_of(c);
  size_t count = 0;
  for (int lane = 0; lane < Pack::lanes; lane++) {
    out[count] = row[lane];
    count += bits >> lane & 1;
  }
  return count;
}

/* Rows of N numbers, 3 or 4, in memory, one for each lane, and the same numbers by component, all lanes side by side:
   a transposition within each half of 4 lanes; on narrower registers number by number. */
constexpr bool transposes = Pack::lanes == 4 || Pack::lanes == 8;
typedef hn::CappedTag<double, 4> RowTag;

template <int N>
VIELTO_INLINE hn::Vec<RowTag> load_row(const double* at) {
  if constexpr (N == 4) return hn::LoadU(RowTag(), at);
  return hn::MaskedLoad(hn::FirstN(RowTag(), N), RowTag(), at);
}

// `at(lane)` tells where the row of a lane stands.
template <int N, class At>
VIELTO_INLINE void columns(At at, Pack (&out)[N]) {
  static_assert(N == 3 || N == 4, "a vector, or a vector and a number");
  if constexpr (transposes) {
    const Tag d;
    hn::Vec<Tag> row[4];
    for (int k = 0; k < 4; k++)
      if constexpr (Pack::lanes == 8)
        row[k] = hn::Combine(d, load_row<N>(at(k + 4)), load_row<N>(at(k)));
      else
        row[k] = load_row<N>(at(k));
    const auto even01 = hn::InterleaveLower(d, row[0], row[1]), odd01 = hn::InterleaveUpper(d, row[0], row[1]);
    const auto even23 = hn::InterleaveLower(d, row[2], row[3]), odd23 = hn::InterleaveUpper(d, row[2], row[3]);
    out[0] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(even23), even01);
    out[1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(odd23), odd01);
    out[2] = hn::OddEvenBlocks(even23, hn::SwapAdjacentBlocks(even01));
    if constexpr (N == 4) out[3] = hn::OddEvenBlocks(odd23, hn::SwapAdjacentBlocks(odd01));
  } else {
    alignas(64) double column[N][Pack::lanes];
    for (int lane = 0; lane < Pack::lanes; lane++)
      for (int c = 0; c < N; c++) column[c][lane] = at(lane)[c];
    for (int c = 0; c < N; c++) out[c] = load(column[c]);
  }
}

// Rows of 4 in memory; row(lane) tells where.
struct alignas(64) Rows {
  double numbers[4 * Pack::lanes];
  static constexpr int place(int lane) { return transposes ? (lane % 4) * Pack::lanes + lane / 4 * 4 : 4 * lane; }
  const double* row(int lane) const { return numbers + place(lane); }
};

VIELTO_INLINE void store_rows(const Pack& x, const Pack& y, const Pack& z, const Pack& w, Rows& rows) {
  if constexpr (transposes) {
    const Tag d;
    const auto even01 = hn::InterleaveLower(d, x.v, y.v), odd01 = hn::InterleaveUpper(d, x.v, y.v);
    const auto even23 = hn::InterleaveLower(d, z.v, w.v), odd23 = hn::InterleaveUpper(d, z.v, w.v);
    store(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(even23), even01), rows.numbers);
    store(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(odd23), odd01), rows.numbers + Pack::lanes);
    store(hn::OddEvenBlocks(even23, hn::SwapAdjacentBlocks(even01)), rows.numbers + 2 * Pack::lanes);
    store(hn::OddEvenBlocks(odd23, hn::SwapAdjacentBlocks(odd01)), rows.numbers + 3 * Pack::lanes);
  } else {
    alignas(64) double column[4][Pack::lanes];
    store(x, column[0]), store(y, column[1]), store(z, column[2]), store(w, column[3]);
    for (int lane = 0; lane < Pack::lanes; lane++)
      for (int c = 0; c < 4; c++) rows.numbers[4 * lane + c] = column[c][lane];
  }
}

}  // namespace
}  // namespace vielto

#endif

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

}  // namespace
}  // namespace vielto

#endif

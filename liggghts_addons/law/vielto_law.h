// SPDX-License-Identifier: GPL-2.0-or-later
/* ViElTo: linear viscoelastic contact law with sliding, rolling and twisting resistance.

   Purpose   Forces and moments of one contact as stateless functions on numbers; needs the standard
             library only. The LIGGGHTS adapters beside this file call nothing else.
   Source    D. Horvath, PhD thesis booklet, BME Budapest 2024, Thesis 2 (equations of motion and of
             momentum). Corrected in the print: beta_ktw is defined there under the name beta_kr.

   Bodies 1 and 2, radii R, masses m. A wall is body 2 with R_2 = wallRadiusFactor * R_1 and m_eff = m_1
   (the thesis does not state R_2; Yade, in which it was computed, takes 2 R_1).

     body stiffness      k_i  = 2 E_i R_i                                              N/m
     normal stiffness    k_n  = 2 k_1 k_2 / (k_1 + k_2)                                N/m
     tangential          k_s  = 2 (k_1 nu_1)(k_2 nu_2) / (k_1 nu_1 + k_2 nu_2)         N/m
     normal force        F_n  = c_n k_n u_n - 2 sqrt(k_n m_eff) beta_n v_n             N
     tangential force    F_s += -k_s v_s dt, |F_s| <= max(F_n, 0) tan(phi'); the dashpot
                         -2 sqrt(k_s m_eff) beta_s v_s is added outside the cap        N
     rolling moment      M_r += -k_r w_r dt,  k_r = beta_kr k_n R_1 R_2,
                         |M_r| <= mu_r max(F_n, 0) 2 R_1 R_2/(R_1 + R_2)               N m
     twisting moment     M_tw += -k_tw w_tw dt, k_tw = beta_ktw k_s R_1 R_2,
                         |M_tw| <= mu_tw tan(phi') max(F_n, 0) 2 R_1 R_2/(R_1 + R_2)   N m
     mixing              beta_n, beta_s, phi' mean; mu_r, mu_tw minimum;
                         beta_kr, beta_ktw harmonic mean where both are > 0, else 0

   Convention  n is the unit vector from body 2 to body 1 (LIGGGHTS; the thesis prints 1 to 2). Every
               force and moment returned acts on body 1; body 2 gets the opposite force, the opposite
               rolling and twisting moments, and its own lever arm times the tangential force.
               v = v_1 - v_2, v_n = v.n (> 0 when the bodies part), v_s includes the spins.
               u_n > 0 is overlap. F_n in the caps is spring plus dashpot, never cohesion.
   Units       SI, angles in radians.
   Numbers     T is double, or a type that holds the same number of several contacts side by side (this package's
               engine/packed_number.h): the formulas are stated once. Mask<T> is what a comparison of two T gives.
   Limits      small overlap (u_n << R); angular momentum is conserved to u_n/(R_1 + R_2) because the
               lever arms are the radii, as printed.
*/
#ifndef VIELTO_LAW_H
#define VIELTO_LAW_H

#include <algorithm>
#include <cmath>
#include <utility>

// These small functions stand in the innermost loop: a call costs more than the work of most of them. What runs
// seldom stays out of that loop. With sanitizers in them the inlined ones would take a compiler minutes.
#if defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__)
#define VIELTO_INLINE inline __attribute__((always_inline))
#define VIELTO_NOINLINE __attribute__((noinline))
#else
#define VIELTO_INLINE inline
#define VIELTO_NOINLINE
#endif

namespace vielto {

// What the formulas ask of a number beside its arithmetic; sqrt, fabs and copysign are found beside the type.
using std::copysign;
using std::fabs;
using std::sqrt;

template <class T>
using Mask = decltype(std::declval<T>() < std::declval<T>());

VIELTO_INLINE bool any(bool condition) { return condition; }
VIELTO_INLINE bool all(bool condition) { return condition; }
VIELTO_INLINE double choose(bool condition, double a, double b) { return condition ? a : b; }

template <class T>
struct VecOf {
  typedef T Number;
  T x, y, z;
};
typedef VecOf<double> Vec;

// T, deduced from the other arguments.
template <class T>
using Num = typename VecOf<T>::Number;

template <class T>
VIELTO_INLINE VecOf<T> operator+(const VecOf<T>& a, const VecOf<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
VIELTO_INLINE VecOf<T> operator-(const VecOf<T>& a, const VecOf<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
VIELTO_INLINE VecOf<T> operator*(const Num<T>& s, const VecOf<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
VIELTO_INLINE T dot(const VecOf<T>& a, const VecOf<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
VIELTO_INLINE VecOf<T> cross(const VecOf<T>& a, const VecOf<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
VIELTO_INLINE VecOf<T> choose(const Mask<T>& condition, const VecOf<T>& a, const VecOf<T>& b) {
  return {choose(condition, a.x, b.x), choose(condition, a.y, b.y), choose(condition, a.z, b.z)};
}

// What one body brings into a contact.
struct Material {
  double youngsModulus;            // E, Pa
  double stiffnessRatio;           // nu = k_s/k_n, 1; not an elastic constant
  double frictionAngle;            // phi', rad
  double normalDamping;            // beta_n, 1
  double tangentialDamping;        // beta_s, 1
  double rollingStiffnessFactor;   // beta_kr, 1
  double twistingStiffnessFactor;  // beta_ktw, 1
  double rollingResistance;        // mu_r, 1
  double twistingResistance;       // mu_tw, 1
};

// Two materials after the mixing rules; made once per pair of types.
template <class T>
struct PairOf {
  T E1, E2;
  T nu1, nu2;
  Mask<T> equalRatio;  // nu1 == nu2, so that k_s = nu k_n saves a division and a root
  T sqrtRatio;         // sqrt(nu), where equalRatio
  T betaN, betaS;
  T tanPhi;
  T betaKr, betaKtw;
  T muR, muTwTanPhi;
};
typedef PairOf<double> Pair;

inline double harmonic_mean_or_zero(double a, double b) { return (a > 0 && b > 0) ? 2 * a * b / (a + b) : 0.0; }

inline Pair mix(const Material& a, const Material& b) {
  Pair p;
  p.E1 = a.youngsModulus;
  p.E2 = b.youngsModulus;
  p.nu1 = a.stiffnessRatio;
  p.nu2 = b.stiffnessRatio;
  p.equalRatio = a.stiffnessRatio == b.stiffnessRatio;
  p.sqrtRatio = std::sqrt(a.stiffnessRatio);
  p.betaN = 0.5 * (a.normalDamping + b.normalDamping);
  p.betaS = 0.5 * (a.tangentialDamping + b.tangentialDamping);
  p.tanPhi = std::tan(0.5 * (a.frictionAngle + b.frictionAngle));
  p.betaKr = harmonic_mean_or_zero(a.rollingStiffnessFactor, b.rollingStiffnessFactor);
  p.betaKtw = harmonic_mean_or_zero(a.twistingStiffnessFactor, b.twistingStiffnessFactor);
  p.muR = std::min(a.rollingResistance, b.rollingResistance);
  p.muTwTanPhi = std::min(a.twistingResistance, b.twistingResistance) * p.tanPhi;
  return p;
}

// Stiffnesses and dashpot coefficients of one contact: k in N/m, gamma in N s/m.
template <class T>
struct StiffnessOf {
  T kn, ks;
  T gammaN, gammaS;
};
typedef StiffnessOf<double> Stiffness;

template <class T>
VIELTO_INLINE StiffnessOf<T> stiffness(const PairOf<T>& p, const Num<T>& R1, const Num<T>& R2, const Num<T>& mEff) {
  const T a1 = p.E1 * R1;
  const T a2 = p.E2 * R2;
  StiffnessOf<T> s;
  s.kn = 4 * a1 * a2 / (a1 + a2);
  const T rootN = sqrt(s.kn * mEff);
  s.gammaN = 2 * p.betaN * rootN;
  s.ks = p.nu1 * s.kn;
  s.gammaS = 2 * p.betaS * p.sqrtRatio * rootN;
  if (!all(p.equalRatio)) {
    const T b1 = a1 * p.nu1;
    const T b2 = a2 * p.nu2;
    s.ks = choose(p.equalRatio, s.ks, 4 * b1 * b2 / (b1 + b2));
    s.gammaS = choose(p.equalRatio, s.gammaS, 2 * p.betaS * sqrt(s.ks * mEff));
  }
  return s;
}

// F_n, N; c_n is the factor before k_n u_n (4 as printed, 1 makes beta_n the damping ratio).
template <class T>
VIELTO_INLINE T normal_force(double cn, const StiffnessOf<T>& s, const Num<T>& overlap, const Num<T>& vn) {
  return cn * s.kn * overlap - s.gammaN * vn;
}

/* Carries a stored vector, perpendicular to the normal of the last step, over to the normal n of this one:
   laid into the new tangent plane at unchanged length, and turned about n by the bodies' mean spin angle.
   To second order in the turn of a step this is the rotation of the contact frame. */
template <class T = double>
VIELTO_INLINE VecOf<T> turned_with_contact(const VecOf<T>& stored, const VecOf<T>& n, const Num<T>& spinAngle) {
  const T along = dot(stored, n);
  VecOf<T> t = stored - along * n;
  const T before = dot(stored, stored);
  const Mask<T> loaded = before > 0;
  if (any(loaded)) {
    const T shortening = along * along / before;  // 1 - |t|^2/|stored|^2
    T factor = 1 + 0.5 * shortening;
    const Mask<T> far = shortening >= 1e-4;
    if (any(far)) {
      const T left = 1 - shortening;
      factor = choose(far, 1 / sqrt(choose(left > 1e-12, left, T(1e-12))), factor);
    }
    t = choose(loaded, factor * t, t);
  }
  return t + spinAngle * cross(n, t);
}

// Shortens v to at most `limit`. Tells where it had to.
template <class T>
VIELTO_INLINE Mask<T> cap(VecOf<T>& v, const Num<T>& limit) {
  const T square = dot(v, v);
  const Mask<T> over = square > limit * limit;
  if (any(over)) v = choose(over, (limit / sqrt(square)) * v, v);
  return over;
}

// Spring part of the tangential force after this step; `stored` already turned. `sliding` tells the cap acted.
template <class T>
VIELTO_INLINE VecOf<T> tangential_spring(const StiffnessOf<T>& s, const VecOf<T>& stored, const VecOf<T>& vs, double dt,
                                         const Num<T>& slidingLimit, Mask<T>& sliding) {
  VecOf<T> f = stored - (s.ks * dt) * vs;
  sliding = cap(f, slidingLimit);
  return f;
}

// Length in the moments' caps: 2 R_1 R_2/(R_1 + R_2), m.
template <class T>
VIELTO_INLINE T rolling_length(const T& R1, const T& R2) {
  return 2 * R1 * R2 / (R1 + R2);
}

template <class T>
VIELTO_INLINE T rolling_stiffness(const PairOf<T>& p, const Num<T>& kn, const Num<T>& R1, const Num<T>& R2) {
  return p.betaKr * kn * R1 * R2;
}
template <class T>
VIELTO_INLINE T twisting_stiffness(const PairOf<T>& p, const Num<T>& ks, const Num<T>& R1, const Num<T>& R2) {
  return p.betaKtw * ks * R1 * R2;
}

// Spring part of the rolling moment after this step; `wr` is the relative spin less its part along n.
template <class T>
VIELTO_INLINE VecOf<T> rolling_spring(const T& kr, const VecOf<T>& stored, const VecOf<T>& wr, double dt,
                                      const Num<T>& limit, Mask<T>& rolling) {
  VecOf<T> m = stored - (kr * dt) * wr;
  rolling = cap(m, limit);
  return m;
}

// Spring part of the twisting moment along n after this step; wtw is the relative spin along n.
template <class T>
VIELTO_INLINE T twisting_spring(const T& ktw, const Num<T>& stored, const Num<T>& wtw, double dt, const Num<T>& limit,
                                Mask<T>& twisting) {
  const T m = stored - ktw * dt * wtw;
  twisting = fabs(m) > limit;
  return choose(twisting, copysign(limit, m), m);
}

/* Work of a spring with a cap in one step, J: what went in, less what is stored. The force is the mean of old
   and new because the leapfrog's velocity belongs to the middle of the step; then a spring that neither slides
   nor is turned dissipates exactly nothing. */
inline double capped_spring_loss(const Vec& old, const Vec& now, const Vec& rate, double dt, double k) {
  if (k <= 0) return 0.0;
  const double work = -0.5 * dt * dot(old + now, rate);
  return work - 0.5 * (dot(now, now) - dot(old, old)) / k;
}

inline double capped_spring_loss(double old, double now, double rate, double dt, double k) {
  if (k <= 0) return 0.0;
  return -0.5 * dt * (old + now) * rate - 0.5 * (now * now - old * old) / k;
}

// Contact time pi/omega_0 of the undamped normal oscillator, s.
inline double normal_contact_time(double cn, double kn, double mEff) {
  return std::acos(-1.0) * std::sqrt(mEff / (cn * kn));
}

// The springs of one contact: normal and tangential, N/m, rolling and twisting, N m.
struct Springs {
  double normal, tangential, rolling, twisting;
};

/* The shortest half period of one contact's modes, s: normal, sliding with rolling (coupled), twisting.
   Spheres have I = 2/5 m R^2. For a wall pass m2 = infinity; its motion and spin are given. */
inline double shortest_half_period(const Springs& k, double R1, double m1, double R2, double m2) {
  const double pi = std::acos(-1.0);
  const bool wall = std::isinf(m2);
  const double mEff = wall ? m1 : m1 * m2 / (m1 + m2);
  const double I1 = 0.4 * m1 * R1 * R1;
  const double invI1 = 1 / I1;
  const double invI2 = wall ? 0.0 : 1 / (0.4 * m2 * R2 * R2);
  const double lever2 = wall ? 0.0 : R2;
  const double normal = k.normal / mEff;
  const double sliding = k.tangential * (1 / mEff + R1 * R1 * invI1 + lever2 * lever2 * invI2);
  const double rolling = k.rolling * (invI1 + invI2);
  const double coupling = std::sqrt(k.tangential * k.rolling) * (R1 * invI1 - lever2 * invI2);
  const double coupled =
      0.5 * (sliding + rolling) + std::sqrt(0.25 * (sliding - rolling) * (sliding - rolling) + coupling * coupling);
  const double twisting = k.twisting * (invI1 + invI2);
  return pi / std::sqrt(std::max(normal, std::max(coupled, twisting)));
}

// The same for this law; for a wall R2 = wallRadiusFactor R1.
inline double shortest_half_period(const Pair& p, double cn, double R1, double m1, double R2, double m2) {
  const double mEff = std::isinf(m2) ? m1 : m1 * m2 / (m1 + m2);
  const Stiffness s = stiffness(p, R1, R2, mEff);
  const Springs k = {cn * s.kn, s.ks, rolling_stiffness(p, s.kn, R1, R2), twisting_stiffness(p, s.ks, R1, R2)};
  return shortest_half_period(k, R1, m1, R2, m2);
}

/* Angular velocity of a rigid triangle from its corners r and their velocities v, rad/s. Walls hand over none,
   and a grain riding a paddle would see false rolling. Source: v_k - v_0 = w x (r_k - r_0), solved for w. */
inline Vec triangle_spin(const Vec& r0, const Vec& r1, const Vec& r2, const Vec& v0, const Vec& v1, const Vec& v2) {
  const Vec a = r1 - r0, b = r2 - r0, va = v1 - v0, vb = v2 - v0;
  const Vec normal = cross(a, b);
  const double area = dot(normal, normal);  // |a x b|^2
  if (area <= 0) return {0, 0, 0};
  const double nva = dot(normal, va), nvb = dot(normal, vb);
  return (1 / area) * (dot(va, b) * normal + nvb * a - nva * b);
}

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
/* CohFrictPhys: the elastic, frictional contact law with cohesion that breaks and with moments, which the thesis tried
   before ViElTo.

   Purpose   One contact's step as a stateless function on numbers; needs the standard library only. The LIGGGHTS
   adapter normal_model_cohfrict.h calls nothing else. Source    Yade 2023.02a, documentation of CohFrictMat,
   CohFrictPhys and Law2_ScGeom6D_CohFrictPhys_CohesionMoment (Bourrier et al. 2013); what it leaves open was found out
   on the installed program (yade/README.md).

   Bodies 1 and 2, radii R. A wall is body 2 with R_2 = wallRadiusFactor * R_1.

     normal stiffness    k_n = 2 E_1R_1 E_2R_2/(E_1R_1 + E_2R_2)                              N/m
     tangential          k_s = 2 E_1R_1nu_1 E_2R_2nu_2/(E_1R_1nu_1 + E_2R_2nu_2)              N/m
     adhesions           a_n = C_n min(R_1, R_2)^2, a_s = C_s min(R_1, R_2)^2; 0 once broken  N
     normal force        F_n = k_n u_n; the contact ends where -F_n > a_n                     N
     tangential force    F_s += -k_s v_s dt, |F_s| <= max(a_s + F_n tan(phi), 0)              N
                         a bond whose limit is passed breaks, |F_s| <= F_n tan(phi), and
                         then nothing pulls
     rolling moment      M_r += -k_r w_r dt, k_r = alpha_kr k_s R_1R_2,
                         |M_r| <= |F_n| min(eta_r1 R_1, eta_r2 R_2), no limit where < 0       N m
     twisting moment     the like with alpha_ktw and eta_tw, along n                          N m
     mixing              phi, C_n, C_s minimum; alpha harmonic mean where both are > 0, else 0
     slip                v_s = v_t + n x ((R_1 - u_n/2) w_1 + (R_2 - u_n/2) w_2), or, against
                         ratcheting, (R_1+R_2)/(R_1+R_2-u_n) v_t + n x (R_1w_1 + R_2w_2)      m/s

   Convention  as vielto_law.h: n from body 2 to body 1, everything returned acts on body 1, u_n > 0 is overlap.
               The levers of F_s are R_i - u_n/2 with either slip.
   Units       SI, angles in radians.
   Limits      the fragile bond only (Yade's default), which adds to friction; no creep, no damping of any kind.
*/
#ifndef COHFRICT_LAW_H
#define COHFRICT_LAW_H

#include <algorithm>
#include <cmath>

#include "vielto_law.h"

namespace cohfrict {

using vielto::Vec;

// What one body brings into a contact; Yade's names.
struct Material {
  double young;           // E, Pa
  double poisson;         // nu = k_s/k_n, 1; not an elastic constant
  double frictionAngle;   // phi, rad
  double alphaKr;         // rolling stiffness over k_s R_1R_2, 1
  double alphaKtw;        // twisting stiffness over k_s R_1R_2, 1
  double etaRoll;         // arm of the rolling moment's limit over R, 1; < 0: no limit
  double etaTwist;        // arm of the twisting moment's limit over R, 1; < 0: no limit
  double normalCohesion;  // C_n, Pa
  double shearCohesion;   // C_s, Pa
};

// Two materials after the mixing rules that do not need the radii; made once per pair of types.
struct Pair {
  double E1, E2, nu1, nu2;
  double tanPhi;
  double alphaKr, alphaKtw;
  double etaRoll1, etaRoll2, etaTwist1, etaTwist2;
  double normalCohesion, shearCohesion;
};

inline Pair mix(const Material& a, const Material& b) {
  Pair p;
  p.E1 = a.young;
  p.E2 = b.young;
  p.nu1 = a.poisson;
  p.nu2 = b.poisson;
  p.tanPhi = std::tan(std::min(a.frictionAngle, b.frictionAngle));
  p.alphaKr = vielto::harmonic_mean_or_zero(a.alphaKr, b.alphaKr);
  p.alphaKtw = vielto::harmonic_mean_or_zero(a.alphaKtw, b.alphaKtw);
  p.etaRoll1 = a.etaRoll;
  p.etaRoll2 = b.etaRoll;
  p.etaTwist1 = a.etaTwist;
  p.etaTwist2 = b.etaTwist;
  p.normalCohesion = std::min(a.normalCohesion, b.normalCohesion);
  p.shearCohesion = std::min(a.shearCohesion, b.shearCohesion);
  return p;
}

// Constants of one contact.
struct Contact {
  double kn, ks;   // N/m
  double kr, ktw;  // N m
  double tanPhi;
  double rollingArm, twistingArm;        // limit of the moment over |F_n|, m; < 0: no limit
  double normalAdhesion, shearAdhesion;  // N
};

inline Contact contact(const Pair& p, double R1, double R2) {
  const double a1 = p.E1 * R1, a2 = p.E2 * R2;
  const double b1 = a1 * p.nu1, b2 = a2 * p.nu2;
  const double area = std::min(R1, R2) * std::min(R1, R2);
  Contact c;
  c.kn = 2 * a1 * a2 / (a1 + a2);
  c.ks = 2 * b1 * b2 / (b1 + b2);
  c.tanPhi = p.tanPhi;
  c.kr = p.alphaKr * c.ks * R1 * R2;
  c.ktw = p.alphaKtw * c.ks * R1 * R2;
  c.rollingArm = std::min(p.etaRoll1 * R1, p.etaRoll2 * R2);
  c.twistingArm = std::min(p.etaTwist1 * R1, p.etaTwist2 * R2);
  c.normalAdhesion = p.normalCohesion * area;
  c.shearAdhesion = p.shearCohesion * area;
  return c;
}

// Slip velocity. v = v_1 - v_2 of the centres (for a wall: of its surface), R2 = 0 for a wall, whose spin v holds.
inline Vec slip(const Vec& n, const Vec& v, const Vec& w1, const Vec& w2, double R1, double R2, double overlap,
                bool avoidRatcheting) {
  const Vec vt = v - dot(v, n) * n;
  if (avoidRatcheting) return (R1 + R2) / (R1 + R2 - overlap) * vt + cross(n, R1 * w1 + R2 * w2);
  const double arm2 = R2 > 0 ? R2 - 0.5 * overlap : 0.0;
  return vt + cross(n, (R1 - 0.5 * overlap) * w1 + arm2 * w2);
}

// What a contact remembers.
struct Memory {
  Vec shear;     // N
  Vec rolling;   // N m
  double twist;  // N m
  bool bonded;
};

// Motion of one contact in this step; shear and rolling memories are turned to n by the step.
struct Motion {
  Vec n;
  double overlap;    // m
  Vec slip;          // m/s
  Vec rolling;       // rad/s, w_1 - w_2 less its part along n
  double twisting;   // rad/s, (w_1 - w_2) . n
  double spinAngle;  // half of (w_1 + w_2) . n dt, rad
};

struct Load {
  double normal;  // F_n, N
  Vec shear;      // F_s, N
  Vec moment;     // N m
};

/* Energies of one contact, J: what its springs hold after the step, and what the step took out of them. A bond that
   breaks, or a contact that ends, lets go what was held: booked with sliding. */
struct Energy {
  double elastic;
  double sliding, rolling, twisting;
};

inline double held(double force, double k) { return k > 0 ? 0.5 * force * force / k : 0.0; }
inline double held(const Vec& force, double k) { return k > 0 ? 0.5 * dot(force, force) / k : 0.0; }

inline double held(const Contact& c, double Fn, const Memory& memory) {
  return held(Fn, c.kn) + held(memory.shear, c.ks) + held(memory.rolling, c.kr) + held(memory.twist, c.ktw);
}

/* One step of a contact. Returns false where the contact has ended: no load, and the memory is to be forgotten.
   `energy`, if asked for, is of this step. */
inline bool advance(const Contact& c, const Motion& m, double dt, Memory& memory, Load& load,
                    Energy* energy = nullptr) {
  double Fn = c.kn * m.overlap;
  if (-Fn > (memory.bonded ? c.normalAdhesion : 0.0)) {
    if (energy) *energy = {0, held(c, memory.bonded ? Fn : 0.0, memory), 0, 0};
    return false;
  }

  const Vec shear = vielto::turned_with_contact(memory.shear, m.n, m.spinAngle);
  memory.shear = shear - (c.ks * dt) * m.slip;
  double letGo = 0;
  const double friction = Fn * c.tanPhi;
  const double limit = std::max((memory.bonded ? c.shearAdhesion : 0.0) + friction, 0.0);
  if (dot(memory.shear, memory.shear) > limit * limit) {
    memory.bonded = false;
    vielto::cap(memory.shear, std::max(friction, 0.0));
    if (Fn < 0) letGo = held(Fn, c.kn);
    Fn = std::max(Fn, 0.0);
  }

  const Vec rolling = vielto::turned_with_contact(memory.rolling, m.n, m.spinAngle);
  const double twist = memory.twist;
  memory.rolling = rolling - (c.kr * dt) * m.rolling;
  memory.twist -= c.ktw * dt * m.twisting;
  if (c.rollingArm >= 0) vielto::cap(memory.rolling, c.rollingArm * std::fabs(Fn));
  if (c.twistingArm >= 0) {
    const double most = c.twistingArm * std::fabs(Fn);
    memory.twist = std::max(-most, std::min(most, memory.twist));
  }
  load.normal = Fn;
  load.shear = memory.shear;
  load.moment = memory.rolling + memory.twist * m.n;
  if (energy) {
    energy->elastic = held(c, Fn, memory);
    energy->sliding = letGo + vielto::capped_spring_loss(shear, memory.shear, m.slip, dt, c.ks);
    energy->rolling = vielto::capped_spring_loss(rolling, memory.rolling, m.rolling, dt, c.kr);
    energy->twisting = vielto::capped_spring_loss(twist, memory.twist, m.twisting, dt, c.ktw);
  }
  return true;
}

// The springs of a contact, for its shortest half period.
inline vielto::Springs springs(const Contact& c) { return {c.kn, c.ks, c.kr, c.ktw}; }

// Longest stretch of a bond over R_1 (wall) or R_1 + R_2: a bound for all radii, a_n/k_n <= C_n/E times either.
inline double stretch_bound(double normalCohesion, double youngMin) { return normalCohesion / youngMin; }

}  // namespace cohfrict

#endif

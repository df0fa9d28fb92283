// SPDX-License-Identifier: GPL-2.0-or-later
/* Springs of LIGGGHTS' own laws with `tangential history rolling_friction epsd2`, for the time scale of a contact. Each
   is the closed form of LIGGGHTS' header (normal_model_hertz.h, normal_model_hooke.h, rolling_model_epsd2.h):

     Y = 1/((1 - v1^2)/E1 + (1 - v2^2)/E2),  G = 1/(2 (2 - v1)(1 + v1)/E1 + 2 (2 - v2)(1 + v2)/E2)                   Pa
     hertz   dF_n/du = 2 Y sqrt(R u),  k_t = 8 G sqrt(R u);  taken at the overlap limit, where both are greatest  N/m
     hooke   k_n = 16/15 sqrt(R) Y (15 m V^2/(16 sqrt(R) Y))^(1/5),  k_t = 2/7 k_n (ktToKnUser on)                 N/m
     epsd2   k_r = k_t R^2                                                                                          N m
   with R = R1 R2/(R1 + R2) (R1 at a wall), m = m1 m2/(m1 + m2) (m1 at a wall), V the characteristicVelocity. */
#ifndef VIELTO_STOCK_H
#define VIELTO_STOCK_H

#include <cmath>

#include "vielto_law.h"

namespace stock {

struct Material {
  double young;    // E, Pa
  double poisson;  // v, 1
};

struct Moduli {
  double normal, shear;  // Y, G, Pa
};

inline Moduli moduli(const Material& a, const Material& b) {
  const auto shear = [](const Material& m) { return 2 * (2 - m.poisson) * (1 + m.poisson) / m.young; };
  return {1 / ((1 - a.poisson * a.poisson) / a.young + (1 - b.poisson * b.poisson) / b.young),
          1 / (shear(a) + shear(b))};
}

// For a wall m2 is infinite.
inline double radius(double R1, double R2, double m2) { return std::isinf(m2) ? R1 : R1 * R2 / (R1 + R2); }
inline double mass(double m1, double m2) { return std::isinf(m2) ? m1 : m1 * m2 / (m1 + m2); }

inline vielto::Springs hertz_springs(const Moduli& c, double overlap, double R) {
  const double a = std::sqrt(R * overlap), kt = 8 * c.shear * a;
  return {2 * c.normal * a, kt, kt * R * R, 0.0};
}

inline vielto::Springs hooke_springs(const Moduli& c, double V, double R, double m) {
  const double s = std::sqrt(R) * c.normal, kn = 16.0 / 15 * s * std::pow(15 * m * V * V / (16 * s), 0.2),
               kt = 2.0 / 7 * kn;
  return {kn, kt, kt * R * R, 0.0};
}

}  // namespace stock

#endif

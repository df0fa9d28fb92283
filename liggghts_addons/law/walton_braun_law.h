// SPDX-License-Identifier: GPL-2.0-or-later
/* Walton and Braun's linear hysteretic normal force: plastic grains. Loading follows a soft spring, unloading a stiffer
   one, and what lies between the two branches is lost.

   Purpose   The normal force of one contact as stateless functions on numbers; needs the standard library only. The
             LIGGGHTS adapter normal_model_walton_braun.h calls nothing else.
   Source    O. R. Walton and R. L. Braun (1986), J. Rheology 30:949, their "partially latching spring" with constant
             and with load-dependent (variable) latching. LIGGGHTS' own hooke/hysteresis and luding are Luding's later
             law: a dashpot beside the springs, and one stiffness for grains of every size.

     loading             F = k_1 u                                                          N
     unloading           F = k_2 (u - u_0), 0 where that is negative                        N
     residual overlap    u_0 = u_m (1 - k_1/k_2), u_m the greatest overlap of this contact  m
     reloading           back along k_2 up to u_m, then along k_1
     unloading stiffness k_2 = k_1/e^2 + S F_m, F_m = k_1 u_m, S = h/d                      N/m

   e     coefficient of restitution without load dependence, (0, 1]
   h     hardening, 1; 0: k_2 is constant. d is the smaller grain's diameter, so that grains of every size behave alike.

   Closed forms, m the effective mass, v the speed of approach, undisturbed impact:
     restitution         sqrt(k_1/k_2): with h = 0 it is e at every speed; with e = 1, [1 + (h/d) v sqrt(m/k_1)]^(-1/2),
                         which is Walton and Braun's [w/(S v + w)]^(1/2) with w = sqrt(k_1/m)
     contact time        (pi/2) (sqrt(m/k_1) + sqrt(m/k_2))                                 s
     loss                (1/2) k_1 u_m^2 (1 - k_1/k_2), whatever comes after u_m            J

   Units     SI.
   Limits    u_m is forgotten when the surfaces part, so a grain hit twice at one place is soft again; between u_0 and
             parting the surfaces touch without force, and so without friction. No attraction.
*/
#ifndef WALTON_BRAUN_LAW_H
#define WALTON_BRAUN_LAW_H

#include <algorithm>

namespace walton_braun {

// k_2, N/m. `greatest` is u_m, `diameter` d.
inline double unloading_stiffness(double k1, double e, double h, double greatest, double diameter) {
  return k1 * (1 / (e * e) + h * greatest / diameter);
}

// F, N; `overlap` is at most `greatest`.
inline double force(double k1, double k2, double overlap, double greatest) {
  return std::max(k1 * greatest - k2 * (greatest - overlap), 0.0);
}

// What the contact would give back, J.
inline double held(double force, double k2) { return 0.5 * force * force / k2; }

// What it has lost since it began, J.
inline double lost(double k1, double k2, double greatest) { return 0.5 * k1 * greatest * greatest * (1 - k1 / k2); }

}  // namespace walton_braun

#endif

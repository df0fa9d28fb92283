// SPDX-License-Identifier: GPL-2.0-or-later
/* Drag of still air on grains, as it slows the real grain that a coarse grain stands for.

     fix ID GROUP vielto/drag scale S diameter D density RHO

   A grain of velocity v gets the force -m a_D v/|v| with the deceleration of a lone sphere of diameter D (m) and
   density RHO (kg/m3), times S (1; > 0):

     a_D = S (3/4) C_D (rho_air/RHO) v^2/D,   Re = rho_air v D/mu_air
     C_D = 24/Re (1 + 0.15 Re^0.687) for Re < 1000, else 0.44

   with air of 20 C, rho_air 1.2 kg/m3, mu_air 1.8e-5 Pa s. Spins are not slowed; the energy accounts of vielto/record
   do not book it. Source: Schiller and Naumann 1933, Z. Ver. Dtsch. Ing. 77:318. */
#ifndef LMP_FIX_VIELTO_DRAG_H
#define LMP_FIX_VIELTO_DRAG_H

#include "fix.h"

namespace LAMMPS_NS {

class FixViEltoDrag : public Fix {
 public:
  FixViEltoDrag(class LAMMPS*, int, char**);
  int setmask() override;
  void init() override;
  void setup(int vflag) override { post_force(vflag); }
  void post_force(int) override;

 private:
  double scale_ = 0, diameter_ = 0, density_ = 0;
};

}  // namespace LAMMPS_NS
#endif

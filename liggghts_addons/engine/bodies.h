// SPDX-License-Identifier: GPL-2.0-or-later
/* What has mass: the grains, or, where there is a fix multisphere, its clumps, since each sphere of a clump carries the
   mass of the whole. Of this processor; a clump belongs to the one that holds its centre of mass. */
#ifndef VIELTO_BODIES_H
#define VIELTO_BODIES_H

#include "atom.h"
#include "fix_multisphere.h"
#include "modify.h"

namespace vielto {

// Null where grains are spheres.
inline LAMMPS_NS::Multisphere* clumps_of(LAMMPS_NS::Modify* modify) {
  auto* fix = static_cast<LAMMPS_NS::FixMultisphere*>(modify->find_fix_style("multisphere", 0));
  return fix ? &fix->data() : nullptr;
}

// use(mass in kg, place of the centre of mass in m)
template <class Use>
void each_mass(LAMMPS_NS::Modify* modify, LAMMPS_NS::Atom* atom, Use use) {
  if (LAMMPS_NS::Multisphere* clumps = clumps_of(modify)) {
    double x[3];
    for (int i = 0; i < clumps->n_body(); i++) {
      clumps->xcm(x, i);
      use(clumps->mass(i), x);
    }
    return;
  }
  for (int i = 0; i < atom->nlocal; i++) use(atom->rmass[i], atom->x[i]);
}

/* J, of flight and of turning: 1/2 m v^2 + 1/2 omega . L; a sphere's L is 2/5 m r^2 omega. */
inline double kinetic_energy_of(LAMMPS_NS::Modify* modify, LAMMPS_NS::Atom* atom) {
  double sum = 0;
  if (LAMMPS_NS::Multisphere* clumps = clumps_of(modify)) {
    double v[3], w[3], L[3];
    for (int i = 0; i < clumps->n_body(); i++) {
      clumps->vcm(v, i), clumps->omega(w, i), clumps->angmom(L, i);
      for (int d = 0; d < 3; d++) sum += 0.5 * (clumps->mass(i) * v[d] * v[d] + w[d] * L[d]);
    }
    return sum;
  }
  for (int i = 0; i < atom->nlocal; i++) {
    const double *v = atom->v[i], *w = atom->omega[i], r = atom->radius[i];
    sum += 0.5 * atom->rmass[i] *
           (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + 0.4 * r * r * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
  }
  return sum;
}

}  // namespace vielto
#endif

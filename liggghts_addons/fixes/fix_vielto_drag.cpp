// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/fix_vielto_drag.h"

#include <stdlib.h>
#include <string.h>

#include <cmath>

#include "atom.h"
#include "error.h"
#include "force.h"
#include "modify.h"

using namespace LAMMPS_NS;

namespace {
const double air_density = 1.2, air_viscosity = 1.8e-5;
}

FixViEltoDrag::FixViEltoDrag(LAMMPS* lammps, int narg, char** arg) : Fix(lammps, narg, arg) {
  for (int k = 3; k + 1 < narg; k += 2) {
    const double value = force->numeric(FLERR, arg[k + 1]);
    if (strcmp(arg[k], "scale") == 0)
      scale_ = value;
    else if (strcmp(arg[k], "diameter") == 0)
      diameter_ = value;
    else if (strcmp(arg[k], "density") == 0)
      density_ = value;
    else
      error->fix_error(FLERR, this, "knows the keywords scale, diameter and density");
  }
  if (narg != 9 || !(scale_ > 0 && diameter_ > 0 && density_ > 0))
    error->fix_error(FLERR, this, "expects 'scale S diameter D density RHO', each > 0");
}

void FixViEltoDrag::init() {
  if (modify->n_fixes_style("multisphere") > 0)
    error->fix_error(FLERR, this, "knows the drag of spheres only, not that of clumps (fix multisphere)");
}

int FixViEltoDrag::setmask() { return FixConst::POST_FORCE; }

void FixViEltoDrag::post_force(int) {
  // a_D/v = A (1 + B v^0.687), or C v
  const double A = scale_ * 18 * air_viscosity / (density_ * diameter_ * diameter_);
  const double reynolds = air_density * diameter_ / air_viscosity;  // of 1 m/s
  const double C = scale_ * 0.33 * air_density / (density_ * diameter_);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    const double* const v = atom->v[i];
    const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double Re = reynolds * speed;
    const double rate = Re < 1000 ? A * (1 + 0.15 * std::pow(Re, 0.687)) : C * speed;
    for (int d = 0; d < 3; d++) atom->f[i][d] -= atom->rmass[i] * rate * v[d];
  }
}

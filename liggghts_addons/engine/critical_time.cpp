// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/critical_time.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "atom.h"
#include "comm.h"
#include "engine/law.h"
#include "error.h"
#include "lammps.h"
#include "update.h"
#include "vielto_state.h"

namespace vielto {
namespace {

const double INF = std::numeric_limits<double>::infinity();

struct Smallest {
  double radius, mass;
};

// Over all pairs of types: grain on grain of either type, and grain on wall of any type.
double shortest(LAMMPS_NS::LAMMPS* lmp, const std::vector<Smallest>& smallest) {
  const HalfPeriod half_period = law_in_use(lmp, "the shortest half period of a contact").half_period(lmp);
  const double wallFactor = settings().wallRadiusFactor;
  const int types = lmp->atom->ntypes;
  double time = INF;
  for (int i = 1; i <= types; i++) {
    if (std::isinf(smallest[i].radius)) continue;
    for (int j = 1; j <= types; j++) {
      const Smallest &a = smallest[i], &b = smallest[j];
      time = std::min(time, half_period(i, j, a.radius, a.mass, wallFactor * a.radius, INF));
      if (!std::isinf(b.radius)) time = std::min(time, half_period(i, j, a.radius, a.mass, b.radius, b.mass));
    }
  }
  return std::isinf(time) ? 0.0 : time;
}

}  // namespace

double shortest_half_period_of(LAMMPS_NS::LAMMPS* lmp, double radius, double density) {
  const double mass = density * 4.0 / 3.0 * std::acos(-1.0) * radius * radius * radius;
  return shortest(lmp, std::vector<Smallest>(lmp->atom->ntypes + 1, Smallest{radius, mass}));
}

double shortest_half_period_now(LAMMPS_NS::LAMMPS* lmp) {
  const LAMMPS_NS::Atom* atom = lmp->atom;
  const int n = atom->ntypes + 1;
  std::vector<double> mine(2 * n, INF), all(2 * n, INF);
  for (int i = 0; i < atom->nlocal; i++) {
    const int t = atom->type[i];
    mine[2 * t] = std::min(mine[2 * t], atom->radius[i]);
    mine[2 * t + 1] = std::min(mine[2 * t + 1], atom->rmass[i]);
  }
  MPI_Allreduce(mine.data(), all.data(), 2 * n, MPI_DOUBLE, MPI_MIN, lmp->world);
  std::vector<Smallest> smallest(n, Smallest{INF, INF});
  for (int t = 1; t < n; t++) smallest[t] = Smallest{all[2 * t], all[2 * t + 1]};
  return shortest(lmp, smallest);
}

void TimeStepWatch::look(LAMMPS_NS::LAMMPS* lmp) {
  if (said_ || run_ == lmp->update->firststep) return;
  run_ = lmp->update->firststep;
  const double limit = 0.1, dt = lmp->update->dt, tc = shortest_half_period_now(lmp);
  if (!(tc > 0) || dt <= limit * tc) return;
  said_ = true;
  char line[300];
  snprintf(line, sizeof line,
           "vielto: time step %.4g s is %.3g of the shortest half period of a contact (%.4g s); over %g contacts are "
           "false and grains may be lost; take %.4g s",
           dt, dt / tc, tc, limit, 0.05 * tc);
  if (lmp->comm->me == 0) lmp->error->warning(FLERR, line);
}

}  // namespace vielto

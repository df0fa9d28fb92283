// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/critical_time.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "atom.h"
#include "cohfrict_properties.h"
#include "comm.h"
#include "lammps.h"
#include "stock_springs.h"
#include "vielto_properties.h"
#include "vielto_state.h"

namespace vielto {
namespace {

const double INF = std::numeric_limits<double>::infinity();

struct Smallest {
  double radius, mass;
};

// Over all pairs of types: grain on grain of either type, and grain on wall of any type.
// half_period(i, j, R1, m1, R2, m2) is that of one contact.
template <class HalfPeriod>
double shortest(int types, const std::vector<Smallest>& smallest, const HalfPeriod& half_period) {
  const double wallFactor = settings().wallRadiusFactor;
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

// Materials of LIGGGHTS' own laws, by type.
std::vector<stock::Material> stock_materials(LAMMPS_NS::LAMMPS* lmp) {
  const std::vector<double> young = read_property(lmp, {"youngsModulus", 0, INF, false, false, "Pa"}),
                            poisson = read_property(lmp, {"poissonsRatio", 0, 0.5, true, true, "1"});
  std::vector<stock::Material> list(young.size());
  for (std::size_t t = 1; t < list.size(); t++) list[t] = {young[t], poisson[t]};
  return list;
}

double shortest_of_stock(LAMMPS_NS::LAMMPS* lmp, const std::vector<Smallest>& smallest) {
  const std::vector<stock::Material> materials = stock_materials(lmp);
  const bool hertz = settings().law == HERTZ_LAW;
  LAMMPS_NS::FixPropertyGlobal* const velocity = hertz ? NULL : find_property(lmp, "characteristicVelocity");
  if (!hertz && !velocity) stop_all(lmp, "vielto: property characteristicVelocity of hooke is missing");
  const double V = velocity ? velocity->compute_scalar() : 0.0;
  return shortest(lmp->atom->ntypes, smallest, [&](int i, int j, double R1, double m1, double R2, double m2) {
    const stock::Moduli c = stock::moduli(materials[i], materials[j]);
    const double R = stock::radius(R1, R2, m2), diameter = 2 * (std::isinf(m2) ? R1 : std::min(R1, R2));
    const Springs k = hertz ? stock::hertz_springs(c, settings().maxOverlap * diameter, R)
                            : stock::hooke_springs(c, V, R, stock::mass(m1, m2));
    return shortest_half_period(k, R1, m1, R2, m2);
  });
}

double shortest(LAMMPS_NS::LAMMPS* lmp, const std::vector<Smallest>& smallest) {
  if (stock_law()) return shortest_of_stock(lmp, smallest);
  if (settings().law == COHFRICT_LAW) {
    cohfrict::PairTable pairs;
    pairs.read(lmp);
    return shortest(lmp->atom->ntypes, smallest, [&](int i, int j, double R1, double m1, double R2, double m2) {
      return shortest_half_period(springs(cohfrict::contact(pairs(i, j), R1, R2)), R1, m1, R2, m2);
    });
  }
  PairTable pairs;
  pairs.read(lmp);
  return shortest(lmp->atom->ntypes, smallest, [&](int i, int j, double R1, double m1, double R2, double m2) {
    return shortest_half_period(pairs(i, j), settings().springFactor, R1, m1, R2, m2);
  });
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

}  // namespace vielto

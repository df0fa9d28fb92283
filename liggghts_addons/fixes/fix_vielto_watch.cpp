// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/fix_vielto_watch.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include <cmath>
#include <string>
#include <vector>

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "update.h"
#include "vielto_stop.h"

using namespace LAMMPS_NS;

namespace vielto {

void GrainWatch::look(const std::string& when) {
  const bigint mine = atom->nlocal;
  bigint now = 0;
  MPI_Allreduce(&mine, &now, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (grains_ >= 0 && now != grains_) stop(now, when);
  stop_if_nowhere(when);
  grains_ = now;
  places_.clear();
  for (int i = 0; i < atom->nlocal; i++) {
    Place& place = places_[atom->tag[i]];
    for (int d = 0; d < 3; d++) place.x[d] = atom->x[i][d], place.v[d] = atom->v[i][d];
    place.radius = atom->radius[i];
  }
}

void GrainWatch::stop(bigint now, const std::string& when) {
  // a tag that was here at the last look and is nowhere now
  int n = atom->nlocal, sum = 0;
  std::vector<int> counts(comm->nprocs), offsets(comm->nprocs);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int p = 0; p < comm->nprocs; p++) offsets[p] = sum, sum += counts[p];
  std::vector<int> all(sum);
  MPI_Allgatherv(atom->tag, n, MPI_INT, all.data(), counts.data(), offsets.data(), MPI_INT, world);
  for (int tag : all) places_.erase(tag);
  int lost = places_.empty() ? 0 : places_.begin()->first, any = 0;
  MPI_Allreduce(&lost, &any, 1, MPI_INT, MPI_MAX, world);
  stop_for(any,
           std::to_string(now) + " of " + std::to_string(grains_) + " grains are there; grain " + std::to_string(any) +
               " was lost since the last look, when it was at",
           when);
}

void GrainWatch::stop_if_nowhere(const std::string& when) {
  int mine = 0, any = 0;
  for (int i = 0; i < atom->nlocal; i++)
    for (int d = 0; d < 3; d++)
      if (!std::isfinite(atom->x[i][d]) || !std::isfinite(atom->v[i][d])) mine = atom->tag[i];
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (any > 0)
    stop_for(any, "place or velocity of grain " + std::to_string(any) + " is no number; at the last look it was at",
             when);
}

// With where the grain was at the last look; all zero where it was not yet looked at.
void GrainWatch::stop_for(int tag, const std::string& what, const std::string& when) {
  Place place = {};
  if (places_.count(tag)) place = places_[tag];
  double mine[7] = {place.x[0], place.x[1], place.x[2], place.v[0], place.v[1], place.v[2], place.radius}, p[7];
  MPI_Allreduce(mine, p, 7, MPI_DOUBLE, MPI_SUM, world);
  const double speed = std::sqrt(p[3] * p[3] + p[4] * p[4] + p[5] * p[5]);
  const double moved = p[6] > 0 ? speed * update->dt / p[6] : 0;
  // a contact lasts some twenty steps: a grain that crosses more than a hundredth of its radius in each is not held
  const char* const cause = moved > 0.01
                                ? "grains are too soft, or the time step is too long, for this speed"
                                : "a wall let it through: grains too soft for the load, or a mesh that is open";
  char line[600];
  snprintf(line, sizeof line,
           "vielto: step " BIGINT_FORMAT
           " (%s): %s (%.4g %.4g %.4g) m with velocity (%.4g %.4g %.4g) m/s, %.2g of its radius a step; "
           "likely %s",
           update->ntimestep, when.c_str(), what.c_str(), p[0], p[1], p[2], p[3], p[4], p[5], moved, cause);
  stop_all(lmp, line);
}

}  // namespace vielto

FixViEltoWatch::FixViEltoWatch(LAMMPS* lammps, int narg, char** arg) : Fix(lammps, narg, arg), watch_(lammps) {
  if (narg != 5 || strcmp(arg[3], "every") != 0 || (nevery = atoi(arg[4])) < 1)
    error->fix_error(FLERR, this, "expects 'every N' with a whole number N >= 1");
}

int FixViEltoWatch::setmask() { return FixConst::END_OF_STEP; }
void FixViEltoWatch::setup(int) { watch_.look("start of a run"); }
void FixViEltoWatch::end_of_step() { watch_.look("every " + std::to_string(nevery) + " steps"); }

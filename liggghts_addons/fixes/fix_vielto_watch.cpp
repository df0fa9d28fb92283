// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/fix_vielto_watch.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>

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
  grains_ = now;
  places_.clear();
  for (int i = 0; i < atom->nlocal; i++) {
    Place& place = places_[atom->tag[i]];
    for (int d = 0; d < 3; d++) place.x[d] = atom->x[i][d], place.v[d] = atom->v[i][d];
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
  Place place = {};
  if (places_.count(any)) place = places_[any];
  double mine[6] = {place.x[0], place.x[1], place.x[2], place.v[0], place.v[1], place.v[2]}, p[6];
  MPI_Allreduce(mine, p, 6, MPI_DOUBLE, MPI_SUM, world);
  char line[400];
  snprintf(line, sizeof line,
           "vielto: step " BIGINT_FORMAT " (%s): " BIGINT_FORMAT " of " BIGINT_FORMAT
           " grains are there; grain %d was lost since the last look, when it was at (%.4g %.4g %.4g) m with "
           "velocity (%.4g %.4g %.4g) m/s",
           update->ntimestep, when.c_str(), now, grains_, any, p[0], p[1], p[2], p[3], p[4], p[5]);
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

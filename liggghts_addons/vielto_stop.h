// SPDX-License-Identifier: GPL-2.0-or-later
/* Stops the run from one processor with a line that is seen. LIGGGHTS' error->one leaves its line in a buffer that
   MPI_Abort throws away when the output goes to a file. */
#ifndef VIELTO_STOP_H
#define VIELTO_STOP_H

#include <mpi.h>
#include <stdio.h>

#include "comm.h"
#include "error.h"
#include "pointers.h"

namespace vielto {

inline void stop_here(LAMMPS_NS::LAMMPS* lmp, const char* line) {
  if (lmp->comm->nprocs == 1) lmp->error->all(FLERR, line);
  FILE* const outputs[2] = {lmp->screen ? lmp->screen : stderr, lmp->logfile};
  for (int k = 0; k < 2; k++)
    if (outputs[k]) {
      fprintf(outputs[k], "ERROR on proc %d: %s\n", lmp->comm->me, line);
      fflush(outputs[k]);
    }
  MPI_Abort(lmp->world, 1);
}

}  // namespace vielto

#endif

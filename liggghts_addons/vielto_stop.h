// SPDX-License-Identifier: GPL-2.0-or-later
/* Stops the run with one line that is seen. LIGGGHTS' error->one leaves its line in a buffer that MPI_Abort throws
   away when the output goes to a file, and error->all may print a second line read from freed memory. */
#ifndef VIELTO_STOP_H
#define VIELTO_STOP_H

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

#include "comm.h"
#include "pointers.h"

namespace vielto {

inline void print_error(LAMMPS_NS::LAMMPS* lmp, const char* line) {
  FILE* const outputs[2] = {lmp->screen ? lmp->screen : stderr, lmp->logfile};
  for (int k = 0; k < 2; k++)
    if (outputs[k]) {
      fprintf(outputs[k], "ERROR: %s\n", line);
      fflush(outputs[k]);
    }
}

// Called by all processors; the first one prints.
inline void stop_all(LAMMPS_NS::LAMMPS* lmp, const char* line) {
  MPI_Barrier(lmp->world);
  if (lmp->comm->me == 0) print_error(lmp, line);
  MPI_Finalize();
  exit(1);
}

// Called by one processor alone.
inline void stop_here(LAMMPS_NS::LAMMPS* lmp, const char* line) {
  if (lmp->comm->nprocs == 1) stop_all(lmp, line);
  print_error(lmp, line);
  MPI_Abort(lmp->world, 1);
}

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS with ViElTo: the distribution's library under our own main, used exactly as the stock `liggghts`.
#include <mpi.h>
#include <signal.h>

#include "input.h"
#include "lammps.h"
#include "signal_handling.h"
#include "vielto_register.h"

int main(int argc, char** argv) {
  // as the stock program: SIGINT and SIGTERM end the run at the next step (status 1), SIGUSR1 writes a restart
  struct sigaction interrupt = {}, user = {};
  interrupt.sa_handler = LAMMPS_NS::SignalHandler::int_handler;
  user.sa_handler = LAMMPS_NS::SignalHandler::usr1_handler;
  sigaction(SIGINT, &interrupt, nullptr);
  sigaction(SIGTERM, &interrupt, nullptr);
  sigaction(SIGUSR1, &user, nullptr);

  MPI_Init(&argc, &argv);
  {
    LAMMPS_NS::LAMMPS liggghts(argc, argv, MPI_COMM_WORLD);
    vielto::install(&liggghts);
    liggghts.input->file();
  }
  MPI_Finalize();
  return LAMMPS_NS::SignalHandler::request_quit ? 1 : 0;
}

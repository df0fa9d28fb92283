// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS with ViElTo: the distribution's library under our own main, used exactly as the stock `liggghts`.
#include <mpi.h>
#include <signal.h>
#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "input.h"
#include "lammps.h"
#include "plugin/registration.h"
#include "signal_handling.h"

namespace {

std::string sessionFolder;

void remove_session_folder() {
  std::error_code ignored;
  std::filesystem::remove_all(sessionFolder, ignored);
}

/* Open MPI keeps a session folder, which all single processes of a user share: one that ends may remove it from under
   one that starts, which then fails in MPI_Init. A campaign starts many, so a process without a launcher gets its own.
 */
void own_session_folder() {
  for (const char* launcher :
       {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID", "OMPI_MCA_orte_tmpdir_base"})
    if (getenv(launcher)) return;
  std::string name = (std::filesystem::temp_directory_path() / "liggghts-XXXXXX").string();
  if (!mkdtemp(&name[0])) return;
  sessionFolder = name;
  setenv("OMPI_MCA_orte_tmpdir_base", name.c_str(), 1);
  atexit(remove_session_folder);
}

}  // namespace

int main(int argc, char** argv) {
  // as the stock program: SIGINT and SIGTERM end the run at the next step (status 1), SIGUSR1 writes a restart
  struct sigaction interrupt = {}, user = {};
  interrupt.sa_handler = LAMMPS_NS::SignalHandler::int_handler;
  user.sa_handler = LAMMPS_NS::SignalHandler::usr1_handler;
  sigaction(SIGINT, &interrupt, nullptr);
  sigaction(SIGTERM, &interrupt, nullptr);
  sigaction(SIGUSR1, &user, nullptr);

  own_session_folder();
  MPI_Init(&argc, &argv);
  {
    LAMMPS_NS::LAMMPS liggghts(argc, argv, MPI_COMM_WORLD);
    vielto::install(&liggghts);
    liggghts.input->file();
  }
  MPI_Finalize();
  return LAMMPS_NS::SignalHandler::request_quit ? 1 : 0;
}

// SPDX-License-Identifier: GPL-2.0-or-later
/* Script command `vielto`, for what an input script cannot say in LIGGGHTS' own words:

     vielto error 'TEXT'                       stop the run with this line (exit status 1)
     vielto half_period NAME radius R density RHO
                                               set variable NAME to the shortest half period of a contact, s, for grains of
                                               this radius (m) and density (kg/m3); needs the pair_style line and properties
     vielto open FOLDER parameters F1 F2 ... inputs G1 G2 ...
                                               make FOLDER.partial with run.json: the present values of all parameters stated
                                               in the files F, hashes of all files F and G, versions, command line
     vielto close FOLDER                       mark run.json complete and rename FOLDER.partial to FOLDER */
#ifdef COMMAND_CLASS
CommandStyle(vielto, ViEltoCommand)
#else
#ifndef LMP_VIELTO_COMMAND_H
#define LMP_VIELTO_COMMAND_H

#include "pointers.h"

namespace LAMMPS_NS {

class ViEltoCommand : protected Pointers {
 public:
  explicit ViEltoCommand(class LAMMPS* lammps) : Pointers(lammps) {}
  void command(int narg, char** arg);

 private:
  void half_period(int narg, char** arg);
  void open(int narg, char** arg);
  void close(int narg, char** arg);
};

}  // namespace LAMMPS_NS
#endif
#endif

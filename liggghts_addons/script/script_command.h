// SPDX-License-Identifier: GPL-2.0-or-later
// clang-format off
/* Script command `vielto`, for what an input script cannot say in LIGGGHTS' own words:

     vielto setup F1 F2 ... [NAME=VALUE ...] [when P WORD NAME=VALUE ... NAME==VALUE ...] [bed P1 P2 ...]
         everything before the first particle. Reads the parameter files F (the rig's own first) and the cards of grain and wall
         (run_parameters.h), takes -var instead of their values and checks all of them; opens the run folder `run` with run.json
         (run_folder.h), or takes up the one broken off (resume yes); makes the meshes in it (vielto geometry) and includes
         their geometry.par; logs into it. Any fault stops the run before that.
         NAME=VALUE sets a parameter unless -var does, or another variable (NAMEFile: an input of the run); {P} in VALUE is
         parameter P; after `when` only if parameter P is WORD. NAME==VALUE stops a run in which NAME is another. A run with -var bed FOLDER takes the bed of a complete one
         with the same parameters but for P1 P2 ...
         Variables: every parameter; P_is_WORD, 1 or 0, for each word a parameter may be; work (the folder while it runs);
         provisional (1: a card says so); resuming, restarting (1: from restartFile); seed1 ... seed9, prime numbers from `seed`
     vielto close FOLDER                       mark run.json complete, keep the last restart file only and rename
                                               FOLDER.partial to FOLDER
     vielto error TEXT...                      stop the run with this line (exit status 1); a run folder without a record
                                               or a restart file is removed
     vielto half_period NAME radius R density RHO
                                               set variable NAME to the shortest half period of a contact, s, for grains of this
                                               radius (m) and density (kg/m3); needs the pair_style line and properties
     vielto words NAME W1 W2 ...               set variable NAME to these words (quoted text is not substituted by LIGGGHTS)
     vielto repeat N "COMMAND" ... [until NAME]
                                               N times these commands, with 1 ... N for % in them; ends after the time that leaves
                                               variable NAME other than 0
     vielto include FILE if NUMBER             include FILE unless NUMBER is 0; LIGGGHTS' `if` takes no include
     vielto property NAME GRAIN WALL           fix NAME all property/global NAME peratomtype GRAIN WALL, with GRAIN again for
                                               a third type (fixed grains)
     vielto pair_property NAME GRAIN WALL      the same for a peratomtypepair: of grain on grain and of grain on wall
     vielto law ...                            the rigs' contact law (law_command.h)
     vielto clump NAME FILE OUT diameter D density RHO
                                               read the spheres of FILE (clump.h), write them to OUT about their centre of mass
                                               and with the volume of a sphere of diameter D (m); set variable NAME to the words
                                               of particletemplate/multisphere for them (nspheres ... use_density), NAMERadius
                                               to the smallest radius (m), NAMESpheres to their number
     vielto mass NAME                          set variable NAME to the mass of all grains, kg; a clump counts once, where
                                               LIGGGHTS' mass(all) counts it for each of its spheres
     vielto place FILE N radii R1 R2 R3 density RHO seed S
                                               make N grains of type 1 at the first N places x_m,y_m,z_m of FILE: round(N/6) of
                                               the radii R1 and R3 each, the others R2, which is which by the seed. They are at
                                               rest. The numbers of the grains do not depend on the processors
     vielto grains FILE [KEY VALUE ...]        write x_m,y_m,z_m,radius_m of every grain of type 1, in the order of their
                                               numbers, under lines # KEY=VALUE */
// clang-format on
#ifdef COMMAND_CLASS
CommandStyle(vielto, ViEltoCommand)
#else
#ifndef LMP_VIELTO_COMMAND_H
#define LMP_VIELTO_COMMAND_H

#include <string>
#include <vector>

#include "pointers.h"

namespace LAMMPS_NS {

class ViEltoCommand : protected Pointers {
 public:
  explicit ViEltoCommand(class LAMMPS* lammps) : Pointers(lammps) {}
  void command(int narg, char** arg);

 private:
  void half_period(int narg, char** arg);
  void property(int narg, char** arg);
  void pair_property(int narg, char** arg);
  void clump(int narg, char** arg);
  void mass(int narg, char** arg);
  void set_variable(char* name, const char* value);
  void refuse(const std::string& line);
  void stop_if(const std::string& faultOnRankZero);
  void place(int narg, char** arg);
  void grains(int narg, char** arg);
  void setup(int narg, char** arg);
  void repeat(int narg, char** arg);
  void include(int narg, char** arg);
  double value_of(std::string name);
  void share(std::vector<std::string>& texts);
  void close(int narg, char** arg);
};

}  // namespace LAMMPS_NS
#endif
#endif

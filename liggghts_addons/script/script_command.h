// SPDX-License-Identifier: GPL-2.0-or-later
/* Script command `vielto`, for what an input script cannot say in LIGGGHTS' own words:

     vielto error TEXT...                      stop the run with this line (exit status 1)
     vielto half_period NAME radius R density RHO
                                               set variable NAME to the shortest half period of a contact, s, for grains
   of this radius (m) and density (kg/m3); needs the pair_style line and properties vielto shell COMMAND... run a
   program; stop if it fails (LIGGGHTS' own shell does not look) vielto prime NAME K                       set variable
   NAME to the K-th prime over 10000, as LIGGGHTS wants its seeds vielto words NAME W1 W2 ...               set variable
   NAME to these words (quoted text is not substituted by LIGGGHTS) vielto property NAME GRAIN WALL           fix NAME
   all property/global NAME peratomtype GRAIN WALL, with GRAIN again for a third type (fixed grains) vielto
   pair_property NAME GRAIN WALL      the same for a peratomtypepair: of grain on grain and of grain on wall
     vielto law ...                            the rigs' contact law (law_command.h)
     vielto check FILE [needs N1 N2 ...]       stop if the parameter file cannot be read, lacks one of these numbers, or
   if one of its parameters (or wall_PARAMETER) has been given a value of another kind: no number where it states one,
   none of the words its unit field allows (A, B or C) vielto provisional NAME F1 F2 ...         set variable NAME to 1
   if a card's first line calls it provisional, else to 0 vielto clump NAME FILE OUT diameter D density RHO read the
   spheres of FILE (vielto_clump.h), write them to OUT about their centre of mass and with the volume of a sphere of
   diameter D (m); set variable NAME to the words of particletemplate/multisphere for them (nspheres ... use_density),
   NAMERadius to the smallest radius (m), NAMESpheres to their number vielto grains FILE [KEY VALUE ...]        write
   x_m,y_m,z_m,radius_m of every grain of type 1, in the order of their numbers, under lines # KEY=VALUE vielto open
   FOLDER parameters F1 F2 ... inputs G1 G2 ... make FOLDER.partial with run.json: the present values of all parameters
   stated in the files F (and wall_PARAMETER), hashes of all files F and G, versions, command line; a -var that is none
   of these parameters stops the run vielto resume FOLDER NAME                 take up FOLDER.partial, broken off
   earlier with the same parameters: set variable NAME to its last restart file (restart/STEP.restart) vielto bed FOLDER
   TAKEN NAME P1 P2 ...    set variable TAKEN to 0 if FOLDER is none; else to 1 and variable NAME to FOLDER/bed.restart,
                                               the bed of a complete run with the same parameters but for P1 P2 ...
     vielto close FOLDER                       mark run.json complete, keep the last restart file only and rename
                                               FOLDER.partial to FOLDER */
#ifdef COMMAND_CLASS
CommandStyle(vielto, ViEltoCommand)
#else
#ifndef LMP_VIELTO_COMMAND_H
#define LMP_VIELTO_COMMAND_H

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "pointers.h"

namespace LAMMPS_NS {

class ViEltoCommand : protected Pointers {
 public:
  explicit ViEltoCommand(class LAMMPS* lammps) : Pointers(lammps) {}
  void command(int narg, char** arg);

 private:
  void half_period(int narg, char** arg);
  void shell(int narg, char** arg);
  void prime(int narg, char** arg);
  void property(int narg, char** arg);
  void pair_property(int narg, char** arg);
  void check(int narg, char** arg);
  void provisional(int narg, char** arg);
  void clump(int narg, char** arg);
  void set_variable(char* name, const char* value);
  void stop_if(const std::string& faultOnRankZero);
  void grains(int narg, char** arg);
  void open(int narg, char** arg);
  void resume(int narg, char** arg);
  void bed(int narg, char** arg);
  void same_parameters(const nlohmann::json& run, const std::set<std::string>& apart);
  void share_variable(char* name, std::string text);
  void close(int narg, char** arg);
};

}  // namespace LAMMPS_NS
#endif
#endif

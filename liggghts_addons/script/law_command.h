// SPDX-License-Identifier: GPL-2.0-or-later
/* Script command `vielto law`: the contact law of a rig from its description (engine/law.h).

     vielto law                    for the variables law and cohesion: sets the parameters that only one law has where
                                   -var has not, checks them, and sets the variables models (words of pair_style and
                                   wall/gran), settings, cohesive (1 or 0) and lawTakesClumps (1 or 0)
     vielto law properties         refuses what the law has no counterpart of; the cards' values as its properties.
   Needs a box, and the cards' parameters as variables vielto law friction G W       the property of sliding friction
   anew, with these angles of grain and wall, deg */
#ifndef VIELTO_LAW_COMMAND_H
#define VIELTO_LAW_COMMAND_H

#include <string>

#include "engine/law.h"
#include "pointers.h"

namespace vielto {

class LawCommand : protected LAMMPS_NS::Pointers {
 public:
  explicit LawCommand(LAMMPS_NS::LAMMPS* program) : LAMMPS_NS::Pointers(program) {}
  void command(int narg, char** arg);

 private:
  void choose();
  void properties();
  void friction(const std::string& grain, const std::string& wall);

  const Law& chosen();
  void set_parameters();
  void check_parameter(const LawParameter& parameter);
  void check_cohesion(const Law& law, const std::string& cohesion);
  void check_lacks(const Law& law);
  void refuse_unless(const Law& law, const std::string& name, const std::string& value);
  void make(const LawProperty& property, const std::string& grain, const std::string& wall);
  std::string filled(const std::string& text);
  std::string value_of(const std::string& formula);
  const char* variable(const std::string& name);
  void set(const std::string& name, const std::string& value);
  void run(const std::string& line);
  void stop(const std::string& line);
};

}  // namespace vielto

#endif

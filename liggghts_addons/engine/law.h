// SPDX-License-Identifier: GPL-2.0-or-later
/* A contact law in one place: what everything else that knows a law by name reads. plugin/laws/NAME.cpp holds one law's
   description beside its registration with LIGGGHTS; from it follow `-var law NAME` in the rigs and its refusals
   (script/law_command.h), the time step check (critical_time.h), whether energy accounts can be kept, and the
   reference page (`vielto_laws`).

   Formulas are written in LIGGGHTS' language of variables, of the rigs' parameters: the cards' values under their own
   names (the wall's with wall_ before it) and the settings of cases/law.par. */
#ifndef VIELTO_LAW_DESCRIPTION_H
#define VIELTO_LAW_DESCRIPTION_H

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "vielto_properties.h"

namespace vielto {

// Shortest half period, s, of a contact of types i and j, radii R (m) and masses m (kg); m2 is infinite for a wall.
typedef std::function<double(int i, int j, double R1, double m1, double R2, double m2)> HalfPeriod;

// A property as LIGGGHTS knows it, and its value from the cards.
struct LawProperty {
  enum Form { PER_TYPE, PER_PAIR, SCALAR };
  PropertyRule rule;
  Form form;
  std::string grain;  // formula for the grain; PER_PAIR: for grain on grain
  std::string wall;   // formula for the wall; PER_PAIR: for grain on wall; SCALAR: none
};

// A parameter of the rigs which only this law has: given with -var NAME VALUE.
struct LawParameter {
  PropertyRule rule;  // a unit with " or " in it lists words instead of a range
  std::string value, uncertainty, source;
};

struct Law {
  std::string name;     // -var law NAME; no enum: which laws there are is which files are linked in (CMakeLists.txt)
  std::string summary;  // one sentence
  std::string source;   // where it comes from
  std::string header;   // where its equations stand
  std::string yade;     // its counterpart in Yade

  // the words of pair_style and wall/gran; empty: no such model
  int id = 0;  // of the normal model
  std::string normal, tangential, rolling;
  std::vector<std::string> cohesions;                         // those that it takes, besides off
  std::string cohesionAdvice;                                 // what to do instead of another one
  std::vector<std::pair<std::string, std::string>> settings;  // keyword and formula

  std::vector<LawParameter> parameters;
  std::vector<std::pair<std::string, std::string>> steps;  // intermediate values: name and formula
  std::vector<LawProperty> properties;
  std::string friction;               // the property that holds the sliding friction
  std::vector<std::string> commands;  // of LIGGGHTS, before the properties

  /* What it has no counterpart of, among the parameters of cards and rigs: NAME (refused if given with -var) or
     NAME=VALUE (refused with any other value); wall_NAME likewise. */
  std::vector<std::string> lacks;
  // Other input that it refuses: a condition and the line to print, both after substitution.
  std::vector<std::pair<std::string, std::string>> refusals;
  std::vector<std::string> differs;  // what else is not as in ViElTo

  std::vector<std::string> energies;                          // kept in the energy accounts; empty: it keeps none
  bool clumps = false;                                        // tested with fix multisphere
  std::string timeScale;                                      // what bounds the time step, in words
  std::function<HalfPeriod(LAMMPS_NS::LAMMPS*)> half_period;  // reads the properties that are there
};

// "(0, 0.1]", as a reader writes it.
std::string range_of(const PropertyRule& rule);

// The words of pair_style that a law goes with: "model NAME tangential ... [cohesion A, B] ...".
std::string models_of(const Law& law);

// All laws, in the order in which liggghts_addons/CMakeLists.txt names them.
const std::vector<Law>& laws();
// By name, or by the id of its normal model; NULL if there is none.
const Law* find_law(const std::string& name);
const Law* find_law(int id);
// "vielto, cohfrict or hertz"
std::string law_names();
// That of the last pair_style. Stops the run with one line if it is none of ours; `who` asks.
const Law& law_in_use(LAMMPS_NS::LAMMPS* lmp, const char* who);

}  // namespace vielto

#endif

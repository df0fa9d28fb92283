// SPDX-License-Identifier: GPL-2.0-or-later
#include "plugin/registration.h"

// clang-format off
// fix_insert_stream.h has to precede pair_gran_base.h: that header uses a class which it only declares
#include <mpi.h>
#include <stdio.h>
#include <map>
#include <string>
#include "lammps.h"
#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "input.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"
#include "fix_insert_stream.h"
#include "contact_models.h"
#include "pair_gran_base.h"
#include "fix_wall_gran_base.h"
#include "fixes/fix_vielto_drag.h"
#include "fixes/fix_vielto_plate.h"
#include "fixes/fix_vielto_record.h"
#include "fixes/fix_vielto_shear.h"
#include "engine/wall_loop.h"
#include "script/script_command.h"
#include "engine/private_access.h"
#include "engine/law.h"
// clang-format on

using namespace LAMMPS_NS;
using namespace LIGGGHTS;
using namespace LIGGGHTS::ContactModels;

namespace vielto {

namespace {
struct FixTable {
  typedef std::map<std::string, Fix* (*)(LAMMPS*, int, char**)>* Modify::*type;
};
struct CommandTable {
  typedef std::map<std::string, void (*)(LAMMPS*, int, char**)>* Input::*type;
};
}  // namespace

// see vielto_open.h
template struct Opened<FixTable, &Modify::fix_map>;
template struct Opened<CommandTable, &Input::command_map>;

namespace {

template <class Style>
Fix* make_fix(LAMMPS* lmp, int narg, char** arg) {
  return new Style(lmp, narg, arg);
}

Fix* (*stock_wall)(LAMMPS*, int, char**) = NULL;

// Our wall loop for the laws of this package; a wall of another law stays LIGGGHTS' own.
Fix* make_wall_fix(LAMMPS* lmp, int narg, char** arg) {
  for (int k = 3; k + 1 < narg; k++)
    for (const Law& law : laws())
      if (std::string(arg[k]) == "model" && arg[k + 1] == law.normal) return new FixViEltoWall(lmp, narg, arg);
  return stock_wall(lmp, narg, arg);
}

void run_command(LAMMPS* lmp, int narg, char** arg) {
  ViEltoCommand command(lmp);
  command.command(narg, arg);
}

}  // namespace

void install(LAMMPS* lmp) {
  auto& fixes = *(lmp->modify->*Handed<FixTable>::pointer);
  fixes["vielto/record"] = &make_fix<FixViEltoRecord>;
  fixes["vielto/plate"] = &make_fix<FixViEltoPlate>;
  fixes["vielto/shear"] = &make_fix<FixViEltoShear>;
  fixes["vielto/drag"] = &make_fix<FixViEltoDrag>;
  fixes["vielto/watch"] = &make_fix<FixViEltoWatch>;
  if (!stock_wall) stock_wall = fixes["wall/gran"];
  fixes["wall/gran"] = &make_wall_fix;
  (*(lmp->input->*Handed<CommandTable>::pointer))["vielto"] = &run_command;
}

namespace {

// The models that several laws share; each law registers its own (law_registration.h).
struct Registration {
  Registration() {
    // LIGGGHTS prints an error and calls MPI_Abort, which loses what stands in the buffer of a pipe or file
    setvbuf(stdout, NULL, _IOLBF, 0);
    ContactModels::Factory& models = ContactModels::Factory::instance();
    models.addTangentialModel("vielto", TANGENTIAL_VIELTO);
    models.addRollingModel("vielto", ROLLING_VIELTO);
    models.addCohesionModel("adhesion", COHESION_ADHESION);
  }
};

const Registration registration;

}  // namespace
}  // namespace vielto

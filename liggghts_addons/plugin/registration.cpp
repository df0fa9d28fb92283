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
#include "engine/grain_motion.h"
#include "engine/mesh_motion.h"
#include "engine/wall_loop.h"
#include "script/script_command.h"
#include "engine/private_access.h"
#include "engine/law.h"
#include "vielto_stop.h"
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
template <class Interface>
struct Combinations {
  typedef Interface* (*Creator)(LAMMPS*, typename Interface::ParentType*, int64_t);
  typedef std::map<std::pair<std::string, int>, Creator> Utils::AbstractFactory<Interface>::*type;
};
typedef Combinations<PairStyles::IGranularPairStyle> PairCombinations;
typedef Combinations<Walls::IGranularWall> WallCombinations;
}  // namespace

// see vielto_open.h
template struct Opened<FixTable, &Modify::fix_map>;
template struct Opened<CommandTable, &Input::command_map>;
template struct Opened<PairCombinations, &Utils::AbstractFactory<PairStyles::IGranularPairStyle>::styleTable>;
template struct Opened<WallCombinations, &Utils::AbstractFactory<Walls::IGranularWall>::styleTable>;

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

/* A combination that nobody registered goes to LIGGGHTS' general one, which says of any model of ours that it is
   unknown. The ids of a combination's models stand in its hash, 6 bits each. */
void refuse_strangers(LAMMPS* lmp, int64_t hash) {
  const auto id = [hash](int place) { return static_cast<int>(hash >> (6 * place) & 63); };
  const Law* const own = find_law(id(0));
  if (own)
    stop_all(lmp, ("vielto: " + own->normal + " does not take these partners; write '" + models_of(*own) +
                   "', in this order")
                      .c_str());
  const bool ours = id(1) == TANGENTIAL_VIELTO || id(2) == COHESION_ADHESION || id(3) == ROLLING_VIELTO;
  if (ours)
    stop_all(lmp, ("vielto: tangential vielto, rolling_friction vielto and cohesion adhesion go with a normal model of "
                   "this package only, as in '" +
                   models_of(laws().front()) + "'")
                      .c_str());
}

template <class Table, class Interface>
struct General {
  static typename Table::Creator stock;
  static Interface* make(LAMMPS* lmp, typename Interface::ParentType* parent, int64_t hash) {
    refuse_strangers(lmp, hash);
    return stock(lmp, parent, hash);
  }
  static void put_before(Utils::AbstractFactory<Interface>& factory) {
    typename Table::Creator& creator =
        (factory.*Handed<Table>::pointer)[{"gran", static_cast<int>(GranStyle<>::HASHCODE)}];
    if (!creator || creator == &make) return;
    stock = creator;
    creator = &make;
  }
};
template <class Table, class Interface>
typename Table::Creator General<Table, Interface>::stock;

}  // namespace

void install(LAMMPS* lmp) {
  General<PairCombinations, PairStyles::IGranularPairStyle>::put_before(PairStyles::Factory::instance());
  General<WallCombinations, Walls::IGranularWall>::put_before(Walls::Factory::instance());
  auto& fixes = *(lmp->modify->*Handed<FixTable>::pointer);
  fixes["vielto/record"] = &make_fix<FixViEltoRecord>;
  fixes["vielto/plate"] = &make_fix<FixViEltoPlate>;
  fixes["vielto/shear"] = &make_fix<FixViEltoShear>;
  fixes["vielto/drag"] = &make_fix<FixViEltoDrag>;
  fixes["vielto/watch"] = &make_fix<FixViEltoWatch>;
  if (!stock_wall) stock_wall = fixes["wall/gran"];
  fixes["wall/gran"] = &make_wall_fix;
  fixes["nve/sphere"] = &make_fix<FixViEltoIntegrate>;
  fixes["gravity"] = &make_fix<FixViEltoGravity>;
  fixes["move/mesh"] = &make_fix<FixViEltoMoveMesh>;
  fixes["mesh/surface/stress"] = &make_fix<FixViEltoMesh>;
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

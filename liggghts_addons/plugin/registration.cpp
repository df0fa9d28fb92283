// SPDX-License-Identifier: GPL-2.0-or-later
#include "plugin/registration.h"

// clang-format off
// fix_insert_stream.h has to precede pair_gran_base.h: that header uses a class which it only declares
#include <mpi.h>
#include <stdio.h>
#include <map>
#include <set>
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
#include "engine/pair_loop.h"
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
  const std::set<std::string> ours = {"vielto", "cohfrict", "hertz/watched", "hooke/watched"};
  for (int k = 3; k + 1 < narg; k++)
    if (std::string(arg[k]) == "model" && ours.count(arg[k + 1])) return new FixViEltoWall(lmp, narg, arg);
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

template <int Cohesion, int Rolling>
using ViElToStyle = GranStyle<VIELTO, TANGENTIAL_VIELTO, Cohesion, Rolling, SURFACE_DEFAULT>;
template <int Normal, int Cohesion>
using StockStyle = GranStyle<Normal, TANGENTIAL_HISTORY, Cohesion, ROLLING_EPSD2, SURFACE_DEFAULT>;

// Styles with cohesion in contact only take our pair loop, which needs the model of LIGGGHTS' own.
#define VIELTO_TOUCHING(NAME, ...) \
  using NAME = __VA_ARGS__;        \
  template struct Opened<ModelOfPair<NAME>, &PairStyles::Granular<ContactModel<NAME>>::cmodel>;
VIELTO_TOUCHING(Plain, ViElToStyle<COHESION_OFF, ROLLING_OFF>)
VIELTO_TOUCHING(PlainRolling, ViElToStyle<COHESION_OFF, ROLLING_VIELTO>)
VIELTO_TOUCHING(Adhesion, ViElToStyle<COHESION_ADHESION, ROLLING_OFF>)
VIELTO_TOUCHING(AdhesionRolling, ViElToStyle<COHESION_ADHESION, ROLLING_VIELTO>)
VIELTO_TOUCHING(Sjkr, ViElToStyle<COHESION_SJKR, ROLLING_OFF>)
VIELTO_TOUCHING(SjkrRolling, ViElToStyle<COHESION_SJKR, ROLLING_VIELTO>)
VIELTO_TOUCHING(Sjkr2, ViElToStyle<COHESION_SJKR2, ROLLING_OFF>)
VIELTO_TOUCHING(Sjkr2Rolling, ViElToStyle<COHESION_SJKR2, ROLLING_VIELTO>)
VIELTO_TOUCHING(Hertz, StockStyle<HERTZ_WATCHED, COHESION_OFF>)
VIELTO_TOUCHING(HertzSjkr, StockStyle<HERTZ_WATCHED, COHESION_SJKR>)
VIELTO_TOUCHING(HertzSjkr2, StockStyle<HERTZ_WATCHED, COHESION_SJKR2>)
VIELTO_TOUCHING(Hooke, StockStyle<HOOKE_WATCHED, COHESION_OFF>)
VIELTO_TOUCHING(HookeSjkr, StockStyle<HOOKE_WATCHED, COHESION_SJKR>)
VIELTO_TOUCHING(HookeSjkr2, StockStyle<HOOKE_WATCHED, COHESION_SJKR2>)
#undef VIELTO_TOUCHING

namespace {

template <class PairStyle>
PairStyles::IGranularPairStyle* make_pair(LAMMPS* lmp, PairGran* parent, int64_t hash) {
  install(lmp);
  return new PairStyle(lmp, parent, hash);
}

template <class Style>
Walls::IGranularWall* make_wall(LAMMPS* lmp, FixWallGran* parent, int64_t hash) {
  install(lmp);
  return new Walls::Granular<ContactModel<Style>>(lmp, parent, hash);
}

template <class Style, class PairStyle>
void add_combination() {
  PairStyles::Factory::instance().addStyle("gran", static_cast<int>(Style::HASHCODE), &make_pair<PairStyle>);
  Walls::Factory::instance().addStyle("gran", static_cast<int>(Style::HASHCODE), &make_wall<Style>);
}

template <class Style>
void add_touching() {
  add_combination<Style, FastPair<Style>>();
}

template <class Style>
void add_bridging() {
  add_combination<Style, PairStyles::Granular<ContactModel<Style>>>();
}

struct Registration {
  Registration() {
    // LIGGGHTS prints an error and calls MPI_Abort, which loses what stands in the buffer of a pipe or file
    setvbuf(stdout, NULL, _IOLBF, 0);
    ContactModels::Factory& models = ContactModels::Factory::instance();
    models.addNormalModel("vielto", VIELTO);
    models.addTangentialModel("vielto", TANGENTIAL_VIELTO);
    models.addRollingModel("vielto", ROLLING_VIELTO);
    models.addNormalModel("cohfrict", COHFRICT);
    models.addCohesionModel("adhesion", COHESION_ADHESION);
    add_touching<Plain>();
    add_touching<PlainRolling>();
    add_touching<Adhesion>();
    add_touching<AdhesionRolling>();
    add_touching<Sjkr>();
    add_touching<SjkrRolling>();
    add_touching<Sjkr2>();
    add_touching<Sjkr2Rolling>();
    models.addNormalModel("hertz/watched", HERTZ_WATCHED);
    models.addNormalModel("hooke/watched", HOOKE_WATCHED);
    add_touching<Hertz>();
    add_touching<HertzSjkr>();
    add_touching<HertzSjkr2>();
    add_touching<Hooke>();
    add_touching<HookeSjkr>();
    add_touching<HookeSjkr2>();
    // a capillary bridge and a stretched bond pull beyond contact and need LIGGGHTS' own loop
    add_bridging<ViElToStyle<COHESION_EASO_CAPILLARY_VISCOUS, ROLLING_OFF>>();
    add_bridging<ViElToStyle<COHESION_EASO_CAPILLARY_VISCOUS, ROLLING_VIELTO>>();
    add_bridging<ViElToStyle<COHESION_WASHINO_CAPILLARY_VISCOUS, ROLLING_OFF>>();
    add_bridging<ViElToStyle<COHESION_WASHINO_CAPILLARY_VISCOUS, ROLLING_VIELTO>>();
    add_bridging<GranStyle<COHFRICT, TANGENTIAL_OFF, COHESION_OFF, ROLLING_OFF, SURFACE_DEFAULT>>();
  }
};

const Registration registration;

}  // namespace
}  // namespace vielto

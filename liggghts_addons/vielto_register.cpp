// SPDX-License-Identifier: GPL-2.0-or-later
#include "vielto_register.h"

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
#include "fix_vielto_plate.h"
#include "fix_vielto_record.h"
#include "fix_vielto_shear.h"
#include "vielto_command.h"
// clang-format on

using namespace LAMMPS_NS;
using namespace LIGGGHTS;
using namespace LIGGGHTS::ContactModels;

namespace vielto {

namespace {

/* LIGGGHTS keeps the tables of its fix and command styles private and offers no function to add to them. An explicit
   instantiation may name a private member; this hands out pointers to the two tables. */
template <class Table, typename Table::type Member>
struct Opened {
  friend typename Table::type member(Table) { return Member; }
};

struct FixTable {
  typedef std::map<std::string, Fix* (*)(LAMMPS*, int, char**)>* Modify::*type;
  friend type member(FixTable);
};
template struct Opened<FixTable, &Modify::fix_map>;

struct CommandTable {
  typedef std::map<std::string, void (*)(LAMMPS*, int, char**)>* Input::*type;
  friend type member(CommandTable);
};
template struct Opened<CommandTable, &Input::command_map>;

template <class Style>
Fix* make_fix(LAMMPS* lmp, int narg, char** arg) {
  return new Style(lmp, narg, arg);
}

void run_command(LAMMPS* lmp, int narg, char** arg) {
  ViEltoCommand command(lmp);
  command.command(narg, arg);
}

}  // namespace

void install(LAMMPS* lmp) {
  std::map<std::string, Fix* (*)(LAMMPS*, int, char**)>& fixes = *(lmp->modify->*member(FixTable()));
  fixes["vielto/record"] = &make_fix<FixViEltoRecord>;
  fixes["vielto/plate"] = &make_fix<FixViEltoPlate>;
  fixes["vielto/shear"] = &make_fix<FixViEltoShear>;
  (*(lmp->input->*member(CommandTable())))["vielto"] = &run_command;
}

namespace {

template <class Style>
PairStyles::IGranularPairStyle* make_pair(LAMMPS* lmp, PairGran* parent, int64_t hash) {
  install(lmp);
  return new PairStyles::Granular<ContactModel<Style>>(lmp, parent, hash);
}

template <class Style>
Walls::IGranularWall* make_wall(LAMMPS* lmp, FixWallGran* parent, int64_t hash) {
  install(lmp);
  return new Walls::Granular<ContactModel<Style>>(lmp, parent, hash);
}

template <int Cohesion, int Rolling>
void add_combination() {
  typedef GranStyle<VIELTO, TANGENTIAL_VIELTO, Cohesion, Rolling, SURFACE_DEFAULT> Style;
  PairStyles::Factory::instance().addStyle("gran", static_cast<int>(Style::HASHCODE), &make_pair<Style>);
  Walls::Factory::instance().addStyle("gran", static_cast<int>(Style::HASHCODE), &make_wall<Style>);
}

template <int Cohesion>
void add_rolling_combinations() {
  add_combination<Cohesion, ROLLING_OFF>();
  add_combination<Cohesion, ROLLING_VIELTO>();
}

struct Registration {
  Registration() {
    // LIGGGHTS prints an error and calls MPI_Abort, which loses what stands in the buffer of a pipe or file
    setvbuf(stdout, NULL, _IOLBF, 0);
    ContactModels::Factory& models = ContactModels::Factory::instance();
    models.addNormalModel("vielto", VIELTO);
    models.addTangentialModel("vielto", TANGENTIAL_VIELTO);
    models.addRollingModel("vielto", ROLLING_VIELTO);
    add_rolling_combinations<COHESION_OFF>();
    add_rolling_combinations<COHESION_SJKR>();
    add_rolling_combinations<COHESION_SJKR2>();
    add_rolling_combinations<COHESION_EASO_CAPILLARY_VISCOUS>();
    add_rolling_combinations<COHESION_WASHINO_CAPILLARY_VISCOUS>();
  }
};

const Registration registration;

}  // namespace
}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
/* How a law's combinations of contact models enter LIGGGHTS' registries when the library is loaded; for plugin/laws/.

     namespace vielto {
     VIELTO_TOUCHING(Plain, NORMAL, TANGENTIAL, COHESION, ROLLING)   // a combination with our pair loop
     namespace {
     const LawRegistration registration(describe_NAME(), [] {
       add_touching<Plain>();
       add_bridging<Models<...>>();   // one that pulls beyond contact and needs LIGGGHTS' own loop
     });
     }} */
#ifndef VIELTO_LAW_REGISTRATION_H
#define VIELTO_LAW_REGISTRATION_H

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
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"
#include "fix_insert_stream.h"
#include "contact_models.h"
#include "pair_gran_base.h"
#include "fix_wall_gran_base.h"
#include "engine/law.h"
#include "engine/pair_loop.h"
#include "engine/private_access.h"
#include "plugin/registration.h"
// clang-format on

namespace vielto {

using namespace LIGGGHTS::ContactModels;

template <int Normal, int Tangential = TANGENTIAL_OFF, int Cohesion = COHESION_OFF, int Rolling = ROLLING_OFF>
using Models = GranStyle<Normal, Tangential, Cohesion, Rolling, SURFACE_DEFAULT>;

// A combination whose forces end with the contact takes our pair loop, which needs the model of LIGGGHTS' own.
#define VIELTO_TOUCHING(NAME, ...)  \
  using NAME = Models<__VA_ARGS__>; \
  VIELTO_OPEN_MODELS(NAME)

template <class PairStyle>
LIGGGHTS::PairStyles::IGranularPairStyle* make_pair(LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::PairGran* parent, int64_t hash) {
  install(lmp);
  return new PairStyle(lmp, parent, hash);
}

template <class Style>
LIGGGHTS::Walls::IGranularWall* make_wall(LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::FixWallGran* parent, int64_t hash) {
  install(lmp);
  return new_wall<Style>(lmp, parent, hash);
}

template <class Style, class PairStyle>
void add_combination() {
  const int hash = static_cast<int>(Style::HASHCODE);
  LIGGGHTS::PairStyles::Factory::instance().addStyle("gran", hash, &make_pair<PairStyle>);
  LIGGGHTS::Walls::Factory::instance().addStyle("gran", hash, &make_wall<Style>);
}

template <class Style>
void add_touching() {
  add_combination<Style, FastPair<Style>>();
}

template <class Style>
void add_bridging() {
  add_combination<Style, LIGGGHTS::PairStyles::Granular<ContactModel<Style>>>();
}

struct LawRegistration {
  LawRegistration(const Law& law, void (*add_combinations)()) {
    LIGGGHTS::ContactModels::Factory::instance().addNormalModel(law.normal, law.id);
    add_combinations();
  }
};

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// liggghts for the benchmark: ViElTo and the stock law with the same ingredients, instantiated in one program with the
// same flags, each with clocks around its pair loop and its wall loop. After its script it obeys the lines on its
// standard input, `run N` (answers with one line `TIMED {...}`) and `quit`, so that two of them can take turns.
// clang-format off
#include <mpi.h>
#include <x86intrin.h>
#include <stdio.h>
#include <unistd.h>
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
#include "global_properties.h"
#include "fix_mesh_surface.h"
#include "contact_models.h"
#include "pair_gran_base.h"
#include "fix_wall_gran_base.h"
#include "engine/wall_loop.h"
#include "engine/private_access.h"
#include "engine/pair_loop.h"
#include "plugin/registration.h"
// clang-format on

using namespace LAMMPS_NS;
using namespace LIGGGHTS;
using namespace LIGGGHTS::ContactModels;

namespace {
struct FixTable {
  typedef std::map<std::string, Fix* (*)(LAMMPS*, int, char**)>* Modify::*type;
};
}  // namespace
template struct vielto::Opened<FixTable, &Modify::fix_map>;  // see vielto_open.h

namespace {

struct Clocks {
  unsigned long long pairTicks, wallTicks;
  double pairContacts, wallContacts;  // sums over samples; a wall's are those with meshes
  long steps, pairSamples;
};
Clocks clocks = {};
bool counting = false;  // from the first `run N` on

// Both laws pay the same for the clocks; the contacts are counted outside them.
template <class PairStyle>
class TimedPair : public PairStyle {
 public:
  TimedPair(LAMMPS* lmp, PairGran* parent, int64_t hash) : PairStyle(lmp, parent, hash), atom_(lmp->atom) {}

  void compute_force(PairGran* pg, int eflag, int vflag, int addflag) override {
    const unsigned long long start = __rdtsc();
    PairStyle::compute_force(pg, eflag, vflag, addflag);
    if (!counting) return;
    clocks.pairTicks += __rdtsc() - start;
    clocks.steps++;
    if (clocks.steps % 50 == 1) clocks.pairSamples++, clocks.pairContacts += contacts(pg);
  }

 private:
  int contacts(PairGran* pg) const {
    int n = 0;
    for (int ii = 0; ii < pg->list->inum; ii++) {
      const int i = pg->list->ilist[ii];
      for (int jj = 0; jj < pg->list->numneigh[i]; jj++) {
        const int j = pg->list->firstneigh[i][jj] & NEIGHMASK;
        double rsq = 0;
        for (int d = 0; d < 3; d++) rsq += (atom_->x[i][d] - atom_->x[j][d]) * (atom_->x[i][d] - atom_->x[j][d]);
        const double sum = atom_->radius[i] + atom_->radius[j];
        n += rsq < sum * sum;
      }
    }
    return n;
  }
  Atom* atom_;
};

// The whole wall loop, with LIGGGHTS' search for the nearest point of a triangle and its books of contacts.
template <class Wall>
class TimedWall : public Wall {
 public:
  TimedWall(LAMMPS* lmp, int narg, char** arg) : Wall(lmp, narg, arg) {}

  void post_force(int vflag) override {
    const unsigned long long start = __rdtsc();
    Wall::post_force(vflag);
    if (!counting) return;
    clocks.wallTicks += __rdtsc() - start;
    int touching = 0;
    if (clocks.steps % 50 == 1 && this->is_mesh_wall())
      this->n_contacts_local(touching), clocks.wallContacts += touching;
  }
};

Fix* make_wall_fix(LAMMPS* lmp, int narg, char** arg) {
  for (int k = 3; k + 1 < narg; k++)
    if (std::string(arg[k]) == "model" && std::string(arg[k + 1]) == "vielto")
      return new TimedWall<FixViEltoWall>(lmp, narg, arg);
  return new TimedWall<FixWallGran>(lmp, narg, arg);
}

// LIGGGHTS' own integrator, gravity and meshes for the stock law, as in the stock program.
typedef Fix* (*FixMaker)(LAMMPS*, int, char**);
const char* const motions[4] = {"nve/sphere", "gravity", "move/mesh", "mesh/surface/stress"};
FixMaker ours[4], stock[4];

template <int Which>
Fix* make_motion(LAMMPS* lmp, int narg, char** arg) {
  return (vielto::settings().law ? ours : stock)[Which](lmp, narg, arg);
}

template <class PairStyle>
PairStyles::IGranularPairStyle* make_pair(LAMMPS* lmp, PairGran* parent, int64_t hash) {
  return new TimedPair<PairStyle>(lmp, parent, hash);
}

template <class Style>
Walls::IGranularWall* make_wall(LAMMPS* lmp, FixWallGran* parent, int64_t hash) {
  return vielto::new_wall<Style>(lmp, parent, hash);
}

// The registries warn about each replacement on standard error; here it is wanted.
template <class Style, class PairStyle>
void replace() {
  PairStyles::Factory::instance().addStyle("gran", static_cast<int>(Style::HASHCODE), &make_pair<PairStyle>);
  Walls::Factory::instance().addStyle("gran", static_cast<int>(Style::HASHCODE), &make_wall<Style>);
}

// Steps, and tells the time they took and the part of it that the law took.
void timed_run(LAMMPS& lammps, const char* steps) {
  clocks = Clocks();
  counting = true;
  char command[100];
  snprintf(command, sizeof command, "run %s pre no post no", steps);
  const unsigned long long ticks = __rdtsc();
  const double begin = MPI_Wtime();
  lammps.input->one(command);
  const double seconds = MPI_Wtime() - begin;
  const double tick = seconds / static_cast<double>(__rdtsc() - ticks);
  counting = false;
  if (lammps.comm->me != 0) return;
  printf(
      "TIMED {\"steps\": %ld, \"grains\": %.0f, \"run_s\": %.6g, \"pair_s\": %.6g, \"wall_s\": %.6g, "
      "\"pair_contacts\": %.6g, \"wall_contacts\": %.6g}\n",
      clocks.steps, static_cast<double>(lammps.atom->natoms), seconds, tick * static_cast<double>(clocks.pairTicks),
      tick * static_cast<double>(clocks.wallTicks), clocks.pairContacts / static_cast<double>(clocks.pairSamples),
      clocks.wallContacts / static_cast<double>(clocks.pairSamples));
  fflush(stdout);
}

// The next line of standard input on every rank; false at `quit` or at the end.
bool next_steps(const LAMMPS& lammps, char (&steps)[50]) {
  int have = 0;
  if (lammps.comm->me == 0) have = scanf(" run %49s", steps) == 1;
  // a rank that waits in MPI_Bcast keeps its core busy, which another program of the benchmark is being timed on
  MPI_Request request;
  MPI_Ibcast(&have, 1, MPI_INT, 0, lammps.world, &request);
  for (int done = 0; !done; usleep(200)) MPI_Test(&request, &done, MPI_STATUS_IGNORE);
  MPI_Bcast(steps, sizeof steps, MPI_CHAR, 0, lammps.world);
  MPI_Barrier(lammps.world);
  return have != 0;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  {
    LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    auto& fixes = *(lammps.modify->*vielto::Handed<FixTable>::pointer);
    for (int k = 0; k < 4; k++) stock[k] = fixes[k < 3 ? motions[k] : "mesh/surface"];  // stress is a module there
    vielto::install(&lammps);
    for (int k = 0; k < 4; k++) ours[k] = fixes[motions[k]];
    fixes[motions[0]] = &make_motion<0>;
    fixes[motions[1]] = &make_motion<1>;
    fixes[motions[2]] = &make_motion<2>;
    fixes[motions[3]] = &make_motion<3>;
    fixes["wall/gran"] = &make_wall_fix;
    // after LIGGGHTS has registered its own, which would replace ours
    using Ours = GranStyle<VIELTO, TANGENTIAL_VIELTO, COHESION_OFF, ROLLING_VIELTO, SURFACE_DEFAULT>;
    using Stock = GranStyle<HOOKE_STIFFNESS, TANGENTIAL_HISTORY, COHESION_OFF, ROLLING_EPSD2, SURFACE_DEFAULT>;
    // without rolling, for the comparison with Yade
    using Plain = GranStyle<VIELTO, TANGENTIAL_VIELTO, COHESION_OFF, ROLLING_OFF, SURFACE_DEFAULT>;
    replace<Ours, vielto::FastPair<Ours>>();
    replace<Plain, vielto::FastPair<Plain>>();
    replace<Stock, PairStyles::Granular<ContactModel<Stock>>>();
    lammps.input->file();
    if (lammps.comm->me == 0) printf("READY\n"), fflush(stdout);
    char steps[50] = "";
    while (next_steps(lammps, steps)) timed_run(lammps, steps);
  }
  MPI_Finalize();
  return 0;
}

// SPDX-License-Identifier: GPL-2.0-or-later
/* Pair loop for ViElTo behind LIGGGHTS' own registration.

   Purpose   The same forces, bit for bit, as LIGGGHTS' PairStyles::Granular, in less time. That loop prepares every
             neighbour as if it were a contact and resets the history of all that are not, which is half of the pair
             time of a loose bed; here a neighbour out of contact costs its distance and a look at its flag. Contacts of
   ViElTo are evaluated several at once (packed_law.h); those of other laws one by one, their data in registers because
   nothing takes their address, and so are ViElTo's in a step of energy accounts. Falls back to LIGGGHTS' loop where a
   feature is on that this one leaves out: virial, compute pair/gran/local, stored contact forces, multicontact radii,
   summed normal forces, predefined insertion, non-spherical grains. For       cohesion models without force at a
   distance. */
#ifndef VIELTO_PAIR_H
#define VIELTO_PAIR_H

#include <math.h>

#include <algorithm>

// clang-format off
#include "fix_insert_stream.h"
#include "pair_gran_base.h"
#include "engine/critical_time.h"
#include "engine/near_pairs.h"
#include "engine/packed_law.h"
#include "engine/packed_models.h"
#include "engine/private_access.h"
// clang-format on

// All of a contact in one function; with sanitizers in it that one would take a compiler a quarter of an hour.
#if defined(__SANITIZE_ADDRESS__)
#define VIELTO_FLATTEN
#else
#define VIELTO_FLATTEN __attribute__((flatten))
#endif

namespace vielto {

template <class Style>
class FastPair : public LIGGGHTS::PairStyles::Granular<LIGGGHTS::ContactModels::ContactModel<Style>> {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef LIGGGHTS::PairStyles::Granular<Model> General;
  typedef PackedModels<Style> Packed;

 public:
  FastPair(LAMMPS_NS::LAMMPS* program, LAMMPS_NS::PairGran* parent, int64_t hash)
      : General(program, parent, hash),
        program_(program),
        model_(this->*Handed<ModelOfPair<Style>>::pointer),
        packed_(Packed::packs ? packed_law(program) : NULL),
        nearPairs_(near_search(program)) {}

  void compute_force(LAMMPS_NS::PairGran* pg, int eflag, int vflag, int addflag) override {
    timeStep_.look(program_);
    const bool plain = !eflag && !vflag && !(pg->cpl() && addflag) && !pg->storeContactForces() &&
                       !pg->storeContactForcesStress() && !pg->storeSumDelta() && !pg->store_sum_normal_force() &&
                       pg->listgranhistory && program_->atom->rmass && program_->atom->sphere_flag &&
                       !program_->atom->shapetype_flag &&
                       program_->modify->n_fixes_style("insert/stream/predefined") == 0;
    if (!plain) {
      nearPairs_.forget();
      return General::compute_force(pg, eflag, vflag, addflag);
    }
    pg->evflag = pg->vflag_fdotr = 0;
    const bool step = pg->computeflag() && pg->shearupdate();
    if constexpr (Packed::packs)
      if (step && packed_ && !tally().energy) return packed_loop(pg);
    if (step)
      loop<true>(pg);
    else
      loop<false>(pg);
  }

 private:
  // Step: forces are wanted and the history goes on, as in every step of a run.
  template <bool Step>
  VIELTO_FLATTEN void loop(LAMMPS_NS::PairGran* pg) {
    using namespace LIGGGHTS::ContactModels;
    LAMMPS_NS::Atom* const grains = program_->atom;
    double* const* const v = grains->v;
    double* const* const omega = grains->omega;
    double* const* const f = grains->f;
    double* const* const torque = grains->torque;
    const double* const rmass = grains->rmass;
    const double* const body = pg->fr_pair() ? pg->mr_pair() : NULL;  // mass of the clump a grain belongs to
    const int* const type = grains->type;
    const int* const mask = grains->mask;
    const int frozen = pg->freeze_group_bit();
    const int owned = program_->force->newton_pair ? grains->nlocal + grains->nghost : grains->nlocal;

    SurfacesIntersectData c = SurfacesIntersectData();
    ForceData onI, onJ;
    c.is_wall = false;
    c.area_ratio = 1.0;
    c.computeflag = Step ? 1 : pg->computeflag();
    c.shearupdate = Step ? 1 : pg->shearupdate();

    const Touching& touching = find_touches(pg);
    const NearPair* const pairs = nearPairs_.pairs();
    const Place* const places = nearPairs_.places();
    for (std::size_t k = 0; k < touching.count; k++) {
      const NearPair& t = pairs[touching.pairs[k]];
      // LIGGGHTS keeps the three values of a grain after those of the one before
      const NearPair& ahead = pairs[touching.pairs[std::min(k + 8, touching.count - 1)]];
      for (const double* values : {v[0], omega[0], f[0], torque[0]})
        __builtin_prefetch(values + 3 * static_cast<std::size_t>(ahead.j));
      __builtin_prefetch(ahead.history, 1);
      __builtin_prefetch(ahead.history + 7, 1);
      const int i = t.i, j = t.j;
      c.i = i;
      c.j = j;
      c.itype = type[i];
      c.jtype = type[j];
      const Place &one = places[i], &two = places[j];
      c.delta[0] = one.x - two.x;
      c.delta[1] = one.y - two.y;
      c.delta[2] = one.z - two.z;
      c.rsq = c.delta[0] * c.delta[0] + c.delta[1] * c.delta[1] + c.delta[2] * c.delta[2];
      c.r = sqrt(c.rsq);
      c.rinv = 1.0 / c.r;
      c.en[0] = c.delta[0] * c.rinv;
      c.en[1] = c.delta[1] * c.rinv;
      c.en[2] = c.delta[2] * c.rinv;
      c.radi = one.radius;
      c.radj = two.radius;
      c.radsum = c.radi + c.radj;
      c.v_i = v[i];
      c.v_j = v[j];
      c.omega_i = omega[i];
      c.omega_j = omega[j];
      c.mi = body && body[i] > 0.0 ? body[i] : rmass[i];
      c.mj = body && body[j] > 0.0 ? body[j] : rmass[j];
      c.meff = c.mi * c.mj / (c.mi + c.mj);
      if (mask[i] & frozen) c.meff = c.mj;
      if (mask[j] & frozen) c.meff = c.mi;
      c.contact_flags = t.flags;
      c.contact_history = t.history;
      onI.reset();
      onJ.reset();
      model_.surfacesIntersect(c, onI, onJ);
      model_.endSurfacesIntersect(c, NULL, onI, onJ);
      if (!Step && !c.computeflag) continue;
      add(pg->relax(i), onI, f[i], torque[i]);
      if (j < owned) add(pg->relax(j), onJ, f[j], torque[j]);
    }
  }

  // A step of a run, several contacts at once. Without PairGran::relax, which LIGGGHTS 3.8 has no fix to set.
  void packed_loop(LAMMPS_NS::PairGran* pg) {
    const Touching& touching = find_touches(pg);
    const NearPair* const pairs = nearPairs_.pairs();
    PackedStep step = Packed::step(model_);
    step.dt = program_->update->dt;
    step.frozen = pg->freeze_group_bit() != 0;
    const PackedGrains grains = packed_grains(pg);
    for (std::size_t first = 0; first < touching.count; first += Block::size) {
      const int count = static_cast<int>(std::min(touching.count - first, static_cast<std::size_t>(Block::size)));
      const std::size_t* const which = touching.pairs + first;
      step.greatestOverlap = tally().overlapMax;
      const bool greater = packed_->pairs(step, grains, pairs, which, count, block_);
      if (greater || tally().overlaps) watch(pairs, which, count);
      packed_->add(step, grains, pairs, which, count, block_);
    }
  }

  PackedGrains packed_grains(LAMMPS_NS::PairGran* pg) const {
    const LAMMPS_NS::Atom* const a = program_->atom;
    PackedGrains g;
    g.places = nearPairs_.places();
    g.v = a->v[0];
    g.omega = a->omega[0];
    g.mass = a->rmass;
    g.body = pg->fr_pair() ? pg->mr_pair() : NULL;
    g.type = a->type;
    g.mask = a->mask;
    g.types = Packed::pairs(model_).place(1, 0);
    g.frozen = pg->freeze_group_bit();
    g.owned = program_->force->newton_pair ? a->nlocal + a->nghost : a->nlocal;
    g.flags = Packed::flags;
    g.f = a->f[0];
    g.torque = a->torque[0];
    return g;
  }

  // Overlap limit and statistics.
  __attribute__((noinline)) void watch(const NearPair* pairs, const std::size_t* which, int count) {
    LIGGGHTS::ContactModels::SurfacesIntersectData c = LIGGGHTS::ContactModels::SurfacesIntersectData();
    for (int k = 0; k < count; k++) {
      c.i = pairs[which[k]].i;
      c.j = pairs[which[k]].j;
      c.radi = block_.R1[k];
      c.radj = block_.R2[k];
      c.deltan = block_.overlap[k];
      c.Fn = block_.normal[k];
      const double diameter = smaller_diameter(c);
      if (tally().overlaps || c.deltan > tally().overlapMax * diameter) Packed::watch(model_, c, diameter);
    }
  }

  /* Pairs in contact, in the order of the neighbour list. Apart from the law, so that its long chain of operations is
     not broken off at every neighbour that the processor has wrongly guessed to touch. */
  const Touching& find_touches(LAMMPS_NS::PairGran* pg) {
    LAMMPS_NS::NeighList* const list = pg->list;
    LAMMPS_NS::NeighList* const histories = pg->listgranhistory;
    if (nearPairs_.begin(program_))
      for (int row = 0; row < list->inum; row++) {
        const int i = list->ilist[row];
        nearPairs_.look(i, list->firstneigh[i], list->numneigh[i], histories->firstneigh[i], histories->firstdouble[i],
                        pg->dnum(), [&](int* flags, double* history) { part(flags, history); });
      }
    const Touching& found = nearPairs_.find();
    for (std::size_t k = 0; k < found.partedCount; k++) {
      const NearPair& pair = nearPairs_.pairs()[found.parted[k]];
      part(pair.flags, pair.history);
    }
    return found;
  }

  static VIELTO_INLINE void add(double factor, const LIGGGHTS::ContactModels::ForceData& forces, double* f,
                                double* torque) {
    for (int d = 0; d < 3; d++) {
      f[d] += factor * forces.delta_F[d];
      torque[d] += factor * forces.delta_torque[d];
    }
  }

  // A contact that has ended: the models clear its flag and history.
  __attribute__((noinline)) void part(int* flags, double* history) {
    LIGGGHTS::ContactModels::SurfacesIntersectData c = LIGGGHTS::ContactModels::SurfacesIntersectData();
    LIGGGHTS::ContactModels::ForceData onI, onJ;
    c.contact_flags = flags;
    c.contact_history = history;
    model_.surfacesClose(c, onI, onJ);
  }

  LAMMPS_NS::LAMMPS* program_;
  Model& model_;
  const PackedLaw* packed_;  // NULL: contacts one by one
  TimeStepWatch timeStep_;
  NearPairs nearPairs_;
  Block block_ = Block();
};

}  // namespace vielto

#endif

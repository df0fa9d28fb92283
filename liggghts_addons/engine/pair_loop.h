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
#include <vector>

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
        packed_(Packed::packs ? packed_law(program) : NULL) {}

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
  struct Touch {
    int i, j;
    double dx, dy, dz, square;
    int* flags;
    double* history;
  };

  // Step: forces are wanted and the history goes on, as in every step of a run.
  template <bool Step>
  VIELTO_FLATTEN void loop(LAMMPS_NS::PairGran* pg) {
    using namespace LIGGGHTS::ContactModels;
    LAMMPS_NS::Atom* const grains = program_->atom;
    double* const* const v = grains->v;
    double* const* const omega = grains->omega;
    double* const* const f = grains->f;
    double* const* const torque = grains->torque;
    const double* const radius = grains->radius;
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

    const std::size_t found = find_touches(pg);
    for (std::size_t k = 0; k < found; k++) {
      const Touch& t = touches_[k];
      // LIGGGHTS keeps the three values of a grain after those of the one before
      const Touch& ahead = touches_[std::min(k + 8, found - 1)];
      for (const double* values : {v[0], omega[0], f[0], torque[0]})
        __builtin_prefetch(values + 3 * static_cast<std::size_t>(ahead.j));
      __builtin_prefetch(ahead.history, 1);
      __builtin_prefetch(ahead.history + 7, 1);
      const int i = t.i, j = t.j;
      c.i = i;
      c.j = j;
      c.itype = type[i];
      c.jtype = type[j];
      c.delta[0] = t.dx;
      c.delta[1] = t.dy;
      c.delta[2] = t.dz;
      c.rsq = t.square;
      c.r = sqrt(t.square);
      c.rinv = 1.0 / c.r;
      c.en[0] = t.dx * c.rinv;
      c.en[1] = t.dy * c.rinv;
      c.en[2] = t.dz * c.rinv;
      c.radi = radius[i];
      c.radj = radius[j];
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

  // A step of a run, several contacts at once.
  void packed_loop(LAMMPS_NS::PairGran* pg) {
    const std::size_t found = find_touches(pg);
    PackedStep step = Packed::step(model_);
    step.dt = program_->update->dt;
    step.frozen = pg->freeze_group_bit() != 0;
    for (std::size_t first = 0; first < found; first += Block::size) {
      const int count = static_cast<int>(std::min(found - first, static_cast<std::size_t>(Block::size)));
      fill(pg, step, &touches_[first], count, found - first);
      step.greatestOverlap = tally().overlapMax;
      const bool greater = packed_->pairs(step, block_, count);
      if (greater || tally().overlaps) watch(&touches_[first], count);
      add_block(pg, step.settings, &touches_[first], count);
    }
  }

  void fill(LAMMPS_NS::PairGran* pg, const PackedStep& step, const Touch* touches, int count, std::size_t left) {
    LAMMPS_NS::Atom* const grains = program_->atom;
    const PairTable& table = Packed::pairs(model_);
    const double* const radius = grains->radius;
    const double* const rmass = grains->rmass;
    const double* const body = pg->fr_pair() ? pg->mr_pair() : NULL;
    const LawSettings& s = step.settings;
    Block& b = block_;
    b.alike = true;
    for (int k = 0; k < count; k++) {
      const Touch& t = touches[k];
      const Touch& ahead = touches[std::min(static_cast<std::size_t>(k + 8), left - 1)];
      // LIGGGHTS keeps the three values of a grain after those of the one before
      for (const double* values : {grains->v[0], grains->omega[0], grains->f[0], grains->torque[0]})
        __builtin_prefetch(values + 3 * static_cast<std::size_t>(ahead.j));
      __builtin_prefetch(ahead.history, 1);
      __builtin_prefetch(ahead.history + 7, 1);
      const int i = t.i, j = t.j;
      b.delta[0][k] = t.dx, b.delta[1][k] = t.dy, b.delta[2][k] = t.dz;
      b.square[k] = t.square;
      b.R1[k] = radius[i];
      b.R2[k] = radius[j];
      b.m1[k] = body && body[i] > 0.0 ? body[i] : rmass[i];
      b.m2[k] = body && body[j] > 0.0 ? body[j] : rmass[j];
      b.pair[k] = table.place(grains->type[i], grains->type[j]);
      b.alike &= b.pair[k] == b.pair[0];
      const double *vi = grains->v[i], *vj = grains->v[j], *wi = grains->omega[i], *wj = grains->omega[j];
      for (int d = 0; d < 3; d++) {
        b.v[d][k] = vi[d] - vj[d];
        b.spin1[d][k] = wi[d];
        b.spin2[d][k] = wj[d];
        b.sliding[d][k] = t.history[s.slidingAt + d];
      }
      if (s.rolling) {
        for (int d = 0; d < 3; d++) b.rolling[d][k] = t.history[s.rollingAt + d];
        b.twisting[k] = t.history[s.rollingAt + 3];
      }
    }
    if (!step.frozen) return;
    for (int k = 0; k < count; k++) {
      b.held1[k] = (grains->mask[touches[k].i] & pg->freeze_group_bit()) != 0;
      b.held2[k] = (grains->mask[touches[k].j] & pg->freeze_group_bit()) != 0;
    }
  }

  // Forces, in the order of the contacts, so that sums are rounded as in the other loop; and the histories.
  void add_block(LAMMPS_NS::PairGran* pg, const LawSettings& s, const Touch* touches, int count) {
    LAMMPS_NS::Atom* const grains = program_->atom;
    const int owned = program_->force->newton_pair ? grains->nlocal + grains->nghost : grains->nlocal;
    const Block& b = block_;
    for (int k = 0; k < count; k++) {
      const Touch& t = touches[k];
      *t.flags |= Packed::flags;
      for (int d = 0; d < 3; d++) t.history[s.slidingAt + d] = b.sliding[d][k];
      if (s.rolling) {
        for (int d = 0; d < 3; d++) t.history[s.rollingAt + d] = b.rolling[d][k];
        t.history[s.rollingAt + 3] = b.twisting[k];
      }
      const double one = pg->relax(t.i);
      double *f = grains->f[t.i], *torque = grains->torque[t.i];
      for (int d = 0; d < 3; d++) {
        f[d] += one * b.force[d][k];
        torque[d] += one * b.torque1[d][k];
      }
      if (t.j >= owned) continue;
      const double two = pg->relax(t.j);
      f = grains->f[t.j], torque = grains->torque[t.j];
      for (int d = 0; d < 3; d++) {
        f[d] -= two * b.force[d][k];
        torque[d] += two * b.torque2[d][k];
      }
    }
  }

  // Overlap limit and statistics.
  __attribute__((noinline)) void watch(const Touch* touches, int count) {
    LIGGGHTS::ContactModels::SurfacesIntersectData c = LIGGGHTS::ContactModels::SurfacesIntersectData();
    for (int k = 0; k < count; k++) {
      c.i = touches[k].i;
      c.j = touches[k].j;
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
  std::size_t find_touches(LAMMPS_NS::PairGran* pg) {
    LAMMPS_NS::NeighList* const list = pg->list;
    LAMMPS_NS::NeighList* const histories = pg->listgranhistory;
    const int dnum = pg->dnum();
    if (nearPairs_.begin(program_, list))
      for (int row = 0; row < list->inum; row++) {
        const int i = list->ilist[row];
        int* const flags = histories->firstneigh[i];
        nearPairs_.look(row, i, list->firstneigh[i], list->numneigh[i], flags,
                        [&](int slot) { part(flags + slot, histories->firstdouble[i] + dnum * slot); });
      }
    touches_.clear();
    const std::size_t found = nearPairs_.find(list);
    for (std::size_t k = 0; k < found; k++) {
      const NearPairs::Hit& hit = nearPairs_.hit(k);
      const NearPairs::Near& near = nearPairs_.near(hit.near);
      const int i = list->ilist[hit.row], j = near.grain;
      const Place &one = nearPairs_.place(i), &two = nearPairs_.place(j);
      const double dx = one.x - two.x, dy = one.y - two.y, dz = one.z - two.z;
      const double square = dx * dx + dy * dy + dz * dz, radii = one.radius + two.radius;
      int* const flags = histories->firstneigh[i] + near.slot;
      double* const history = histories->firstdouble[i] + dnum * near.slot;
      const bool touch = square < radii * radii;
      nearPairs_.touches(hit.near, touch);
      if (touch)
        touches_.push_back({i, j, dx, dy, dz, square, flags, history});
      else
        part(flags, history);
    }
    return touches_.size();
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
  std::vector<Touch> touches_;
  Block block_ = Block();
};

}  // namespace vielto

#endif

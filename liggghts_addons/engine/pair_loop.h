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

/* Which neighbours of a list may touch: those nearer than a margin when all were looked at last, for as long as no
   grain has gone, or grown, half of it since. The margin follows the grains' speed so that a look at all comes every 16
   steps; it changes nothing but the time. */
class NearPairs {
 public:
  // Call once a step, before the loop; tells whether this step looks at all.
  bool begin(const LAMMPS_NS::LAMMPS* lmp, const LAMMPS_NS::NeighList* list) {
    const LAMMPS_NS::Neighbor* const neighbor = lmp->neighbor;
    const LAMMPS_NS::Atom* const grains = lmp->atom;
    const bool renewed =
        lmp->update->setupflag || build_ != neighbor->lastcall || neighbor->lastcall == lmp->update->ntimestep;
    build_ = neighbor->lastcall;
    const std::size_t count = grains->nlocal + grains->nghost;
    age_++;
    if (!renewed && count == held_.size()) {
      double farthest = 0, growth = 0;
      for (std::size_t i = 0; i < count; i++) {
        const double* const x = grains->x[i];
        const Place& h = held_[i];
        const double dx = x[0] - h.x, dy = x[1] - h.y, dz = x[2] - h.z;
        farthest = std::max(farthest, dx * dx + dy * dy + dz * dz);
        growth = std::max(growth, grains->radius[i] - h.radius);
      }
      const double nearer = 2 * (sqrt(farthest) + growth);
      // 1e-9: the margin was compared with rounded distances
      if (nearer < margin_ * (1 - 1e-9)) return false;
      margin_ = 16 * nearer / age_;
    }
    age_ = 0;
    held_.resize(count);
    for (std::size_t i = 0; i < count; i++) {
      const double* const x = grains->x[i];
      const Place now = {x[0], x[1], x[2], grains->radius[i]};
      held_[i] = now;
    }
    std::size_t neighbours = 0;
    for (int ii = 0; ii < list->inum; ii++) neighbours += list->numneigh[list->ilist[ii]];
    if (near_.size() < neighbours) near_.resize(neighbours);
    start_.resize(list->inum + 1);
    return true;
  }
  double margin() const { return margin_; }
  int* near() { return near_.data(); }
  std::size_t* start() { return start_.data(); }

 private:
  struct Place {
    double x, y, z, radius;
  };
  std::vector<Place> held_;         // at the last look at all
  std::vector<int> near_;           // positions in the neighbour list of one grain after the other
  std::vector<std::size_t> start_;  // of a grain's in near_
  double margin_ = 0;
  bigint build_ = -1;  // the neighbour list that near_ belongs to
  int age_ = 0;        // steps since the last look at all
};

template <class Style>
class FastPair : public LIGGGHTS::PairStyles::Granular<LIGGGHTS::ContactModels::ContactModel<Style>> {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef LIGGGHTS::PairStyles::Granular<Model> General;
  typedef PackedModels<Style> Models;

 public:
  FastPair(LAMMPS_NS::LAMMPS* program, LAMMPS_NS::PairGran* parent, int64_t hash)
      : General(program, parent, hash),
        program_(program),
        model_(this->*Handed<ModelOfPair<Style>>::pointer),
        packed_(Models::packs ? packed_law(program) : NULL) {}

  void compute_force(LAMMPS_NS::PairGran* pg, int eflag, int vflag, int addflag) override {
    const bool plain = !eflag && !vflag && !(pg->cpl() && addflag) && !pg->storeContactForces() &&
                       !pg->storeContactForcesStress() && !pg->storeSumDelta() && !pg->store_sum_normal_force() &&
                       pg->listgranhistory && program_->atom->rmass && program_->atom->sphere_flag &&
                       !program_->atom->shapetype_flag &&
                       program_->modify->n_fixes_style("insert/stream/predefined") == 0;
    if (!plain) return General::compute_force(pg, eflag, vflag, addflag);
    pg->evflag = pg->vflag_fdotr = 0;
    const bool step = pg->computeflag() && pg->shearupdate();
    if constexpr (Models::packs)
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
    PackedStep step = Models::step(model_);
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
    const PairTable& table = Models::pairs(model_);
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
      *t.flags |= Models::flags;
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
      if (tally().overlaps || c.deltan > tally().overlapMax * diameter) Models::watch(model_, c, diameter);
    }
  }

  /* Pairs in contact, in the order of the neighbour list. Apart from the law, so that its long chain of operations is
     not broken off at every neighbour that the processor has wrongly guessed to touch. */
  std::size_t find_touches(LAMMPS_NS::PairGran* pg) {
    LAMMPS_NS::NeighList* const list = pg->list;
    double* const* const x = program_->atom->x;
    const double* const radius = program_->atom->radius;
    const int dnum = pg->dnum();
    const bool all = nearPairs_.begin(program_, list);
    const double margin = nearPairs_.margin();
    int* const near = nearPairs_.near();
    std::size_t* const start = nearPairs_.start();
    std::size_t kept = 0, found = 0;
    for (int ii = 0; ii < list->inum; ii++) {
      const int i = list->ilist[ii];
      const int* const neighbours = list->firstneigh[i];
      int* const flags = pg->listgranhistory->firstneigh[i];
      double* const histories = pg->listgranhistory->firstdouble[i];
      const double xi = x[i][0], yi = x[i][1], zi = x[i][2], Ri = radius[i];
      const std::size_t first = all ? 0 : start[ii], last = all ? list->numneigh[i] : start[ii + 1];
      if (all) start[ii] = kept;
      // room for all, so that what touches is counted without a branch
      if (touches_.size() <= found + (last - first)) touches_.resize(2 * (found + (last - first)) + 1);
      for (std::size_t k = first; k < last; k++) {
        const int jj = all ? static_cast<int>(k) : near[k];
        const int j = neighbours[jj] & NEIGHMASK;
        const double dx = xi - x[j][0], dy = yi - x[j][1], dz = zi - x[j][2];
        const double square = dx * dx + dy * dy + dz * dz;
        const double radii = Ri + radius[j];
        if (all && square < (radii + margin) * (radii + margin)) near[kept++] = jj;
        const bool touch = square < radii * radii;
        if (!touch && flags[jj]) part(flags + jj, histories + dnum * jj);
        const Touch t = {i, j, dx, dy, dz, square, flags + jj, histories + dnum * jj};
        touches_[found] = t;
        found += touch;
      }
    }
    if (all) start[list->inum] = kept;
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
  NearPairs nearPairs_;
  std::vector<Touch> touches_;
  Block block_;
};

}  // namespace vielto

#endif

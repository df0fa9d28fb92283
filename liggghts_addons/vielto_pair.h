// SPDX-License-Identifier: GPL-2.0-or-later
/* Pair loop for ViElTo behind LIGGGHTS' own registration.

   Purpose   The same forces, bit for bit, as LIGGGHTS' PairStyles::Granular, in less time. That loop prepares every
             neighbour as if it were a contact and resets the history of all that are not, which is half of the pair
             time of a loose bed; here a neighbour out of contact costs its distance and a look at its flag. One contact's
             data live in registers, because nothing takes their address.
   Falls back to LIGGGHTS' loop where a feature is on that this one leaves out: virial, compute pair/gran/local, stored
             contact forces, multicontact radii, summed normal forces, predefined insertion, non-spherical grains.
   For       cohesion models without force at a distance. */
#ifndef VIELTO_PAIR_H
#define VIELTO_PAIR_H

// clang-format off
#include "fix_insert_stream.h"
#include "pair_gran_base.h"
// clang-format on

// All of a contact in one function; with sanitizers in it that one would take a compiler a quarter of an hour.
#if defined(__SANITIZE_ADDRESS__)
#define VIELTO_FLATTEN
#else
#define VIELTO_FLATTEN __attribute__((flatten))
#endif

namespace vielto {

/* LIGGGHTS keeps the model of a pair style, and its tables of styles, private and offers no way to them. An explicit
   instantiation may name a private member: `template struct Opened<Key, &Class::member>` fills Handed<Key>::pointer. */
template <class Key>
struct Handed {
  static typename Key::type pointer;
};
template <class Key>
typename Key::type Handed<Key>::pointer;

template <class Key, typename Key::type Member>
struct Opened {
  struct Fill {
    Fill() { Handed<Key>::pointer = Member; }
  };
  static Fill fill;
};
template <class Key, typename Key::type Member>
typename Opened<Key, Member>::Fill Opened<Key, Member>::fill;

template <class Style>
struct ModelOfPair {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef Model LIGGGHTS::PairStyles::Granular<Model>::*type;
};

template <class Style>
class FastPair : public LIGGGHTS::PairStyles::Granular<LIGGGHTS::ContactModels::ContactModel<Style>> {
  typedef LIGGGHTS::ContactModels::ContactModel<Style> Model;
  typedef LIGGGHTS::PairStyles::Granular<Model> General;

 public:
  FastPair(LAMMPS_NS::LAMMPS* program, LAMMPS_NS::PairGran* parent, int64_t hash)
      : General(program, parent, hash), program_(program), model_(this->*Handed<ModelOfPair<Style>>::pointer) {}

  void compute_force(LAMMPS_NS::PairGran* pg, int eflag, int vflag, int addflag) override {
    const bool plain = !eflag && !vflag && !(pg->cpl() && addflag) && !pg->storeContactForces() &&
                       !pg->storeContactForcesStress() && !pg->storeSumDelta() && !pg->store_sum_normal_force() &&
                       pg->listgranhistory && program_->atom->rmass && program_->atom->sphere_flag && !program_->atom->shapetype_flag &&
                       program_->modify->n_fixes_style("insert/stream/predefined") == 0;
    if (!plain) return General::compute_force(pg, eflag, vflag, addflag);
    pg->evflag = pg->vflag_fdotr = 0;
    if (pg->computeflag() && pg->shearupdate())
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
    double* const* const x = grains->x;
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
    const int dnum = pg->dnum();
    const int owned = program_->force->newton_pair ? grains->nlocal + grains->nghost : grains->nlocal;

    SurfacesIntersectData c = SurfacesIntersectData();
    ForceData onI, onJ;
    c.is_wall = false;
    c.area_ratio = 1.0;
    c.computeflag = Step ? 1 : pg->computeflag();
    c.shearupdate = Step ? 1 : pg->shearupdate();

    LAMMPS_NS::NeighList* const list = pg->list;
    for (int ii = 0; ii < list->inum; ii++) {
      const int i = list->ilist[ii];
      const int* const neighbours = list->firstneigh[i];
      const int count = list->numneigh[i];
      int* const flags = pg->listgranhistory->firstneigh[i];
      double* const histories = pg->listgranhistory->firstdouble[i];
      const double xi = x[i][0], yi = x[i][1], zi = x[i][2], Ri = radius[i];
      for (int jj = 0; jj < count; jj++) {
        const int j = neighbours[jj] & NEIGHMASK;
        const double dx = xi - x[j][0], dy = yi - x[j][1], dz = zi - x[j][2];
        const double square = dx * dx + dy * dy + dz * dz;
        const double radii = Ri + radius[j];
        if (square >= radii * radii) {
          if (flags[jj]) part(flags + jj, histories + dnum * jj);
          continue;
        }
        c.i = i;
        c.j = j;
        c.itype = type[i];
        c.jtype = type[j];
        c.delta[0] = dx;
        c.delta[1] = dy;
        c.delta[2] = dz;
        c.rsq = square;
        c.r = sqrt(square);
        c.rinv = 1.0 / c.r;
        c.en[0] = dx * c.rinv;
        c.en[1] = dy * c.rinv;
        c.en[2] = dz * c.rinv;
        c.radi = Ri;
        c.radj = radius[j];
        c.radsum = radii;
        c.v_i = v[i];
        c.v_j = v[j];
        c.omega_i = omega[i];
        c.omega_j = omega[j];
        c.mi = body && body[i] > 0.0 ? body[i] : rmass[i];
        c.mj = body && body[j] > 0.0 ? body[j] : rmass[j];
        c.meff = c.mi * c.mj / (c.mi + c.mj);
        if (mask[i] & frozen) c.meff = c.mj;
        if (mask[j] & frozen) c.meff = c.mi;
        c.contact_flags = flags + jj;
        c.contact_history = histories + dnum * jj;
        onI.reset();
        onJ.reset();
        model_.surfacesIntersect(c, onI, onJ);
        model_.endSurfacesIntersect(c, NULL, onI, onJ);
        if (!Step && !c.computeflag) continue;
        add(pg->relax(i), onI, f[i], torque[i]);
        if (j < owned) add(pg->relax(j), onJ, f[j], torque[j]);
      }
    }
  }

  static VIELTO_INLINE void add(double factor, const LIGGGHTS::ContactModels::ForceData& forces, double* f, double* torque) {
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
};

}  // namespace vielto

#endif

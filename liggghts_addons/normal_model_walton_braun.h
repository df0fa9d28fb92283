// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS adapter of Walton and Braun's linear hysteretic normal force (walton_braun_law.h).
   `pair_style gran model walton_braun tangential vielto [cohesion adhesion] [rolling_friction vielto] ...`

   k_1 = c_n k_n of ViElTo, so that both load alike; sliding, rolling and twisting are ViElTo's. Where ViElTo has a
   dashpot, the branches' difference dissipates.

   Settings:
     springFactor VALUE      c_n, default 4 as ViElTo's
     wallRadiusFactor VALUE  R_2/R_1 of a wall, default 2
     maxOverlap VALUE        as in normal_model_vielto.h; default 0: no limit, refused with an unloadingHardening > 0,
                             whose stiffness and so whose time step has no bound without it

   Properties: those of vielto_properties.h (normalDamping has no effect: give 0), and
     coefficientRestitution  peratomtypepair, (0, 1]   1   e
     unloadingHardening      scalar, >= 0              1   h

   History, per contact: greatest overlap (m). Leaves to the later models in sidata what normal_model_vielto.h does. */
#ifdef NORMAL_MODEL
NORMAL_MODEL(WALTON_BRAUN, walton_braun, 24)
#else
#ifndef NORMAL_MODEL_WALTON_BRAUN_H
#define NORMAL_MODEL_WALTON_BRAUN_H

#include <stdio.h>

#include <vector>

#include "contact_models.h"
#include "neighbor.h"
#include "normal_model_base.h"
#include "vielto_numbers.h"
#include "vielto_overlap.h"
#include "vielto_properties.h"
#include "vielto_state.h"
#include "vielto_stop.h"
#include "walton_braun_law.h"

namespace walton_braun {

// e of all pairs of types and h, as properties of a simulation.
class Properties {
 public:
  void read(LAMMPS_NS::LAMMPS* lmp) {
    n_ = lmp->atom->ntypes + 1;
    LAMMPS_NS::FixPropertyGlobal* const e = vielto::find_property(lmp, "coefficientRestitution");
    if (!e || e->size_array_rows != n_ - 1 || e->size_array_cols != n_ - 1)
      vielto::stop_all(lmp,
                       "walton_braun: give 'fix ID all property/global coefficientRestitution peratomtypepair NTYPES "
                       "VALUES', a value for each pair of types");
    restitution_.assign(n_ * n_, 1.0);
    for (int i = 1; i < n_; i++)
      for (int j = 1; j < n_; j++) {
        const double value = e->compute_array(i - 1, j - 1);
        if (!(value > 0 && value <= 1)) {
          char line[200];
          snprintf(line, sizeof line,
                   "walton_braun: property coefficientRestitution of types %d and %d is %g, out of its range (0, 1]", i,
                   j, value);
          vielto::stop_all(lmp, line);
        }
        restitution_[i * n_ + j] = value;
      }
    LAMMPS_NS::FixPropertyGlobal* const h = vielto::find_property(lmp, "unloadingHardening");
    if (!h || !(h->compute_scalar() >= 0))
      vielto::stop_all(lmp,
                       "walton_braun: give 'fix ID all property/global unloadingHardening scalar VALUE', >= 0 (0: the "
                       "unloading stiffness does not depend on the load)");
    hardening_ = h->compute_scalar();
  }

  double restitution(int itype, int jtype) const { return restitution_[itype * n_ + jtype]; }
  double hardening() const { return hardening_; }

 private:
  int n_ = 0;
  double hardening_ = 0;
  std::vector<double> restitution_;
};

}  // namespace walton_braun

namespace LIGGGHTS {
namespace ContactModels {

template <>
class NormalModel<WALTON_BRAUN> : public NormalModelBase {
 public:
  NormalModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : NormalModelBase(lmp, hsetup, c), springFactor_(4.0), wallRadiusFactor_(2.0), tally_(vielto::tally()) {
    offset_ = hsetup->add_history_value("walton_braun_greatest", "0");
  }

  void registerSettings(::Settings& settings) {
    settings.registerDoubleSetting("springFactor", springFactor_, 4.0);
    settings.registerDoubleSetting("wallRadiusFactor", wallRadiusFactor_, 2.0);
    settings.registerDoubleSetting("maxOverlap", overlaps_.limit, 0.0);
  }

  void postSettings(IContactHistorySetup*, ContactModelBase* cmb) {
    for (const char* name : {"springFactor", "wallRadiusFactor", "maxOverlap"}) vielto::refuse_no_number(lmp, name);
    if (!(springFactor_ > 0)) vielto::stop_all(lmp, "walton_braun: springFactor must be > 0 (default 4)");
    if (!(wallRadiusFactor_ > 0)) vielto::stop_all(lmp, "walton_braun: wallRadiusFactor must be > 0 (default 2)");
    overlaps_.check_limit(lmp);
    if (cmb->is_wall()) return;
    vielto::Settings& shared = vielto::settings();
    shared.springFactor = springFactor_;
    shared.wallRadiusFactor = wallRadiusFactor_;
    shared.law = WALTON_BRAUN;
    shared.maxOverlap = overlaps_.limit;
  }

  void connectToProperties(PropertyRegistry&) {
    pairs_.read(lmp);
    properties_.read(lmp);
    if (properties_.hardening() > 0 && overlaps_.limit == 0)
      vielto::stop_all(lmp,
                       "walton_braun: an unloadingHardening > 0 needs a maxOverlap > 0: its stiffness, and so its time "
                       "step, has no other bound");
    if (force->cg_active()) error->cg(FLERR, "model walton_braun");
    // so that the history of a contact ends with it (normal_model_vielto.h)
    neighbor->register_contact_dist_factor(1.01);
  }

  // the loading spring is linear
  double stressStrainExponent() { return 1.; }

  VIELTO_INLINE void surfacesIntersect(SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_NORMAL_MODEL;
    const double radj = sidata.is_wall ? wallRadiusFactor_ * sidata.radi : sidata.radj;
    const vielto::Stiffness s = vielto::stiffness(pairs_(sidata.itype, sidata.jtype), sidata.radi, radj, sidata.meff);
    const double diameter = vielto::smaller_diameter(sidata);
    const double e = properties_.restitution(sidata.itype, sidata.jtype), h = properties_.hardening();
    const double k1 = springFactor_ * s.kn;
    double& memory = sidata.contact_history[offset_];
    const double before = memory, greatest = sidata.deltan > before ? sidata.deltan : before;
    const double k2 = walton_braun::unloading_stiffness(k1, e, h, greatest, diameter);
    const double Fn = walton_braun::force(k1, k2, sidata.deltan, greatest);

    sidata.Fn = Fn;
    sidata.kn = s.kn;
    sidata.kt = s.ks;
    sidata.gamman = 0.0;
    sidata.gammat = s.gammaS;

    if (sidata.computeflag && sidata.shearupdate) {
      memory = greatest;
      const bool record = sidata.deltan > tally_.overlapMax * diameter || (sidata.is_wall && Fn > tally_.wallForce);
      if (record || tally_.overlaps) overlaps_.note(lmp, SurfacesIntersectData(sidata), diameter);
      if (tally_.energy) {
        const double share = vielto::share(sidata, atom->nlocal, force->newton_pair);
        tally_.elastic += share * walton_braun::held(Fn, k2);
        tally_.normalDamping += share * (walton_braun::lost(k1, k2, greatest) - lost_by(k1, e, h, before, diameter));
      }
    }

    const double F = sidata.is_wall ? Fn * sidata.area_ratio : Fn;
    for (int d = 0; d < 3; d++) {
      i_forces.delta_F[d] += F * sidata.en[d];
      if (!sidata.is_wall) j_forces.delta_F[d] -= F * sidata.en[d];
    }
  }

  void surfacesClose(SurfacesCloseData& scdata, ForceData&, ForceData&) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_NORMAL_MODEL;
    if (scdata.contact_history) scdata.contact_history[offset_] = 0.0;
  }

  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) {}

 private:
  static double lost_by(double k1, double e, double h, double greatest, double diameter) {
    return walton_braun::lost(k1, walton_braun::unloading_stiffness(k1, e, h, greatest, diameter), greatest);
  }

  int offset_;
  double springFactor_, wallRadiusFactor_;
  vielto::OverlapWatch overlaps_;
  vielto::PairTable pairs_;
  walton_braun::Properties properties_;
  vielto::Tally& tally_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

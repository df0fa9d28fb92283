// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS adapter of ViElTo's normal force (vielto_law.h). `pair_style gran model vielto ...`

   Settings (after the model keywords):
     springFactor VALUE      c_n, default 4 as printed; 1 makes normalDamping the damping ratio
     wallRadiusFactor VALUE  R_2/R_1 of a wall, default 2 (what Yade takes for a facet)
     limitForce on|off       on: no attraction from the dashpot at separation; default off
     maxOverlap VALUE        stop the run when an overlap exceeds VALUE times the diameter of the smaller
                             grain, naming grain and step; default 0: no limit

   Leaves to the later models in sidata: Fn (spring plus dashpot, without cohesion), kn = k_n, kt = k_s,
   gamman, gammat. */
#ifdef NORMAL_MODEL
NORMAL_MODEL(VIELTO, vielto, 20)
#else
#ifndef NORMAL_MODEL_VIELTO_H
#define NORMAL_MODEL_VIELTO_H

#include "contact_models.h"
#include "neighbor.h"
#include "normal_model_base.h"
#include "vielto_numbers.h"
#include "vielto_overlap.h"
#include "vielto_properties.h"
#include "vielto_state.h"
#include "vielto_stop.h"

namespace LIGGGHTS {
namespace ContactModels {

template <>
class NormalModel<VIELTO> : public NormalModelBase {
 public:
  NormalModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : NormalModelBase(lmp, hsetup, c),
        springFactor_(4.0),
        wallRadiusFactor_(2.0),
        limitForce_(false),
        tally_(vielto::tally()) {}

  void registerSettings(::Settings& settings) {
    settings.registerDoubleSetting("springFactor", springFactor_, 4.0);
    settings.registerDoubleSetting("wallRadiusFactor", wallRadiusFactor_, 2.0);
    settings.registerDoubleSetting("maxOverlap", overlaps_.limit, 0.0);
    settings.registerOnOff("limitForce", limitForce_, false);
  }

  void postSettings(IContactHistorySetup*, ContactModelBase* cmb) {
    for (const char* name : {"springFactor", "wallRadiusFactor", "maxOverlap"}) vielto::refuse_no_number(lmp, name);
    if (!(springFactor_ > 0)) vielto::stop_all(lmp, "vielto: springFactor must be > 0 (4 as printed, or 1)");
    if (!(wallRadiusFactor_ > 0)) vielto::stop_all(lmp, "vielto: wallRadiusFactor must be > 0 (default 2)");
    overlaps_.check_limit(lmp);
    vielto::Settings& shared = vielto::settings();
    if (cmb->is_wall() && shared.law == VIELTO &&
        (shared.springFactor != springFactor_ || shared.wallRadiusFactor != wallRadiusFactor_))
      error->warning(FLERR, "vielto: springFactor or wallRadiusFactor of this wall differs from pair_style's");
    if (!cmb->is_wall()) {
      shared.springFactor = springFactor_;
      shared.wallRadiusFactor = wallRadiusFactor_;
      shared.law = VIELTO;
    }
  }

  void connectToProperties(PropertyRegistry&) {
    pairs_.read(lmp);
    if (force->cg_active()) error->cg(FLERR, "model vielto");
    // LIGGGHTS' pair loop calls surfacesClose out to this multiple of the radii: without it the history of a contact
    // that has ended would still be there when the grains meet again
    neighbor->register_contact_dist_factor(1.01);
  }

  void describe(vielto::LawSettings& s) const {
    s.springFactor = springFactor_;
    s.wallRadiusFactor = wallRadiusFactor_;
    s.limitForce = limitForce_;
  }
  const vielto::PairTable& pairs() const { return pairs_; }

  // the normal spring is linear
  double stressStrainExponent() { return 1.; }

  VIELTO_INLINE void surfacesIntersect(SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_NORMAL_MODEL;
    const double radj = sidata.is_wall ? wallRadiusFactor_ * sidata.radi : sidata.radj;
    const vielto::Stiffness s = vielto::stiffness(pairs_(sidata.itype, sidata.jtype), sidata.radi, radj, sidata.meff);
    double Fn = vielto::normal_force(springFactor_, s, sidata.deltan, sidata.vn);
    if (limitForce_ && Fn < 0.0) Fn = 0.0;

    sidata.Fn = Fn;
    sidata.kn = s.kn;
    sidata.kt = s.ks;
    sidata.gamman = s.gammaN;
    sidata.gammat = s.gammaS;

    if (sidata.computeflag && sidata.shearupdate) {
      const double diameter = vielto::smaller_diameter(sidata);
      const bool record = sidata.deltan > tally_.overlapMax * diameter || (sidata.is_wall && Fn > tally_.wallForce);
      // a copy, so that the pair loop can keep a contact's data in registers
      if (record || tally_.overlaps || tally_.energy) watch(SurfacesIntersectData(sidata), diameter);
    }

    const double F = sidata.is_wall ? Fn * sidata.area_ratio : Fn;
    const double fx = F * sidata.en[0], fy = F * sidata.en[1], fz = F * sidata.en[2];
    i_forces.delta_F[0] += fx;
    i_forces.delta_F[1] += fy;
    i_forces.delta_F[2] += fz;
    if (!sidata.is_wall) {
      j_forces.delta_F[0] -= fx;
      j_forces.delta_F[1] -= fy;
      j_forces.delta_F[2] -= fz;
    }
  }

  void surfacesClose(SurfacesCloseData& scdata, ForceData&, ForceData&) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_NORMAL_MODEL;
  }

  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) {}

  // Overlap limit, overlap statistics and the normal part of the energy accounts.
  VIELTO_NOINLINE void watch(const SurfacesIntersectData& sidata, double diameter) {
    overlaps_.note(lmp, sidata, diameter);
    if (tally_.energy) {
      const double share = vielto::share(sidata, atom->nlocal, force->newton_pair);
      const double spring = springFactor_ * sidata.kn * sidata.deltan;
      tally_.elastic += share * 0.5 * spring * sidata.deltan;
      /* In leapfrog the force F_k of a step works 1/2 (F_k-1 + F_k) v_k dt, v_k between the steps k-1 and k. Taken as
         F_k v_k dt the dashpot's work is too much by 1/2 gamma v_k (v_k - v_k-1) dt, which adds up to gamma dt/(2
         m_eff) times the kinetic energy that it takes from the relative motion: the share left out here. */
      const double halfStep = 1 - 0.5 * sidata.gamman * update->dt / sidata.meff;
      tally_.normalDamping += share * (spring - sidata.Fn) * sidata.vn * update->dt * halfStep;
    }
  }

 private:
  double springFactor_, wallRadiusFactor_;
  vielto::OverlapWatch overlaps_;
  bool limitForce_;
  vielto::PairTable pairs_;
  vielto::Tally& tally_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

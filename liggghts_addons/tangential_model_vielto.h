// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS adapter of ViElTo's tangential force (vielto_law.h). `... tangential vielto`

   Settings:
     slidingDashpot on|off   on (as printed): the tangential dashpot acts while sliding too; off: only while sticking
     radiusLever on|off      on (as printed): lever arms R_i; off: R_i - u_n/2 as LIGGGHTS' own models take

   History, per contact: spring force on body i (3 values, N). Needs `model vielto`. */
#ifdef TANGENTIAL_MODEL
TANGENTIAL_MODEL(TANGENTIAL_VIELTO, vielto, 20)
#else
#ifndef TANGENTIAL_MODEL_VIELTO_H
#define TANGENTIAL_MODEL_VIELTO_H

#include "contact_models.h"
#include "tangential_model_base.h"
#include "vielto_properties.h"
#include "vielto_state.h"
#include "vielto_wall_motion.h"

namespace LIGGGHTS {
namespace ContactModels {

template <>
class TangentialModel<TANGENTIAL_VIELTO> : public TangentialModelBase {
 public:
  TangentialModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : TangentialModelBase(lmp, hsetup, c),
        slidingDashpot_(true),
        leverIsRadius_(true),
        tally_(vielto::tally()),
        wall_(lmp) {
    offset_ = hsetup->add_history_value("vielto_Fsx", "1");
    hsetup->add_history_value("vielto_Fsy", "1");
    hsetup->add_history_value("vielto_Fsz", "1");
  }

  void registerSettings(::Settings& settings) {
    settings.registerOnOff("slidingDashpot", slidingDashpot_, true);
    settings.registerOnOff("radiusLever", leverIsRadius_, true);
  }

  void postSettings(IContactHistorySetup*, ContactModelBase*) {}

  void connectToProperties(PropertyRegistry&) { pairs_.read(lmp); }

  void describe(vielto::LawSettings& s) const {
    s.slidingDashpot = slidingDashpot_;
    s.radiusLever = leverIsRadius_;
    s.slidingAt = offset_;
  }

  VIELTO_INLINE void surfacesIntersect(const SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    using vielto::Vec;
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_TANGENTIAL_MODEL;
    const Vec n = {sidata.en[0], sidata.en[1], sidata.en[2]};
    const Vec wi = {sidata.omega_i[0], sidata.omega_i[1], sidata.omega_i[2]};
    Vec wj;
    if (sidata.is_wall)
      wj = wall_.spin(sidata);
    else
      wj = {sidata.omega_j[0], sidata.omega_j[1], sidata.omega_j[2]};

    // LIGGGHTS' velocity at the contact has lever arms shorter than the radii by u_n/2
    Vec vs = {sidata.vtr1, sidata.vtr2, sidata.vtr3};
    double armI = sidata.cri, armJ = sidata.crj;
    if (leverIsRadius_) {
      vs = vs + (0.5 * sidata.deltan) * cross(n, sidata.is_wall ? wi : wi + wj);
      armI = sidata.radi;
      armJ = sidata.radj;
    }

    const vielto::Stiffness s = {sidata.kn, sidata.kt, sidata.gamman, sidata.gammat};
    const double dt = update->dt;
    const double limit = sidata.Fn > 0 ? pairs_(sidata.itype, sidata.jtype).tanPhi * sidata.Fn : 0.0;
    double* const history = &sidata.contact_history[offset_];
    Vec old = {history[0], history[1], history[2]};
    Vec spring;
    bool sliding = false;
    if (sidata.computeflag && sidata.shearupdate) {
      old = vielto::turned_with_contact(old, n, 0.5 * dt * dot(wi + wj, n));
      spring = vielto::tangential_spring(s, old, vs, dt, limit, sliding);
      history[0] = spring.x;
      history[1] = spring.y;
      history[2] = spring.z;
      if (tally_.energy) account(SurfacesIntersectData(sidata), old, spring, vs, sliding, dt);
    } else {
      spring = old;
      sliding = vielto::cap(spring, limit);
    }
    const bool damped = slidingDashpot_ || !sliding;
    const Vec F = damped ? spring - s.gammaS * vs : spring;
    const Vec arm = cross(n, F);

    const double area = sidata.is_wall ? sidata.area_ratio : 1.0;
    i_forces.delta_F[0] += area * F.x;
    i_forces.delta_F[1] += area * F.y;
    i_forces.delta_F[2] += area * F.z;
    i_forces.delta_torque[0] -= area * armI * arm.x;
    i_forces.delta_torque[1] -= area * armI * arm.y;
    i_forces.delta_torque[2] -= area * armI * arm.z;
    if (!sidata.is_wall) {
      j_forces.delta_F[0] -= F.x;
      j_forces.delta_F[1] -= F.y;
      j_forces.delta_F[2] -= F.z;
      j_forces.delta_torque[0] -= armJ * arm.x;
      j_forces.delta_torque[1] -= armJ * arm.y;
      j_forces.delta_torque[2] -= armJ * arm.z;
    }
  }

  void surfacesClose(SurfacesCloseData& scdata, ForceData&, ForceData&) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_TANGENTIAL_MODEL;
    if (!scdata.contact_history) return;
    double* const history = &scdata.contact_history[offset_];
    history[0] = history[1] = history[2] = 0.0;
  }

  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) {}

 private:
  VIELTO_NOINLINE void account(const SurfacesIntersectData& sidata, const vielto::Vec& old, const vielto::Vec& spring,
                               const vielto::Vec& vs, bool sliding, double dt) {
    const double share = vielto::share(sidata, atom->nlocal, force->newton_pair);
    tally_.elastic += share * 0.5 * dot(spring, spring) / sidata.kt;
    tally_.sliding += share * vielto::capped_spring_loss(old, spring, vs, dt, sidata.kt);
    if (slidingDashpot_ || !sliding) tally_.tangentialDamping += share * sidata.gammat * dot(vs, vs) * dt;
  }

  int offset_;
  bool slidingDashpot_, leverIsRadius_;
  vielto::PairTable pairs_;
  vielto::Tally& tally_;
  vielto::WallMotion wall_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

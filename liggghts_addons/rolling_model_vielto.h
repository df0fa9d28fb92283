// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS adapter of ViElTo's rolling and twisting moments (vielto_law.h). `... rolling_friction vielto`

   Settings:
     rollingDashpot on|off   off (as printed): no viscous rolling and twisting moments, though the text speaks of them;
                             on: -2 beta_s sqrt(k_r I_eff) w_r while the rolling spring is not capped, and the like for
                             twisting with k_tw; I_eff = I_1 I_2/(I_1 + I_2), I = 2/5 m R^2 (wall: I_1)

     wallRolling VALUE       0 (as printed: the smaller mu_r of both bodies); else what walls add to it: a flat grain
   that lies on a wall does not roll as it does on its like

   History, per contact: rolling moment on body i (3 values, N m) and twisting moment along n (1 value, N m).
   On a mesh wall the couples are handed to the mesh's torque sum. Needs `model vielto`. */
#ifdef ROLLING_MODEL
ROLLING_MODEL(ROLLING_VIELTO, vielto, 20)
#else
#ifndef ROLLING_MODEL_VIELTO_H
#define ROLLING_MODEL_VIELTO_H

#include "contact_models.h"
#include "rolling_model_base.h"
#include "vielto_numbers.h"
#include "vielto_properties.h"
#include "vielto_state.h"
#include "vielto_stop.h"
#include "vielto_wall_motion.h"

namespace LIGGGHTS {
namespace ContactModels {

template <>
class RollingModel<ROLLING_VIELTO> : public RollingModelBase {
 public:
  RollingModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : RollingModelBase(lmp, hsetup, c),
        rollingDashpot_(false),
        wallRadiusFactor_(2.0),
        wallRolling_(0.0),
        tally_(vielto::tally()),
        wall_(lmp) {
    offset_ = hsetup->add_history_value("vielto_Mrx", "1");
    hsetup->add_history_value("vielto_Mry", "1");
    hsetup->add_history_value("vielto_Mrz", "1");
    // moment and normal both change sign with the order of the bodies
    hsetup->add_history_value("vielto_Mtw", "0");
  }

  void registerSettings(::Settings& settings) {
    settings.registerOnOff("rollingDashpot", rollingDashpot_, false);
    settings.registerDoubleSetting("wallRadiusFactor", wallRadiusFactor_, 2.0);
    settings.registerDoubleSetting("wallRolling", wallRolling_, 0.0);
  }

  void postSettings(IContactHistorySetup*, ContactModelBase*) {
    for (const char* name : {"wallRadiusFactor", "wallRolling"}) vielto::refuse_no_number(lmp, name);
    if (!(wallRolling_ >= 0)) vielto::stop_all(lmp, "vielto: wallRolling must be >= 0 (0: as printed)");
  }

  void connectToProperties(PropertyRegistry&) { pairs_.read(lmp); }

  void describe(vielto::LawSettings& s) const {
    s.rolling = true;
    s.rollingDashpot = rollingDashpot_;
    s.wallRolling = wallRolling_;
    s.rollingAt = offset_;
  }

  VIELTO_INLINE void surfacesIntersect(SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    using vielto::Vec;
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_ROLLING_MODEL;
    const vielto::Pair& pair = pairs_(sidata.itype, sidata.jtype);
    const double R1 = sidata.radi;
    const double R2 = sidata.is_wall ? wallRadiusFactor_ * R1 : sidata.radj;
    const Vec n = {sidata.en[0], sidata.en[1], sidata.en[2]};
    const Vec wi = {sidata.omega_i[0], sidata.omega_i[1], sidata.omega_i[2]};
    Vec wj;
    if (sidata.is_wall)
      wj = wall_.spin(sidata);
    else
      wj = {sidata.omega_j[0], sidata.omega_j[1], sidata.omega_j[2]};
    const Vec w = wi - wj;
    const double wtw = dot(w, n);
    const Vec wr = w - wtw * n;

    const double kr = vielto::rolling_stiffness(pair, sidata.kn, R1, R2);
    const double ktw = vielto::twisting_stiffness(pair, sidata.kt, R1, R2);
    const double force_length = sidata.Fn > 0 ? sidata.Fn * vielto::rolling_length(R1, R2) : 0.0;
    const double limitR = (sidata.is_wall ? pair.muR + wallRolling_ : pair.muR) * force_length;
    const double limitTw = pair.muTwTanPhi * force_length;
    const double dt = update->dt;

    double* const history = &sidata.contact_history[offset_];
    Vec old = {history[0], history[1], history[2]};
    Vec Mr = old;
    double Mtw = history[3];
    bool rolling = false, twisting = false;
    if (sidata.computeflag && sidata.shearupdate) {
      old = vielto::turned_with_contact(old, n, 0.5 * dt * dot(wi + wj, n));
      Mr = vielto::rolling_spring(kr, old, wr, dt, limitR, rolling);
      const double oldTw = Mtw;
      Mtw = vielto::twisting_spring(ktw, oldTw, wtw, dt, limitTw, twisting);
      history[0] = Mr.x;
      history[1] = Mr.y;
      history[2] = Mr.z;
      history[3] = Mtw;
      if (tally_.energy) account(SurfacesIntersectData(sidata), old, Mr, wr, kr, oldTw, Mtw, wtw, ktw);
    } else {
      rolling = vielto::cap(Mr, limitR);
      if (std::fabs(Mtw) > limitTw) Mtw = std::copysign(limitTw, Mtw);
    }

    Vec M = Mr + Mtw * n;
    if (rollingDashpot_)
      M = M + dashpot(SurfacesIntersectData(sidata), pair, R1, R2, kr, ktw, rolling ? Vec{0, 0, 0} : wr,
                      twisting ? 0.0 : wtw, n);

    const double area = sidata.is_wall ? sidata.area_ratio : 1.0;
    i_forces.delta_torque[0] += area * M.x;
    i_forces.delta_torque[1] += area * M.y;
    i_forces.delta_torque[2] += area * M.z;
    if (!sidata.is_wall) {
      j_forces.delta_torque[0] -= M.x;
      j_forces.delta_torque[1] -= M.y;
      j_forces.delta_torque[2] -= M.z;
    } else if (sidata.computeflag) {
      wall_.add_couple(sidata, -area * M);
    }
  }

  void surfacesClose(SurfacesCloseData& scdata, ForceData&, ForceData&) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_ROLLING_MODEL;
    if (!scdata.contact_history) return;
    double* const history = &scdata.contact_history[offset_];
    history[0] = history[1] = history[2] = history[3] = 0.0;
  }

  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) {}

 private:
  VIELTO_NOINLINE void account(const SurfacesIntersectData& sidata, const vielto::Vec& old, const vielto::Vec& Mr,
                               const vielto::Vec& wr, double kr, double oldTw, double Mtw, double wtw, double ktw) {
    const double share = vielto::share(sidata, atom->nlocal, force->newton_pair), dt = update->dt;
    tally_.rolling += share * vielto::capped_spring_loss(old, Mr, wr, dt, kr);
    tally_.twisting += share * vielto::capped_spring_loss(oldTw, Mtw, wtw, dt, ktw);
    if (kr > 0) tally_.elastic += share * 0.5 * dot(Mr, Mr) / kr;
    if (ktw > 0) tally_.elastic += share * 0.5 * Mtw * Mtw / ktw;
  }

  // Viscous moments; the loss is booked with rolling and twisting.
  VIELTO_NOINLINE vielto::Vec dashpot(const SurfacesIntersectData& sidata, const vielto::Pair& pair, double R1,
                                      double R2, double kr, double ktw, const vielto::Vec& wr, double wtw,
                                      const vielto::Vec& n) {
    const double I1 = 0.4 * sidata.mi * R1 * R1;
    const double I2 = 0.4 * sidata.mj * R2 * R2;
    const double Ieff = sidata.is_wall ? I1 : I1 * I2 / (I1 + I2);
    const double cr = 2 * pair.betaS * std::sqrt(kr * Ieff);
    const double ctw = 2 * pair.betaS * std::sqrt(ktw * Ieff);
    if (tally_.energy && sidata.computeflag && sidata.shearupdate) {
      const double share = vielto::share(sidata, atom->nlocal, force->newton_pair);
      tally_.rolling += share * cr * dot(wr, wr) * update->dt;
      tally_.twisting += share * ctw * wtw * wtw * update->dt;
    }
    return -cr * wr - (ctw * wtw) * n;
  }

  int offset_;
  bool rollingDashpot_;
  double wallRadiusFactor_, wallRolling_;
  vielto::PairTable pairs_;
  vielto::Tally& tally_;
  vielto::WallMotion wall_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

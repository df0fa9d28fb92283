// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS adapter of the law CohFrictPhys (cohfrict_law.h). `pair_style gran model cohfrict ...`

   The whole law in one model, without `tangential` and `rolling_friction`: a bond that breaks in shear changes the
   normal force too, and a stretched bond pulls where LIGGGHTS sees no contact any more.

   Settings:
     bondNewContacts on|off   on: every new contact coheres; off (as Yade): none does, friction only
     avoidRatcheting on|off   on (as Yade): the scaled slip between spheres; walls never have it
     wallRadiusFactor VALUE   R_2/R_1 of a wall, default 2 (what Yade takes for a facet)

   Properties: cohfrict_properties.h.

   History, per contact: tangential force (3), rolling moment (3), both on body i; twisting moment along n; state: 0
   none, 1 bonded, 2 touching. */
#ifdef NORMAL_MODEL
NORMAL_MODEL(COHFRICT, cohfrict, 21)
#else
#ifndef NORMAL_MODEL_COHFRICT_H
#define NORMAL_MODEL_COHFRICT_H

#include <math.h>

#include "cohfrict_properties.h"
#include "contact_models.h"
#include "neighbor.h"
#include "normal_model_base.h"
#include "vielto_numbers.h"
#include "vielto_overlap.h"
#include "vielto_state.h"
#include "vielto_stop.h"
#include "vielto_wall_motion.h"

namespace LIGGGHTS {
namespace ContactModels {

template <>
class NormalModel<COHFRICT> : public NormalModelBase {
 public:
  NormalModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : NormalModelBase(lmp, hsetup, c),
        bondNewContacts_(false),
        avoidRatcheting_(true),
        wallRadiusFactor_(2.0),
        tally_(vielto::tally()),
        wall_(lmp) {
    offset_ = hsetup->add_history_value("cohfrict_Fsx", "1");
    hsetup->add_history_value("cohfrict_Fsy", "1");
    hsetup->add_history_value("cohfrict_Fsz", "1");
    hsetup->add_history_value("cohfrict_Mrx", "1");
    hsetup->add_history_value("cohfrict_Mry", "1");
    hsetup->add_history_value("cohfrict_Mrz", "1");
    // moment and normal both change sign with the order of the bodies
    hsetup->add_history_value("cohfrict_Mtw", "0");
    hsetup->add_history_value("cohfrict_state", "0");
  }

  void registerSettings(::Settings& settings) {
    settings.registerOnOff("bondNewContacts", bondNewContacts_, false);
    settings.registerOnOff("avoidRatcheting", avoidRatcheting_, true);
    settings.registerDoubleSetting("wallRadiusFactor", wallRadiusFactor_, 2.0);
    settings.registerDoubleSetting("maxOverlap", overlaps_.limit, 0.0);
  }

  void postSettings(IContactHistorySetup*, ContactModelBase* cmb) {
    for (const char* name : {"wallRadiusFactor", "maxOverlap"}) vielto::refuse_no_number(lmp, name);
    if (!(wallRadiusFactor_ > 0)) vielto::stop_all(lmp, "cohfrict: wallRadiusFactor must be > 0 (default 2)");
    overlaps_.check_limit(lmp);
    if (!cmb->is_wall()) vielto::settings() = {1.0, wallRadiusFactor_, COHFRICT, overlaps_.limit};
  }

  void connectToProperties(PropertyRegistry&) {
    pairs_.read(lmp);
    // 1.1: the step in which a bond is seen to be broken has to be seen too
    if (bondNewContacts_) neighbor->register_contact_dist_factor(1 + 1.1 * pairs_.stretch_bound());
    if (force->cg_active()) error->cg(FLERR, "model cohfrict");
  }

  // the normal spring is linear
  double stressStrainExponent() { return 1.; }

  void surfacesIntersect(SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    const vielto::Vec n = {sidata.en[0], sidata.en[1], sidata.en[2]};
    double* const history = &sidata.contact_history[offset_];
    const bool bonded = history[STATE] == BONDED || (history[STATE] == NONE && bondNewContacts_);
    sidata.Fn = 0.0;
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_NORMAL_MODEL;
    evaluate(sidata, n, sidata.deltan, bonded, sidata.Fn, i_forces, j_forces);
    if (sidata.computeflag && sidata.shearupdate) overlaps_.note(lmp, sidata, vielto::smaller_diameter(sidata));
  }

  // A stretched bond. LIGGGHTS calls this up to the contact distance that connectToProperties asked for.
  void surfacesClose(SurfacesCloseData& scdata, ForceData& i_forces, ForceData& j_forces) {
    if (!scdata.contact_history) return;
    double Fn;
    bool held = false;
    if (scdata.contact_history[offset_ + STATE] == BONDED) {
      const double r = sqrt(scdata.rsq);
      const vielto::Vec n = {scdata.delta[0] / r, scdata.delta[1] / r, scdata.delta[2] / r};
      held = evaluate(scdata, n, scdata.radsum - r, true, Fn, i_forces, j_forces);
    }
    if (held)
      scdata.has_force_update = true;
    else if (scdata.contact_flags)
      *scdata.contact_flags &= ~CONTACT_NORMAL_MODEL;
  }

  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) {}

 private:
  enum { STATE = 7, VALUES = 8 };
  enum { NONE = 0, BONDED = 1, TOUCHING = 2 };

  // Forces of one contact, touching or stretched; false where it has ended, then without force and with an empty
  // history.
  template <class Data>
  bool evaluate(const Data& data, const vielto::Vec& n, double overlap, bool bonded, double& Fn, ForceData& i_forces,
                ForceData& j_forces) {
    using vielto::Vec;
    const double R1 = data.radi, R2 = data.is_wall ? wallRadiusFactor_ * R1 : data.radj;
    const cohfrict::Contact c = cohfrict::contact(pairs_(data.itype, data.jtype), R1, R2);
    // LIGGGHTS hands over spins of touching grains only
    const Vec wi = vec(atom->omega[data.i]);
    const Vec wj = data.is_wall ? wall_.spin(data) : vec(atom->omega[data.j]);
    const Vec w = wi - wj;
    const double dt = update->dt;

    cohfrict::Motion m;
    m.n = n;
    m.overlap = overlap;
    m.slip = cohfrict::slip(n, vec(data.v_i) - vec(data.v_j), wi, wj, R1, data.is_wall ? 0.0 : R2, overlap,
                            avoidRatcheting_ && !data.is_wall);
    m.twisting = dot(w, n);
    m.rolling = w - m.twisting * n;
    m.spinAngle = 0.5 * dt * dot(wi + wj, n);

    double* const history = &data.contact_history[offset_];
    cohfrict::Memory memory = {vec(history), vec(history + 3), history[6], bonded};
    cohfrict::Load load;
    // between runs forces are computed anew, but nothing moves on
    const bool moves = data.computeflag && data.shearupdate;
    cohfrict::Energy energy;
    const bool holds =
        cohfrict::advance(c, m, moves ? dt : 0.0, memory, load, tally_.energy && moves ? &energy : nullptr);
    if (moves) {
      if (tally_.energy) book(energy, vielto::share(data, atom->nlocal, force->newton_pair));
      for (int k = 0; k < VALUES; k++) history[k] = 0.0;
      if (holds) {
        put(memory.shear, history);
        put(memory.rolling, history + 3);
        history[6] = memory.twist;
        history[STATE] = memory.bonded ? BONDED : TOUCHING;
      }
    }
    if (!holds) return false;
    Fn = load.normal;

    const double area = data.is_wall ? data.area_ratio : 1.0;
    const Vec F = area * (load.normal * n + load.shear), arm = area * cross(n, load.shear), M = area * load.moment;
    add(i_forces.delta_F, F);
    add(i_forces.delta_torque, M - (R1 - 0.5 * overlap) * arm);
    if (!data.is_wall) {
      add(j_forces.delta_F, -1 * F);
      add(j_forces.delta_torque, -1 * M - (R2 - 0.5 * overlap) * arm);
    } else if (data.computeflag) {
      wall_.add_couple(data, -1 * M);
    }
    return true;
  }

  void book(const cohfrict::Energy& energy, double share) {
    tally_.elastic += share * energy.elastic;
    tally_.sliding += share * energy.sliding;
    tally_.rolling += share * energy.rolling;
    tally_.twisting += share * energy.twisting;
  }

  static vielto::Vec vec(const double* a) { return {a[0], a[1], a[2]}; }
  static void put(const vielto::Vec& a, double* to) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }
  static void add(double* to, const vielto::Vec& a) { to[0] += a.x, to[1] += a.y, to[2] += a.z; }

  int offset_;
  bool bondNewContacts_, avoidRatcheting_;
  double wallRadiusFactor_;
  vielto::OverlapWatch overlaps_;
  cohfrict::PairTable pairs_;
  vielto::Tally& tally_;
  vielto::WallMotion wall_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

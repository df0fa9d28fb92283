// SPDX-License-Identifier: GPL-2.0-or-later
/* LIGGGHTS' own models `hertz` and `hooke`, watched: the same forces, bit for bit, from LIGGGHTS' own headers, and what
   the records of this package ask of a law: overlaps, a stop at the overlap limit, the time scale of a contact.
   `pair_style gran model hertz/watched tangential history rolling_friction epsd2`, `model hooke/watched ...`

   Settings: those of the stock model, and
     maxOverlap VALUE  stop the run when an overlap exceeds VALUE times the diameter of the smaller grain, as in
                       normal_model_vielto.h; default 0: no limit, refused by hertz, whose stiffness and so whose time
                       step has no bound without it

   One thing differs from the stock model: the history of a contact ends with it. LIGGGHTS' pair loop clears it only
   when some model asks for a contact distance; without, a tangential spring is still there when the same grains meet
   again. */
#ifdef NORMAL_MODEL
// clang-format off
NORMAL_MODEL(HERTZ_WATCHED, hertz/watched, 22)
NORMAL_MODEL(HOOKE_WATCHED, hooke/watched, 23)
// clang-format on
#else
#ifndef NORMAL_MODEL_STOCK_H
#define NORMAL_MODEL_STOCK_H

#include "contact_models.h"
#include "neighbor.h"
#include "normal_model_hertz.h"
#include "normal_model_hooke.h"
#include "vielto_numbers.h"
#include "vielto_overlap.h"
#include "vielto_state.h"
#include "vielto_stop.h"

namespace LIGGGHTS {
namespace ContactModels {

template <int Stock>
class WatchedModel : public NormalModel<Stock> {
  typedef NormalModel<Stock> Base;

 public:
  WatchedModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : Base(lmp, hsetup, c), tally_(vielto::tally()) {}

  void registerSettings(::Settings& settings) {
    Base::registerSettings(settings);
    settings.registerDoubleSetting("maxOverlap", overlaps_.limit, 0.0);
  }

  void postSettings(IContactHistorySetup* hsetup, ContactModelBase* cmb) {
    vielto::refuse_no_number(this->lmp, "maxOverlap");
    Base::postSettings(hsetup, cmb);
    overlaps_.check_limit(this->lmp);
    const bool hertz = Stock == HERTZ;
    if (hertz && overlaps_.limit == 0)
      vielto::stop_all(this->lmp,
                       "vielto: hertz needs a maxOverlap > 0: its stiffness, and so its time step, has no other bound");
    if (cmb->is_wall()) return;
    vielto::Settings& shared = vielto::settings();
    shared.law = hertz ? HERTZ_WATCHED : HOOKE_WATCHED;
    shared.maxOverlap = overlaps_.limit;
  }

  void connectToProperties(PropertyRegistry& registry) {
    Base::connectToProperties(registry);
    this->neighbor->register_contact_dist_factor(1.01);
  }

  void surfacesIntersect(SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    Base::surfacesIntersect(sidata, i_forces, j_forces);
    if (!sidata.computeflag || !sidata.shearupdate) return;
    const double diameter = vielto::smaller_diameter(sidata);
    if (sidata.deltan > tally_.overlapMax * diameter || (sidata.is_wall && sidata.Fn > tally_.wallForce) ||
        tally_.overlaps)
      overlaps_.note(this->lmp, SurfacesIntersectData(sidata), diameter);
  }

 private:
  vielto::OverlapWatch overlaps_;
  vielto::Tally& tally_;
};

template <>
class NormalModel<HERTZ_WATCHED> : public WatchedModel<HERTZ> {
 public:
  NormalModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : WatchedModel<HERTZ>(lmp, hsetup, c) {}
};

template <>
class NormalModel<HOOKE_WATCHED> : public WatchedModel<HOOKE> {
 public:
  NormalModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : WatchedModel<HOOKE>(lmp, hsetup, c) {}
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

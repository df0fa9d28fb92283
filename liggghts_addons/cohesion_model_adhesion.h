// SPDX-License-Identifier: GPL-2.0-or-later
/* Adhesion of touching grains: a constant attraction, as large as gives a bed of grains the tensile strength sigma_t.
   `cohesion adhesion`

     F_a = eps/(1 - eps) sigma_t d_1 d_2   of two grains
     F_a = eps/(1 - eps) sigma_t d_1^2     of a grain and a wall

   Source: Rumpf's strength of a bed of equal spheres, sigma_t = (1 - eps)/eps F/d^2 (H. Rumpf, 1970, Chem. Ing. Tech.
   42:538), turned round at the porosity eps = 0.4. Because F goes as d^2, a bed of coarser grains has the same
   strength.

   Why not sjkr or sjkr2: their pull is proportional to the overlap, as ViElTo's spring is. Together they are a weaker
   spring, which attracts at no overlap at all below an energy density of 8 E/(2 pi) (equal spheres, springFactor 4).

   Acts along the normal while the surfaces overlap; does not enter the friction cap itself, but the spring that bears
   it does (Thornton 1991, J. Phys. D 24:1942). The overlap of two grains at rest is F_a/(c_n k_n).

   Property: fix adhesionStrength all property/global adhesionStrength scalar SIGMA_T, Pa, >= 0. */
#ifdef COHESION_MODEL
COHESION_MODEL(COHESION_ADHESION, adhesion, 20)
#else
#ifndef COHESION_MODEL_ADHESION_H
#define COHESION_MODEL_ADHESION_H

#include "cohesion_model_base.h"
#include "contact_models.h"
#include "global_properties.h"
#include "pointers.h"
#include "vielto_state.h"

namespace vielto {

constexpr double kBedPorosity = 0.4;

// N; d2 = d1 for a wall.
inline double adhesion_force(double strength, double d1, double d2) {
  return kBedPorosity / (1 - kBedPorosity) * strength * d1 * d2;
}

inline ScalarProperty* create_adhesion_strength(PropertyRegistry& registry, const char* caller, bool) {
  return MODEL_PARAMS::createScalarProperty(registry, "adhesionStrength", caller, true, 0.0);
}

}  // namespace vielto

namespace LIGGGHTS {
namespace ContactModels {

template <>
class CohesionModel<COHESION_ADHESION> : public CohesionModelBase {
 public:
  CohesionModel(LAMMPS* lmp, IContactHistorySetup* hsetup, class ContactModelBase* c)
      : CohesionModelBase(lmp, hsetup, c), strength_(0) {}

  void registerSettings(Settings&) {}
  void postSettings(IContactHistorySetup*, ContactModelBase*) {}

  void connectToProperties(PropertyRegistry& registry) {
    registry.registerProperty("adhesionStrength", &vielto::create_adhesion_strength);
    registry.connect("adhesionStrength", strength_, "cohesion_model adhesion");
  }

  void describe(vielto::LawSettings& s) const { s.adhesion = vielto::adhesion_force(strength_, 1, 1); }

  void surfacesIntersect(SurfacesIntersectData& sidata, ForceData& i_forces, ForceData& j_forces) {
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_COHESION_MODEL;
    const double d1 = 2 * sidata.radi, d2 = sidata.is_wall ? d1 : 2 * sidata.radj;
    // a grain on the edge between triangles touches each with a part of its area
    const double pull = vielto::adhesion_force(strength_, d1, d2) * (sidata.is_wall ? sidata.area_ratio : 1.0);
    for (int k = 0; k < 3; k++) {
      i_forces.delta_F[k] -= pull * sidata.en[k];
      if (!sidata.is_wall) j_forces.delta_F[k] += pull * sidata.en[k];
    }
  }

  void endSurfacesIntersect(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void surfacesClose(SurfacesCloseData& scdata, ForceData&, ForceData&) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_COHESION_MODEL;
  }
  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) {}

 private:
  double strength_;  // Pa
};

}  // namespace ContactModels
}  // namespace LIGGGHTS
#endif
#endif

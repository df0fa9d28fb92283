// SPDX-License-Identifier: GPL-2.0-or-later
/* Material properties of CohFrictPhys as LIGGGHTS knows them: `fix ID all property/global NAME peratomtype V1 V2 ...`.

   name                                          range     unit
   youngsModulus, stiffnessRatio, frictionAngle  as in vielto_properties.h
   alphaKr, alphaKtw                             >= 0      1     rolling and twisting stiffness over k_s R_1R_2
   etaRoll, etaTwist                             any       1     arm of the moments' limits over R; < 0: no limit
   normalCohesion, shearCohesion                 >= 0      Pa    C_n, C_s
*/
#ifndef COHFRICT_PROPERTIES_H
#define COHFRICT_PROPERTIES_H

#include <algorithm>
#include <limits>
#include <vector>

#include "cohfrict_law.h"
#include "vielto_properties.h"

namespace cohfrict {

enum {
  YOUNG,
  RATIO,
  FRICTION,
  ALPHA_KR,
  ALPHA_KTW,
  ETA_ROLL,
  ETA_TWIST,
  NORMAL_COHESION,
  SHEAR_COHESION,
  N_PROPERTIES
};

inline const vielto::PropertyRule* property_rules() {
  static const double inf = std::numeric_limits<double>::infinity();
  static const vielto::PropertyRule* const shared = vielto::property_rules();
  static const vielto::PropertyRule rules[N_PROPERTIES] = {shared[vielto::YOUNG],
                                                           shared[vielto::RATIO],
                                                           shared[vielto::FRICTION],
                                                           {"alphaKr", 0, inf, true, false, "1"},
                                                           {"alphaKtw", 0, inf, true, false, "1"},
                                                           {"etaRoll", -inf, inf, false, false, "1"},
                                                           {"etaTwist", -inf, inf, false, false, "1"},
                                                           {"normalCohesion", 0, inf, true, false, "Pa"},
                                                           {"shearCohesion", 0, inf, true, false, "Pa"}};
  return rules;
}

// Mixed constants of all pairs of types; the table the adapter looks up.
class PairTable {
 public:
  PairTable() : n_(0), stretch_(0) {}

  void read(LAMMPS_NS::LAMMPS* lmp) {
    const double inf = std::numeric_limits<double>::infinity(), degree = std::acos(-1.0) / 180;
    std::vector<double> v[N_PROPERTIES];
    for (int k = 0; k < N_PROPERTIES; k++) v[k] = vielto::read_property(lmp, property_rules()[k]);
    n_ = lmp->atom->ntypes + 1;
    std::vector<Material> materials(n_);
    double youngMin = inf, cohesionMax = 0;
    for (int t = 1; t < n_; t++) {
      const Material m = {v[0][t], v[1][t], v[2][t] * degree, v[3][t], v[4][t], v[5][t], v[6][t], v[7][t], v[8][t]};
      materials[t] = m;
      youngMin = std::min(youngMin, m.young);
      cohesionMax = std::max(cohesionMax, m.normalCohesion);
    }
    stretch_ = cohfrict::stretch_bound(cohesionMax, youngMin);
    pairs_.resize(n_ * n_);
    for (int i = 1; i < n_; i++)
      for (int j = 1; j < n_; j++) pairs_[i * n_ + j] = mix(materials[i], materials[j]);
  }

  const Pair& operator()(int itype, int jtype) const { return pairs_[itype * n_ + jtype]; }
  // Longest stretch of a bond over the sum of the radii.
  double stretch_bound() const { return stretch_; }

 private:
  int n_;
  double stretch_;
  std::vector<Pair> pairs_;
};

}  // namespace cohfrict

#endif

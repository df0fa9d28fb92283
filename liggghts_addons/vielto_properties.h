// SPDX-License-Identifier: GPL-2.0-or-later
/* Material properties of ViElTo as LIGGGHTS knows them: `fix ID all property/global NAME peratomtype V1 V2 ...`.

   name                      range        unit
   youngsModulus             > 0          Pa    (stock limits on E do not apply: softness is a numerical choice)
   stiffnessRatio            (0, 1]       1     nu = k_s/k_n
   frictionAngle             [0, 90)      deg
   normalDamping             >= 0         1     beta_n
   tangentialDamping         >= 0         1     beta_s
   rollingStiffnessFactor    >= 0         1     beta_kr
   twistingStiffnessFactor   >= 0         1     beta_ktw
   rollingResistance         >= 0         1     mu_r
   twistingResistance        >= 0         1     mu_tw

   A missing property, one of the wrong length and a value out of range each stop the run with one line that
   names the property. */
#ifndef VIELTO_PROPERTIES_H
#define VIELTO_PROPERTIES_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <limits>
#include <string>
#include <vector>

#include "atom.h"
#include "error.h"
#include "fix_property_global.h"
#include "modify.h"
#include "pointers.h"
#include "vielto_law.h"
#include "vielto_stop.h"

namespace vielto {

struct PropertyRule {
  const char* name;
  double low, high;
  bool lowAllowed, highAllowed;
  const char* unit;
};

enum { YOUNG, RATIO, FRICTION, DAMP_N, DAMP_S, BETA_KR, BETA_KTW, MU_R, MU_TW, N_PROPERTIES };

inline const PropertyRule* property_rules() {
  static const double inf = std::numeric_limits<double>::infinity();
  static const PropertyRule rules[N_PROPERTIES] = {
      {"youngsModulus", 0, inf, false, false, "Pa"},         {"stiffnessRatio", 0, 1, false, true, "1"},
      {"frictionAngle", 0, 90, true, false, "deg"},          {"normalDamping", 0, inf, true, false, "1"},
      {"tangentialDamping", 0, inf, true, false, "1"},       {"rollingStiffnessFactor", 0, inf, true, false, "1"},
      {"twistingStiffnessFactor", 0, inf, true, false, "1"}, {"rollingResistance", 0, inf, true, false, "1"},
      {"twistingResistance", 0, inf, true, false, "1"},
  };
  return rules;
}

// A fix property/global by its variable name, or NULL. LIGGGHTS' own search demands the length beforehand.
inline LAMMPS_NS::FixPropertyGlobal* find_property(LAMMPS_NS::LAMMPS* lmp, const char* name) {
  static const char* const forms[] = {"peratomtype", "vector", "scalar", "peratomtypepair", "matrix"};
  for (int f = 0; f < 5; f++) {
    LAMMPS_NS::Fix* fix = lmp->modify->find_fix_property(name, "property/global", forms[f], 0, 0, "vielto", false);
    if (fix) return static_cast<LAMMPS_NS::FixPropertyGlobal*>(fix);
  }
  return NULL;
}

// A friction angle below 2 degrees is rarely meant; in radians every one is.
inline void warn_of_radians(LAMMPS_NS::LAMMPS* lmp, const std::vector<double>& angles) {
  static bool said = false;
  for (std::size_t t = 1; t < angles.size() && !said; t++)
    if (angles[t] > 0 && angles[t] < 2) {
      char line[200];
      snprintf(
          line, sizeof line,
          "vielto: frictionAngle of type %d is %g degrees; is that radians? (%.4g degrees, or a coefficient: %.4g)",
          static_cast<int>(t), angles[t], angles[t] * 180 / acos(-1.0), atan(angles[t]) * 180 / acos(-1.0));
      lmp->error->warning(FLERR, line);
      said = true;
    }
}

// Values of one property for types 1..ntypes; out[0] is unused. Stops the run with a line that names the property.
inline std::vector<double> read_property(LAMMPS_NS::LAMMPS* lmp, const PropertyRule& rule) {
  const int ntypes = lmp->atom->ntypes;
  char line[512];
  LAMMPS_NS::FixPropertyGlobal* fix = find_property(lmp, rule.name);
  if (!fix) {
    snprintf(line, sizeof line,
             "vielto: property %s is missing; add 'fix ID all property/global %s peratomtype VALUE' with one value "
             "(%s) for each of the %d types",
             rule.name, rule.name, rule.unit, ntypes);
    stop_all(lmp, line);
  }
  // a peratomtype property's own check knows its true length
  if (fix->size_vector != ntypes) {
    snprintf(line, sizeof line,
             "vielto: property %s has %d values, but there are %d types; give one value (%s) for each type", rule.name,
             fix->size_vector, ntypes, rule.unit);
    stop_all(lmp, line);
  }
  std::vector<double> values(ntypes + 1, 0.0);
  for (int t = 1; t <= ntypes; t++) {
    const double v = fix->compute_vector(t - 1);
    const bool tooLow = rule.lowAllowed ? v < rule.low : v <= rule.low;
    const bool tooHigh = rule.highAllowed ? v > rule.high : v >= rule.high;
    if (isnan(v) || isinf(v) || tooLow || tooHigh) {
      snprintf(line, sizeof line, "vielto: property %s of type %d is %g, out of its range %s%g, %g%s (%s)", rule.name,
               t, v, rule.lowAllowed ? "[" : "(", rule.low, rule.high, rule.highAllowed ? "]" : ")", rule.unit);
      stop_all(lmp, line);
    }
    values[t] = v;
  }
  if (!strcmp(rule.name, "frictionAngle")) warn_of_radians(lmp, values);
  return values;
}

// Materials of all types, index 1..ntypes.
inline std::vector<Material> read_materials(LAMMPS_NS::LAMMPS* lmp) {
  const PropertyRule* rules = property_rules();
  std::vector<double> columns[N_PROPERTIES];
  for (int p = 0; p < N_PROPERTIES; p++) columns[p] = read_property(lmp, rules[p]);
  const double degree = acos(-1.0) / 180;
  std::vector<Material> materials(lmp->atom->ntypes + 1);
  for (int t = 1; t <= lmp->atom->ntypes; t++) {
    Material& m = materials[t];
    m.youngsModulus = columns[YOUNG][t];
    m.stiffnessRatio = columns[RATIO][t];
    m.frictionAngle = columns[FRICTION][t] * degree;
    m.normalDamping = columns[DAMP_N][t];
    m.tangentialDamping = columns[DAMP_S][t];
    m.rollingStiffnessFactor = columns[BETA_KR][t];
    m.twistingStiffnessFactor = columns[BETA_KTW][t];
    m.rollingResistance = columns[MU_R][t];
    m.twistingResistance = columns[MU_TW][t];
  }
  return materials;
}

// Mixed constants of all pairs of types; the table the adapters look up.
class PairTable {
 public:
  PairTable() : n_(0) {}
  void read(LAMMPS_NS::LAMMPS* lmp) {
    const std::vector<Material> materials = read_materials(lmp);
    n_ = lmp->atom->ntypes + 1;
    pairs_.resize(n_ * n_);
    for (int i = 1; i < n_; i++)
      for (int j = 1; j < n_; j++) pairs_[i * n_ + j] = mix(materials[i], materials[j]);
  }
  const Pair& operator()(int itype, int jtype) const { return pairs_[place(itype, jtype)]; }
  int place(int itype, int jtype) const { return itype * n_ + jtype; }
  const Pair* all() const { return pairs_.data(); }
  bool empty() const { return pairs_.empty(); }

 private:
  int n_;
  std::vector<Pair> pairs_;
};

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
#include <limits>

#include "engine/card_mapping.h"
#include "plugin/law_registration.h"
#include "vielto_state.h"

namespace vielto {

/* The card's grain, made plastic: it loads along ViElTo's spring, its restitution is that of ViElTo's dashpot at every
   speed, and sliding, rolling and twisting are ViElTo's own models with the card's values. What changes is how the
   normal direction dissipates: with the greatest overlap instead of the speed. */
Law describe_walton_braun() {
  const double inf = std::numeric_limits<double>::infinity();
  Law law;
  law.name = "walton_braun";
  law.summary =
      "Linear hysteretic law for plastic grains: unloads along a stiffer spring than it loads, without a normal "
      "dashpot.";
  law.source = "O. R. Walton and R. L. Braun (1986), J. Rheology 30:949";
  law.header = "liggghts_addons/law/walton_braun_law.h";
  law.yade = "Law2_ScGeom_LudingPhys_Basic without cohesion and viscosity comes near; not compared here";
  law.id = WALTON_BRAUN;
  law.normal = "walton_braun";
  law.tangential = law.rolling = "vielto";
  law.clumps = true;
  law.cohesions = {"adhesion"};
  for (const char* name : {"springFactor", "wallRadiusFactor", "maxOverlap", "slidingDashpot", "radiusLever",
                           "rollingDashpot", "wallRolling"})
    law.settings.push_back({name, std::string("${") + name + "}"});
  law.parameters = {
      {{"unloadingHardening", 0, inf, true, false, "1"},
       "0",
       "-",
       "h: how much stiffer a contact unloads that was pressed deeper; 0: the same restitution at every speed"}};
  law.properties = vielto_properties_of_cards();
  // its tangential and rolling models read all of ViElTo's properties
  law.properties[DAMP_N].grain = law.properties[DAMP_N].wall = "0";
  law.properties.push_back({law.parameters[0].rule, LawProperty::SCALAR, "${unloadingHardening}", ""});
  map_restitution(law);
  law.friction = "frictionAngle";
  // its restitution is that of a dashpot which may pull; and its own force never does
  law.lacks = {"limitForce=off"};
  law.differs = {"normalDamping stands for the restitution, which has no dashpot", "the normal force never pulls"};
  law.energies = {
      "elastic", "normal hysteresis (in the column of the normal dashpot)", "tangential dashpot", "sliding", "rolling",
      "twisting"};
  law.timeScale =
      "as vielto, the normal spring with its unloading stiffness k_2, with hardening that at u = maxOverlap";
  law.half_period = [](LAMMPS_NS::LAMMPS* lmp) -> HalfPeriod {
    PairTable pairs;
    pairs.read(lmp);
    walton_braun::Properties own;
    own.read(lmp);
    return [pairs, own](int i, int j, double R1, double m1, double R2, double m2) {
      const Pair& p = pairs(i, j);
      const Stiffness s = stiffness(p, R1, R2, m1);
      // the greatest overlap allowed over the diameter, which is all that the stiffness depends on
      const double k2 = walton_braun::unloading_stiffness(settings().springFactor * s.kn, own.restitution(i, j),
                                                          own.hardening(), settings().maxOverlap, 1.0);
      const Springs k = {k2, s.ks, rolling_stiffness(p, s.kn, R1, R2), twisting_stiffness(p, s.ks, R1, R2)};
      return shortest_half_period(k, R1, m1, R2, m2);
    };
  };
  return law;
}

VIELTO_TOUCHING(Plastic, WALTON_BRAUN, TANGENTIAL_VIELTO)
VIELTO_TOUCHING(PlasticRolling, WALTON_BRAUN, TANGENTIAL_VIELTO, COHESION_OFF, ROLLING_VIELTO)
VIELTO_TOUCHING(PlasticAdhesion, WALTON_BRAUN, TANGENTIAL_VIELTO, COHESION_ADHESION)
VIELTO_TOUCHING(PlasticAdhesionRolling, WALTON_BRAUN, TANGENTIAL_VIELTO, COHESION_ADHESION, ROLLING_VIELTO)

namespace {

const LawRegistration registration(describe_walton_braun(), [] {
  add_touching<Plastic>();
  add_touching<PlasticRolling>();
  add_touching<PlasticAdhesion>();
  add_touching<PlasticAdhesionRolling>();
});

}  // namespace
}  // namespace vielto

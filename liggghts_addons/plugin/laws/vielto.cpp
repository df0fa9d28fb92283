// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/card_mapping.h"
#include "plugin/law_registration.h"
#include "vielto_state.h"

namespace vielto {

Law describe_vielto() {
  Law law;
  law.name = "vielto";
  law.summary = "Linear viscoelastic law with sliding, rolling and twisting resistance.";
  law.source = "D. Horvath, PhD thesis booklet, BME Budapest 2024, Thesis 2";
  law.header = "liggghts_addons/law/vielto_law.h";
  law.yade =
      "in two halves: Law2_ScGeom_ViscElPhys_Basic, and for the moments Law2_ScGeom6D_CohFrictPhys_CohesionMoment "
      "(yade/README.md)";
  law.id = VIELTO;
  law.normal = law.tangential = law.rolling = "vielto";
  law.cohesions = {"adhesion", "sjkr", "sjkr2"};
  for (const char* name : {"springFactor", "wallRadiusFactor", "limitForce", "maxOverlap", "slidingDashpot",
                           "radiusLever", "rollingDashpot", "wallRolling"})
    law.settings.push_back({name, std::string("${") + name + "}"});
  law.properties = vielto_properties_of_cards();
  law.friction = "frictionAngle";
  law.energies = {"elastic", "normal dashpot", "tangential dashpot", "sliding", "rolling", "twisting"};
  law.clumps = true;
  law.timeScale = "the stiffest of the normal, the coupled sliding and rolling, and the twisting oscillation";
  law.half_period = [](LAMMPS_NS::LAMMPS* lmp) -> HalfPeriod {
    PairTable pairs;
    pairs.read(lmp);
    return [pairs](int i, int j, double R1, double m1, double R2, double m2) {
      return shortest_half_period(pairs(i, j), settings().springFactor, R1, m1, R2, m2);
    };
  };
  return law;
}

VIELTO_TOUCHING(Plain, VIELTO, TANGENTIAL_VIELTO)
VIELTO_TOUCHING(PlainRolling, VIELTO, TANGENTIAL_VIELTO, COHESION_OFF, ROLLING_VIELTO)
VIELTO_TOUCHING(Adhesion, VIELTO, TANGENTIAL_VIELTO, COHESION_ADHESION)
VIELTO_TOUCHING(AdhesionRolling, VIELTO, TANGENTIAL_VIELTO, COHESION_ADHESION, ROLLING_VIELTO)
VIELTO_TOUCHING(Sjkr, VIELTO, TANGENTIAL_VIELTO, COHESION_SJKR)
VIELTO_TOUCHING(SjkrRolling, VIELTO, TANGENTIAL_VIELTO, COHESION_SJKR, ROLLING_VIELTO)
VIELTO_TOUCHING(Sjkr2, VIELTO, TANGENTIAL_VIELTO, COHESION_SJKR2)
VIELTO_TOUCHING(Sjkr2Rolling, VIELTO, TANGENTIAL_VIELTO, COHESION_SJKR2, ROLLING_VIELTO)

namespace {

const LawRegistration registration(describe_vielto(), [] {
  add_touching<Plain>();
  add_touching<PlainRolling>();
  add_touching<Adhesion>();
  add_touching<AdhesionRolling>();
  add_touching<Sjkr>();
  add_touching<SjkrRolling>();
  add_touching<Sjkr2>();
  add_touching<Sjkr2Rolling>();
  // a capillary bridge pulls beyond contact
  add_bridging<Models<VIELTO, TANGENTIAL_VIELTO, COHESION_EASO_CAPILLARY_VISCOUS>>();
  add_bridging<Models<VIELTO, TANGENTIAL_VIELTO, COHESION_EASO_CAPILLARY_VISCOUS, ROLLING_VIELTO>>();
  add_bridging<Models<VIELTO, TANGENTIAL_VIELTO, COHESION_WASHINO_CAPILLARY_VISCOUS>>();
  add_bridging<Models<VIELTO, TANGENTIAL_VIELTO, COHESION_WASHINO_CAPILLARY_VISCOUS, ROLLING_VIELTO>>();
});

}  // namespace
}  // namespace vielto

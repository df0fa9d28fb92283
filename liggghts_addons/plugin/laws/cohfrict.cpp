// SPDX-License-Identifier: GPL-2.0-or-later
#include "cohfrict_properties.h"
#include "engine/card_mapping.h"
#include "plugin/law_registration.h"
#include "vielto_state.h"

namespace vielto {

/* The same springs and limits as ViElTo's between equal materials: k_n of CohFrictPhys is c_n k_n of ViElTo (2 E
   against 4 c_n E); k_s, k_r and k_tw are the same. What is left out is ViElTo's dashpots. */
Law describe_cohfrict() {
  Law law;
  law.name = "cohfrict";
  law.summary = "CohFrictPhys: elastic and frictional, with cohesion that breaks and with moments; no damping.";
  law.source = "Yade 2023.02a, Law2_ScGeom6D_CohFrictPhys_CohesionMoment (Bourrier et al. 2013)";
  law.header = "liggghts_addons/law/cohfrict_law.h";
  law.yade = "Law2_ScGeom6D_CohFrictPhys_CohesionMoment, contact by contact to round-off (yade/README.md)";
  law.id = COHFRICT;
  law.normal = "cohfrict";
  law.cohesionAdvice =
      "it has its own cohesion; leave cohesion off and give normalCohesion and shearCohesion with bondNewContacts on";
  law.settings = {{"bondNewContacts", "${bondNewContacts}"},
                  {"wallRadiusFactor", "${wallRadiusFactor}"},
                  {"maxOverlap", "${maxOverlap}"}};
  const PropertyRule* const rule = cohfrict::property_rules();
  law.parameters = {
      {{"bondNewContacts", 0, 0, true, true, "on or off"}, "off", "-", "off as Yade: no cohesion"},
      {rule[cohfrict::NORMAL_COHESION], "0", "-", "C_n, grain on grain and on wall"},
      {rule[cohfrict::SHEAR_COHESION], "0", "-", "C_s"},
  };
  const LawProperty::Form type = LawProperty::PER_TYPE;
  law.properties = {
      {rule[cohfrict::YOUNG], type, "2*${springFactor}*${youngsModulus}", "2*${springFactor}*${wall_youngsModulus}"},
      {rule[cohfrict::RATIO], type, "${stiffnessRatio}/${springFactor}", "${wall_stiffnessRatio}/${springFactor}"},
      {rule[cohfrict::FRICTION], type, "${frictionAngle}", "${wall_frictionAngle}"},
      {rule[cohfrict::ALPHA_KR], type, "${rollingStiffnessFactor}/${stiffnessRatio}",
       "${wall_rollingStiffnessFactor}/${wall_stiffnessRatio}"},
      {rule[cohfrict::ALPHA_KTW], type, "${twistingStiffnessFactor}", "${wall_twistingStiffnessFactor}"},
      {rule[cohfrict::ETA_ROLL], type, "${rollingResistance}", "${wall_rollingResistance}"},
      {rule[cohfrict::ETA_TWIST], type, "${twistingResistance}*tan(${frictionAngle}*PI/180)",
       "${wall_twistingResistance}*tan(${wall_frictionAngle}*PI/180)"},
      {rule[cohfrict::NORMAL_COHESION], type, "${normalCohesion}", "${normalCohesion}"},
      {rule[cohfrict::SHEAR_COHESION], type, "${shearCohesion}", "${shearCohesion}"},
  };
  law.friction = "frictionAngle";
  law.differs = {"no dashpots: normalDamping and tangentialDamping have no effect"};
  law.energies = {"elastic", "sliding", "rolling", "twisting"};
  law.timeScale = "as vielto, with its own springs";
  law.half_period = [](LAMMPS_NS::LAMMPS* lmp) -> HalfPeriod {
    cohfrict::PairTable pairs;
    pairs.read(lmp);
    return [pairs](int i, int j, double R1, double m1, double R2, double m2) {
      return shortest_half_period(springs(cohfrict::contact(pairs(i, j), R1, R2)), R1, m1, R2, m2);
    };
  };
  return law;
}

namespace {

// a stretched bond pulls beyond contact
const LawRegistration registration(describe_cohfrict(), [] { add_bridging<Models<COHFRICT>>(); });

}  // namespace
}  // namespace vielto

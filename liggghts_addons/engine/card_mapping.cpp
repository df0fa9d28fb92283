// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/card_mapping.h"

#include <limits>

namespace vielto {
namespace {
const double INF = std::numeric_limits<double>::infinity();
}

std::vector<LawProperty> vielto_properties_of_cards() {
  std::vector<LawProperty> list;
  for (int p = 0; p < N_PROPERTIES; p++) {
    const PropertyRule& rule = property_rules()[p];
    list.push_back(
        {rule, LawProperty::PER_TYPE, std::string("${") + rule.name + "}", std::string("${wall_") + rule.name + "}"});
  }
  list.push_back({{"adhesionStrength", 0, INF, true, false, "Pa"}, LawProperty::SCALAR, "${adhesionStrength}", ""});
  return list;
}

void map_restitution(Law& law) {
  // ViElTo's damping ratio z = beta_n/sqrt(c_n), beta_n the mean of both bodies; e = exp(-pi z/sqrt(1 - z^2))
  law.steps.push_back({"law_zgg", "${normalDamping}/sqrt(${springFactor})"});
  law.steps.push_back({"law_zgw", "0.5*(${normalDamping}+${wall_normalDamping})/sqrt(${springFactor})"});
  law.refusals.push_back({"${law_zgg} > 0.69 || ${law_zgw} > 0.69",
                          "normalDamping is too large for law " + law.name +
                              ": LIGGGHTS takes coefficients of restitution over 0.05, a damping ratio up to 0.69 "
                              "(beta_n/sqrt(springFactor))"});
  law.properties.push_back({{"coefficientRestitution", 0.05, 1, false, true, "1"},
                            LawProperty::PER_PAIR,
                            "exp(-PI*${law_zgg}/sqrt(1-${law_zgg}^2))",
                            "exp(-PI*${law_zgw}/sqrt(1-${law_zgw}^2))"});
}

void map_stock_friction(Law& law) {
  law.properties.push_back({{"coefficientFriction", 0, INF, true, false, "1"},
                            LawProperty::PER_PAIR,
                            "tan(${frictionAngle}*PI/180)",
                            "tan(0.5*(${frictionAngle}+${wall_frictionAngle})*PI/180)"});
  law.friction = "coefficientFriction";
  // ViElTo's arm over LIGGGHTS': 2 R_1R_2/(R_1 + R_2) over R_1R_2/(R_1 + R_2), which is 2; at a wall 2 w/(1 + w)
  law.properties.push_back(
      {{"coefficientRollingFriction", 0, INF, true, false, "1"},
       LawProperty::PER_PAIR,
       "2*${rollingResistance}",
       "2*${law_w}/(1+${law_w})*((${rollingResistance}<=${wall_rollingResistance})*${rollingResistance}+("
       "${rollingResistance}>${wall_rollingResistance})*${wall_rollingResistance}+${wallRolling})"});
}

void lacks_of_stock(Law& law) {
  // LIGGGHTS thinks of moduli under 5 MPa and over 1 GPa as mistakes
  law.commands = {"soft_particles yes", "hard_particles yes"};
  for (const char* name :
       {"stiffnessRatio", "rollingStiffnessFactor", "twistingStiffnessFactor", "twistingResistance", "slidingDashpot",
        "radiusLever", "adhesionStrength", "rollingDashpot=off", "tangentialDamping=0"})
    law.lacks.push_back(name);
  for (const char* text :
       {"the rolling spring is k_t R^2, R = R_1R_2/(R_1 + R_2) (R_1 at a wall)", "no twisting moment",
        "no tangential dashpot", "lever arms R_i - u/2, as vielto with radiusLever off",
        "a wall hands over neither its spin to the grain's rolling nor the rolling couple to the mesh"})
    law.differs.push_back(text);
}

}  // namespace vielto

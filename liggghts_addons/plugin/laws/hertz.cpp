// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/card_mapping.h"
#include "plugin/law_registration.h"
#include "plugin/laws/stock_half_period.h"

namespace vielto {

/* LIGGGHTS' `model hertz tangential history rolling_friction epsd2` under a watch over its overlaps
   (normal_model_stock.h). youngsModulus is such that at an overlap of hertzOverlap times the diameter the elastic force
   is ViElTo's, c_n k_n u (R_2 = wallRadiusFactor R_1 at a wall), at every size of grain: 4/3 Y sqrt(R u) = c_n k_n. */
Law describe_hertz() {
  Law law;
  law.name = "hertz";
  law.summary = "LIGGGHTS' own hertz, with the elastic force of the card at hertzOverlap and its restitution.";
  law.source = "LIGGGHTS 3.8, normal_model_hertz.h, tangential_model_history.h, rolling_model_epsd2.h";
  law.header = "liggghts_addons/law/stock_springs.h";
  law.yade = "Law2_ScGeom_MindlinPhys_Mindlin; not compared here";
  law.id = HERTZ_WATCHED;
  law.normal = "hertz/watched";
  law.tangential = "history";
  law.rolling = "epsd2";
  law.clumps = true;
  law.cohesions = {"sjkr", "sjkr2"};
  law.settings = {{"tangential_damping", "off"}, {"limitForce", "${limitForce}"}, {"maxOverlap", "${maxOverlap}"}};
  law.parameters = {{{"poissonsRatio", 0, 0.5, true, true, "1"},
                     "0.3",
                     "0.1",
                     "assumption, grain and wall: k_t is 2 (1 - v)/(2 - v) of the normal tangent stiffness"},
                    {{"hertzOverlap", 0, 0.1, false, true, "1"},
                     "0.01",
                     "-",
                     "overlap over diameter at which its spring bears what ViElTo's does"}};
  law.steps = {
      {"law_w", "${wallRadiusFactor}"},
      {"law_Ygg", "1.5*${springFactor}*${youngsModulus}/sqrt(${hertzOverlap})"},
      {"law_Ygw",
       "3*${springFactor}*${youngsModulus}*${wall_youngsModulus}*${law_w}/"
       "(${youngsModulus}+${law_w}*${wall_youngsModulus})/sqrt(2*${hertzOverlap})"},
      {"law_Eg", "2*(1-${poissonsRatio}^2)*${law_Ygg}"},
      {"law_Ew", "1/(1/((1-${poissonsRatio}^2)*${law_Ygw})-1/${law_Eg})"},
  };
  const PropertyRule *const young = stock_rules(), *const poisson = young + 1;
  law.properties = {{*young, LawProperty::PER_TYPE, "${law_Eg}", "${law_Ew}"},
                    {*poisson, LawProperty::PER_TYPE, "${poissonsRatio}", "${poissonsRatio}"}};
  map_restitution(law);
  map_stock_friction(law);
  lacks_of_stock(law);
  law.differs.push_back("k_t over the tangent k_n is Poisson's, 2 (1 - v)/(2 - v): 0.82 at 0.3 (ViElTo 0.125)");
  law.timeScale = "half period with the springs at u = maxOverlap, which the run does not pass";
  law.half_period = [](LAMMPS_NS::LAMMPS* lmp) {
    const double overlap = settings().maxOverlap;
    return stock_half_period(lmp, [overlap](const stock::Moduli& c, double R, double, double diameter) {
      return stock::hertz_springs(c, overlap * diameter, R);
    });
  };
  return law;
}

VIELTO_TOUCHING(Hertz, HERTZ_WATCHED, TANGENTIAL_HISTORY, COHESION_OFF, ROLLING_EPSD2)
VIELTO_TOUCHING(HertzSjkr, HERTZ_WATCHED, TANGENTIAL_HISTORY, COHESION_SJKR, ROLLING_EPSD2)
VIELTO_TOUCHING(HertzSjkr2, HERTZ_WATCHED, TANGENTIAL_HISTORY, COHESION_SJKR2, ROLLING_EPSD2)

namespace {

const LawRegistration registration(describe_hertz(), [] {
  add_touching<Hertz>();
  add_touching<HertzSjkr>();
  add_touching<HertzSjkr2>();
});

}  // namespace
}  // namespace vielto

// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/card_mapping.h"
#include "plugin/law_registration.h"
#include "plugin/laws/stock_half_period.h"

namespace vielto {

/* LIGGGHTS' `model hooke tangential history rolling_friction epsd2` under a watch over its overlaps
   (normal_model_stock.h). hooke and not hooke/stiffness: its k_n grows with the radius, as ViElTo's, and its
   restitution is the same for grains of every size and on walls; hooke/stiffness has one k_n and one gamma/m_eff for
   all sizes. youngsModulus is such that k_n = c_n k_n of ViElTo (R_2 = wallRadiusFactor R_1 at a wall), at every size
   of grain: k_n = a Y^(4/5), a = 16/15 sqrt(R) (15 m V^2/(16 sqrt(R)))^(1/5). Poisson's ratio and
   characteristicVelocity V (1 m/s) cancel out; grains of unequal size differ by the mixing rule. */
Law describe_hooke() {
  Law law;
  law.name = "hooke";
  law.summary = "LIGGGHTS' own hooke, with the card's normal stiffness and restitution.";
  law.source = "LIGGGHTS 3.8, normal_model_hooke.h, tangential_model_history.h, rolling_model_epsd2.h";
  law.header = "liggghts_addons/law/stock_springs.h";
  law.yade = "Law2_ScGeom_ViscElPhys_Basic without moments; not compared here";
  law.id = HOOKE_WATCHED;
  law.normal = "hooke/watched";
  law.tangential = "history";
  law.rolling = "epsd2";
  law.cohesions = {"sjkr", "sjkr2"};
  // k_t = 2/7 k_n, with which sliding of equal grains is as fast as their normal oscillation
  law.settings = {{"tangential_damping", "off"},
                  {"limitForce", "${limitForce}"},
                  {"maxOverlap", "${maxOverlap}"},
                  {"ktToKnUser", "on"}};
  law.steps = {
      {"law_w", "${wallRadiusFactor}"},
      {"law_R", "0.5*${grainDiameter}"},
      {"law_m", "${density}*4/3*PI*${law_R}^3"},
      {"law_Kgg", "2*${springFactor}*${youngsModulus}*${law_R}"},
      {"law_Kgw",
       "4*${springFactor}*${youngsModulus}*${wall_youngsModulus}*${law_w}/"
       "(${youngsModulus}+${law_w}*${wall_youngsModulus})*${law_R}"},
      {"law_gg", "16/15*sqrt(${law_R}/2)*(15*${law_m}/2/(16*sqrt(${law_R}/2)))^0.2"},
      {"law_gw", "16/15*sqrt(${law_R})*(15*${law_m}/(16*sqrt(${law_R})))^0.2"},
      {"law_Ygg", "(${law_Kgg}/${law_gg})^1.25"},
      {"law_Ygw", "(${law_Kgw}/${law_gw})^1.25"},
      {"law_Eg", "2*(1-0.3^2)*${law_Ygg}"},
      {"law_Ew", "1/(1/((1-0.3^2)*${law_Ygw})-1/${law_Eg})"},
  };
  const PropertyRule *const young = stock_rules(), *const poisson = young + 1;
  law.properties = {{*young, LawProperty::PER_TYPE, "${law_Eg}", "${law_Ew}"},
                    {*poisson, LawProperty::PER_TYPE, "0.3", "0.3"},
                    {{"characteristicVelocity", 0, HUGE_VAL, false, false, "m/s"}, LawProperty::SCALAR, "1", ""}};
  map_restitution(law);
  map_stock_friction(law);
  lacks_of_stock(law);
  law.differs.push_back("k_t is 2/7 k_n (ViElTo 0.125)");
  law.timeScale = "half period in closed form";
  law.half_period = [](LAMMPS_NS::LAMMPS* lmp) {
    LAMMPS_NS::FixPropertyGlobal* const velocity = find_property(lmp, "characteristicVelocity");
    if (!velocity) stop_all(lmp, "vielto: property characteristicVelocity of hooke is missing");
    const double V = velocity->compute_scalar();
    return stock_half_period(
        lmp, [V](const stock::Moduli& c, double R, double m, double) { return stock::hooke_springs(c, V, R, m); });
  };
  return law;
}

VIELTO_TOUCHING(Hooke, HOOKE_WATCHED, TANGENTIAL_HISTORY, COHESION_OFF, ROLLING_EPSD2)
VIELTO_TOUCHING(HookeSjkr, HOOKE_WATCHED, TANGENTIAL_HISTORY, COHESION_SJKR, ROLLING_EPSD2)
VIELTO_TOUCHING(HookeSjkr2, HOOKE_WATCHED, TANGENTIAL_HISTORY, COHESION_SJKR2, ROLLING_EPSD2)

namespace {

const LawRegistration registration(describe_hooke(), [] {
  add_touching<Hooke>();
  add_touching<HookeSjkr>();
  add_touching<HookeSjkr2>();
});

}  // namespace
}  // namespace vielto

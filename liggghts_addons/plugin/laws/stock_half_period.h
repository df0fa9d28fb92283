// SPDX-License-Identifier: GPL-2.0-or-later
/* The half period of LIGGGHTS' own laws: youngsModulus and poissonsRatio of the simulation, springs of stock_springs.h.
   In the order in which the sum of two bodies is taken there. */
#ifndef VIELTO_STOCK_HALF_PERIOD_H
#define VIELTO_STOCK_HALF_PERIOD_H

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/law.h"
#include "stock_springs.h"
#include "vielto_state.h"

namespace vielto {

// Of youngsModulus and poissonsRatio, in this order.
inline const PropertyRule* stock_rules() {
  static const PropertyRule rules[2] = {
      {"youngsModulus", 0, std::numeric_limits<double>::infinity(), false, false, "Pa"},
      {"poissonsRatio", 0, 0.5, true, true, "1"}};
  return rules;
}

// springs(moduli, R, m, diameter of the smaller grain)
template <class SpringsOf>
HalfPeriod stock_half_period(LAMMPS_NS::LAMMPS* lmp, const SpringsOf& springs) {
  const std::vector<double> young = read_property(lmp, stock_rules()[0]),
                            poisson = read_property(lmp, stock_rules()[1]);
  return [young, poisson, springs](int i, int j, double R1, double m1, double R2, double m2) {
    const stock::Moduli c = stock::moduli({young[i], poisson[i]}, {young[j], poisson[j]});
    const double R = stock::radius(R1, R2, m2), diameter = 2 * (std::isinf(m2) ? R1 : std::min(R1, R2));
    return shortest_half_period(springs(c, R, stock::mass(m1, m2), diameter), R1, m1, R2, m2);
  };
}

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// Dimensionless numbers against values worked by hand, and the thesis equation against its published table.
#include <gtest/gtest.h>

#include "core/mixing_numbers.h"

namespace {

// Round numbers, worked by hand: P = 64 W, L = 0.5 m, n = 2 1/s, rho_h = 800 kg/m3, C_h = 400 Pa.
//   N_P  = 64 / (0.03125 * 8 * 800) = 0.32        N_C  = 0.25 * 4 * 800 / 400 = 2
//   N_PC = 64 / (400 * 0.125 * 2)   = 0.64        Fr_M = 0.5 * 4 / 9.81 = 0.203873598...
// Tolerance: a few roundings of double precision.
constexpr double kRounding = 1e-14;

TEST(Numbers, PowerNumberByHand) { EXPECT_NEAR(vielto::power_number(64, 0.5, 2, 800), 0.32, kRounding); }

TEST(Numbers, CohesivePowerNumberByHand) {
  EXPECT_NEAR(vielto::cohesive_power_number(64, 0.5, 2, 400), 0.64, kRounding);
}

TEST(Numbers, CohesionNumberByHand) { EXPECT_NEAR(vielto::cohesion_number(0.5, 2, 800, 400), 2.0, kRounding); }

TEST(Numbers, FroudeNumberByHand) { EXPECT_NEAR(vielto::mixing_froude_number(0.5, 2), 0.2038735983690112, kRounding); }

TEST(Numbers, ShaftPowerIsTorqueTimesAngularSpeed) {
  // 5 N m at half a turn per second: 5 * pi W.
  EXPECT_NEAR(vielto::shaft_power(5, 0.5), 15.707963267948966, 1e-13);
}

TEST(Numbers, CohesivePowerNumberIsCohesionNumberTimesPowerNumber) {
  const double power = 32.1, lever = 0.114, speed = 1.21, density = 825, cohesion = 6175;
  const double product =
      vielto::cohesion_number(lever, speed, density, cohesion) * vielto::power_number(power, lever, speed, density);
  EXPECT_NEAR(vielto::cohesive_power_number(power, lever, speed, cohesion) / product, 1, kRounding);
}

// With l, N_C and Fr_M at 1 only the factor is left; each exponent alone by powers of ten and of 16.
TEST(Numbers, ThesisEquationHasItsPrintedCoefficients) {
  EXPECT_DOUBLE_EQ(vielto::thesis_cohesive_power_number(1, 1, 1), 15.68);
  EXPECT_NEAR(vielto::thesis_cohesive_power_number(0.1, 1, 1), 15.68 * 0.0912010839355910, 1e-12);  // 10^-1.04
  EXPECT_NEAR(vielto::thesis_cohesive_power_number(1, 1e10, 1), 156.8, 1e-12);                      // 10^(10*0.1)
  EXPECT_NEAR(vielto::thesis_cohesive_power_number(1, 1, 16), 7.84, 1e-12);                         // 16^(-1/4)
}

// Table of the published equation with rho_h = 825 kg/m3, C_h = 6175 Pa, L = 0.114 m, in W, rounded to 0.01.
// Tolerance: half a unit of the last digit, and 0.002 W because the table took rho_h/C_h = 0.1336, not 825/6175.
TEST(Numbers, ThesisPowerMatchesItsTable) {
  const double speeds[] = {0.48, 0.85, 1.21, 1.58};
  const double fills[] = {0.10, 0.15, 0.20, 0.25};
  const double table[4][4] = {{12.62, 18.83, 24.12, 29.07},
                              {19.25, 28.71, 36.77, 44.32},
                              {25.96, 38.73, 49.59, 59.77},
                              {32.74, 48.84, 62.54, 75.38}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      EXPECT_NEAR(vielto::thesis_power(fills[i], 0.114, speeds[j], 825, 6175), table[i][j], 0.007)
          << "fill " << fills[i] << ", speed " << speeds[j];
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// Walton and Braun's law alone, by hand and against its own closed forms: branches that meet, the energy of a cycle.
#include "walton_braun_law.h"

#include <gtest/gtest.h>

namespace {

using namespace walton_braun;

// k_1 = 2000 N/m, e = 0.5: k_2 = 8000 N/m; hardening 3 at u_m/d = 0.1 adds 0.3 k_1.
TEST(WaltonBraun, UnloadingStiffnessIsThatOfRestitutionAndHardening) {
  EXPECT_DOUBLE_EQ(unloading_stiffness(2000, 0.5, 0, 4e-4, 4e-3), 8000);
  EXPECT_DOUBLE_EQ(unloading_stiffness(2000, 0.5, 3, 4e-4, 4e-3), 8600);
  EXPECT_DOUBLE_EQ(unloading_stiffness(2000, 1, 3, 4e-4, 4e-3), 2600);
}

// At the greatest overlap both branches have k_1 u_m = 0.8 N; the unloading one ends at u_m (1 - k_1/k_2) = 3e-4 m.
TEST(WaltonBraun, UnloadsFromTheLoadingBranchToTheResidualOverlap) {
  EXPECT_DOUBLE_EQ(force(2000, 8000, 4e-4, 4e-4), 0.8);
  EXPECT_DOUBLE_EQ(force(2000, 8000, 3.5e-4, 4e-4), 0.4);
  EXPECT_NEAR(force(2000, 8000, 3e-4, 4e-4), 0, 1e-16);
  EXPECT_EQ(force(2000, 8000, 2.9e-4, 4e-4), 0);
}

// 0.8^2/(2 8000) = 4e-5 J come back of 0.5 * 2000 * (4e-4)^2 = 1.6e-4 J; the rest, 1 - k_1/k_2 of it, is lost.
TEST(WaltonBraun, WhatIsHeldAndWhatIsLostIsTheWorkOfLoading) {
  EXPECT_DOUBLE_EQ(held(0.8, 8000), 4e-5);
  EXPECT_DOUBLE_EQ(lost(2000, 8000, 4e-4), 1.2e-4);
  EXPECT_DOUBLE_EQ(lost(2000, 2000, 4e-4), 0);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
// Two balances that any true record of the mixer keeps: energy, and angular momentum about the shaft.
#include "mixer_runner.h"

using namespace vielto_test;

namespace {

const std::size_t first = 180, last = 359;  // rows of the window: the second half of the first turn

double sum_of_torques(const Table& rows, std::size_t k) {
  return rotor(rows, k) + rows.at(k, "drum_Nm") + rows.at(k, "gravity_Nm");
}

void expect_energy_kept(const Table& rows, double tolerance) {
  const auto change = [&rows](const std::string& column) { return rows.at(last, column) - rows.at(first, column); };
  double dissipated = 0;
  for (const char* how : {"normal", "tangential", "sliding", "rolling", "twisting"}) {
    const double part = change(fmt::format("diss_{}_J", how));
    EXPECT_GE(part, 0) << how;
    dissipated += part;
  }
  const double stored = change("kinetic_J") + change("elastic_J") + change("potential_J");
  const double work = change("work_J");
  EXPECT_GT(work, 1);  // J: the paddles move the bed
  EXPECT_NEAR(dissipated + stored, work, tolerance * work);
  // the work is the rotor's torque times its angle
  double torque = 0;
  for (std::size_t k = first + 1; k <= last; k++) torque += rotor(rows, k);
  EXPECT_NEAR(work, torque * 2 * pi / 360, 1e-6 * work);
}

}  // namespace

struct Bed {
  std::string name, law, options = {};
};
void PrintTo(const Bed& bed, std::ostream* out) { *out << bed.name; }
class MixerBalance : public testing::TestWithParam<Bed> {};

// Grains that are pairs of spheres, one and a half times as long as broad.
const std::string pairs =
    "-var clump pair -var clumpElongation 0.5 -var clumpRollingResistance 0.2 -var clumpTwistingResistance 0.2 ";

/* Shaft work = dissipation by mechanism + change of kinetic, elastic and potential energy, within 1 %, of ViElTo within
   0.5 %: its account of the normal dashpot is right to second order (normal_model_vielto.h), those of the other laws
   take it at the end of the step. What a spring still holds when its contact opens is left. Torque of rotor, drum and
   gravity on the bed = change of its angular momentum, whose mean over the window is 0 within its uncertainty, here
   from means of 15 rows. With clumps the kinetic energy is of bodies, whose spin LIGGGHTS has to second order only:
   1 %. */
TEST_P(MixerBalance, ShaftWorkIsDissipatedAndTorquesAddUpToNothing) {
  Mixer mixer;
  const Bed& bed = GetParam();
  const bool accounts = bed.law != "hertz";
  mixer.must("run", four,
             fmt::format("-var law {} -var turns 1 -var dtFraction {} -var energyBalance {} {}", bed.law,
                         accounts ? 0.025 : 0.05, accounts ? "on" : "off", bed.options));
  const Table rows = mixer.csv("run/torque.csv");
  ASSERT_EQ(rows.rows.size(), 360u);
  if (accounts) expect_energy_kept(rows, bed.law == "vielto" && bed.options.empty() ? 0.005 : 0.01);

  const std::size_t block = 15, blocks = (last + 1 - first) / block;
  double mean = 0, square = 0, rotors = 0, gravity = 0;
  for (std::size_t b = 0; b < blocks; b++) {
    double of_block = 0;
    for (std::size_t k = first + b * block; k < first + (b + 1) * block; k++) {
      of_block += sum_of_torques(rows, k) / block;
      rotors += rotor(rows, k) / block / blocks;
      gravity += rows.at(k, "gravity_Nm") / block / blocks;
    }
    mean += of_block / blocks;
    square += of_block * of_block / blocks;
  }
  const double u = std::sqrt((square - mean * mean) / (blocks - 1));
  EXPECT_LT(std::fabs(mean), 3 * u);
  EXPECT_LT(u, 0.1 * rotors);
  EXPECT_GT(std::fabs(gravity), 4 * u);  // the bed leans, and would be missed
}

INSTANTIATE_TEST_SUITE_P(Laws, MixerBalance,
                         testing::Values(Bed{"vielto", "vielto"}, Bed{"cohfrict", "cohfrict"},
                                         Bed{"walton_braun", "walton_braun"}, Bed{"vielto_clumps", "vielto", pairs},
                                         Bed{"walton_braun_clumps", "walton_braun", pairs},
                                         Bed{"hertz_clumps", "hertz", pairs}),
                         [](const auto& tested) { return tested.param.name; });

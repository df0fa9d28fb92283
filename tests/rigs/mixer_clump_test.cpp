// SPDX-License-Identifier: GPL-2.0-or-later
// The mixer with grains that are clumps of spheres: their shape, mass, restart, bed and ranks. What they do to energy
// and torque: mixer_balance_test.
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>

#include "mixer_runner.h"

using namespace vielto_test;

namespace {

const std::string pairs = four + "-var clump pair -var clumpElongation 0.5 -var restartTurns 0.1 ";
const std::size_t kept = 36;  // rows up to the first restart

// Volume of two spheres of radius 1 whose centres are 2 e apart, less the lens that both hold.
double union_of_pair(double e) {
  const double d = 2 * e, lens = pi * (4 + d) * (2 - d) * (2 - d) / 12;
  return 8 * pi / 3 - lens;
}

}  // namespace

/* In the last state: each grain's two spheres, whose numbers follow one another, have one radius and lie 0.5 diameters
   apart; the pair has the volume of the sphere that it stands for, of the three sizes of sizes.in. Tolerance: six
   digits of the dump. The mass told is the grains' own, within half a grain of what was asked for. */
TEST(MixerClumps, ArePairsOfTheLengthAskedFor) {
  const double density = 1375, diameter = 0.016, spread = 0.0556, slice = 4 * 0.765 / 22;
  Mixer mixer;
  mixer.must("run", pairs, "-var turns 0.02 ");
  EXPECT_EQ(mixer.header("run", "spheres_per_grain"), "2");
  const Table rows = mixer.csv("run/torque.csv");
  vtkNew<vtkPolyDataReader> reader;
  reader->SetFileName(
      fmt::format("{}/run/vtk/grains_{:.0f}.vtk", mixer.folder.string(), rows.at(rows.rows.size() - 1, "step"))
          .c_str());
  reader->ReadAllFieldsOn();
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  vtkDataArray *radius = data->GetPointData()->GetArray("radius"), *number = data->GetPointData()->GetArray("id");
  ASSERT_TRUE(radius && number);
  std::map<int, vtkIdType> of_number;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); i++) of_number[static_cast<int>(number->GetTuple1(i))] = i;
  ASSERT_EQ(of_number.size() % 2, 0u);
  double mass = 0;
  std::set<long> sizes;  // um
  for (auto at = of_number.begin(); at != of_number.end(); std::advance(at, 2)) {
    const vtkIdType a = at->second, b = std::next(at)->second;
    const double r = radius->GetTuple1(a);
    EXPECT_EQ(radius->GetTuple1(b), r);
    Vec apart = Vec(data->GetPoint(a)) - Vec(data->GetPoint(b));
    apart[0] -= slice * std::round(apart[0] / slice);
    EXPECT_NEAR(apart.norm() / (2 * r), 0.5, 1e-4);
    const double volume = union_of_pair(0.5) * std::pow(r, 3);
    mass += density * volume;
    sizes.insert(std::lround(1e5 * std::cbrt(6 * volume / pi)));
  }
  std::set<long> wanted;
  for (const int k : {-1, 0, 1}) wanted.insert(std::lround(1e5 * diameter * (1 + k * std::sqrt(3) * spread)));
  EXPECT_EQ(sizes, wanted);
  const double told = std::stod(mixer.header("run", "mass_kg"));
  EXPECT_NEAR(told, mass, 1e-5 * mass);
  const double largest = density * pi / 6 * std::pow(diameter * (1 + std::sqrt(3) * spread), 3);
  EXPECT_NEAR(told, std::stod(mixer.header("run", "mass_target_kg")), 0.5 * largest);
}

// As MixerResume of spheres: the restart holds bodies, their spin and what acts on them.
TEST(MixerClumps, CarryOnAKilledRunAsIfNeverBrokenOff) {
  Mixer mixer;
  mixer.must("whole", pairs);
  mixer.must_break_off("broken", pairs);
  std::filesystem::copy(mixer.folder / "broken.partial", mixer.folder / "two.partial",
                        std::filesystem::copy_options::recursive);
  mixer.must("broken", pairs, "-var resume yes");
  mixer.must("two", pairs, "-var resume yes", 2);
  const Table whole = mixer.csv("whole/torque.csv");
  for (const char* name : {"broken", "two"}) {
    const Table resumed = mixer.csv(std::string(name) + "/torque.csv");
    ASSERT_EQ(resumed.rows.size(), whole.rows.size()) << name;
    EXPECT_EQ(difference(whole, resumed, 0, kept), 0) << name;
    EXPECT_LT(difference(whole, resumed, kept, kept + 12), 1e-8) << name;
  }
  EXPECT_GT(std::fabs(rotor(whole, kept + 1)), 0.1);  // paddles were in the bed at the restart
}

// Sums over the spheres of a body are taken in another order, as in a resumed run.
TEST(MixerClumps, ShareABed) {
  Mixer mixer;
  mixer.must("first", pairs, "-var turns 0.1 ");
  mixer.must("again", pairs, fmt::format("-var turns 0.1 -var bed '{}' ", (mixer.folder / "first").string()));
  const Table first = mixer.csv("first/torque.csv"), again = mixer.csv("again/torque.csv");
  EXPECT_LT(difference(first, again, 0, 12), 1e-8);
  EXPECT_GT(std::fabs(rotor(first, 0)), 0.1);  // paddles stand in the bed
}

class MixerClumpOption : public testing::TestWithParam<Refusal> {};

TEST_P(MixerClumpOption, IsRefusedWithOneLine) {
  Mixer mixer;
  expect_refusal(mixer.folder / "run", mixer.rig("run", pairs, GetParam().option), GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, MixerClumpOption,
    testing::Values(Refusal{"NoFile", "-var clump yes", {"hulled_millet.clump", "missing"}},
                    Refusal{"NoLength", "-var clumpElongation 0", {"clumpElongation", "give > 0 and at most 1"}},
                    Refusal{"InPieces", "-var clumpElongation 1.2", {"clumpElongation", "give > 0 and at most 1"}},
                    Refusal{"InAir", "-var airDrag 1", {"airDrag", "clump pair takes airDrag 0 only"}},
                    Refusal{"LawByMass", "-var law hooke", {"clumps were not tested with law hooke"}}),
    [](const auto& refused) { return name_of(refused); });

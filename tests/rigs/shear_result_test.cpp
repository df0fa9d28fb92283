// SPDX-License-Identifier: GPL-2.0-or-later
// From a synthetic shear record of known peak, plateau and plate motion to the numbers, and what is refused.
#include "rigs/shearbox/shear_result.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "core/bad_input.h"

using namespace vielto;

namespace {

const double area = 0.0036, stress = 19620, pi = 3.14159265358979323846;

// Rows over 8 mm: shear stress rises to `peak` at 1 mm and falls to `steady` at 3 mm; the plate force swings by `swing`
// of its weight; noise of the shear stress is `noise` of it, white.
// ctest runs the tests of a program side by side, each in a process of its own.
std::string own_path(const std::string& name) { return fmt::format("{}{}_{}", testing::TempDir(), getpid(), name); }

struct Synthetic {
  int rows = 2000;
  double peak = 14000, steady = 10000, drift = 0, noise = 0.01, swing = 0.1, lost = 0, overlap = 0.01;
  std::string key, value;  // one key with another value; empty value: left out

  double clean(double mm) const {
    if (mm < 1) return peak * mm;
    if (mm < 3) return steady + (peak - steady) * 0.5 * (1 + std::cos(pi * (mm - 1) / 2));
    return steady * (1 + drift * (mm - 3));
  }

  std::string text() const {
    std::string out;
    const std::vector<std::pair<std::string, std::string>> keys = {{"schema", "1"},
                                                                   {"rig", "shearbox"},
                                                                   {"normal_stress", "19620"},
                                                                   {"shear_velocity", "0.05"},
                                                                   {"plate_mass", "7.2"},
                                                                   {"gravity", "9.81"},
                                                                   {"area", "0.0036"},
                                                                   {"seed", "1"},
                                                                   {"material", "hulled_millet"},
                                                                   {"wall", "steel"},
                                                                   {"provisional", "1"},
                                                                   {"density", "1375"},
                                                                   {"grain_diameter", "0.003"},
                                                                   {"youngs_modulus", "5e6"},
                                                                   {"dt", "1e-6"},
                                                                   {"dt_over_tc", "0.05"},
                                                                   {"interval_steps", "10"}};
    for (const auto& [k, v] : keys)
      if (k != key)
        out += "# " + k + "=" + v + "\n";
      else if (!value.empty())
        out += "# " + k + "=" + value + "\n";
    out +=
        "step,time_s,displacement_m,lower_Fx_N,lower_Fy_N,lower_Fz_N,upper_Fx_N,upper_Fy_N,upper_Fz_N,plate_Fx_N,"
        "plate_Fy_N,plate_Fz_N,plate_position_m,plate_velocity_m_s,dilation_m,porosity,overlap_mean,overlap_max,"
        "contacts,grains,kinetic_J\n";
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int i = 1; i <= rows; i++) {
      const double mm = 8.0 * i / rows;
      const double shear = area * clean(mm) * (1 + noise * normal(random));
      const double plate = 70.632 * (1 + swing * std::sqrt(2.0) * std::sin(2 * pi * 5 * mm));
      out += fmt::format("{},{},{},{},0,{},{},0,-5,{},0,{},0.0135,0,{},0.45,0.002,{},5000,{},1e-5\n", 10 * i, i * 1e-5,
                         mm * 1e-3, shear, 1.1 * plate + 5, -0.8 * shear, -0.2 * shear, -plate, 1e-4 * mm, overlap,
                         i == rows ? 3000 - lost : 3000);
    }
    return out;
  }

  std::string write() const {
    const std::string path = own_path("shear.csv");
    std::ofstream(path) << text();
    return path;
  }
  ShearResult result() const {
    const std::string path = write();
    const ShearRecord record = read_shear_record(path);
    std::filesystem::remove(path);
    return shear_result(record);
  }
};

void expect_refused(const std::string& text, const std::string& why) {
  const std::string path = own_path("shear.csv");
  std::ofstream(path) << text;
  try {
    shear_result(read_shear_record(path));
    ADD_FAILURE() << "not refused: " << why;
  } catch (const BadInput& e) {
    EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
  }
  std::filesystem::remove(path);
}

bool warns(const ShearResult& result, const std::string& of) {
  for (const std::string& warning : result.warnings)
    if (warning.find(of) != std::string::npos) return true;
  return false;
}

}  // namespace

// A block holds 50 rows: noise of a block mean 1 %/sqrt(50) = 0.14 %. The peak block lies within 0.2 mm of 1 mm; its
// mean is below the peak by at most the mean over the block before it, peak (1 - 0.1).
TEST(ShearResult, FindsPeakAndSteadyPartOfAKnownCurve) {
  const ShearResult r = Synthetic().result();
  EXPECT_NEAR(r.steady.mean, 10000, 3 * r.steady.u);
  EXPECT_NEAR(r.steady.u, 10000 * 0.01 / std::sqrt(1250), 15);
  EXPECT_TRUE(r.is_steady);
  EXPECT_GE(r.steady_from, 2.6e-3);  // what is left of the fall there is below the noise of a block
  EXPECT_NEAR(r.peak, 14000, 300);
  EXPECT_NEAR(r.peak_displacement, 1e-3, 2e-4);
  EXPECT_NEAR(r.friction, 10000 / stress, 3 * r.friction_u);
  EXPECT_TRUE(r.warnings.empty());
}

// Plane force: half of lower + |upper and plate| = (1.1 P + 5 + 5 + P)/2 with P the plate force, mean 70.632 N.
TEST(ShearResult, TakesNormalStressAndPlateForceFromTheRows) {
  const ShearResult r = Synthetic().result();
  EXPECT_NEAR(r.plane_stress, (2.1 * 70.632 + 10) / 2 / area, 1e-3 * r.plane_stress);
  EXPECT_NEAR(r.plate_mean, 70.632, 0.005 * 70.632);
  EXPECT_NEAR(r.plate_fluctuation, 0.1, 0.001);  // whole periods but for a part of one
  EXPECT_NEAR(r.plate_departure_row, 0.1 * std::sqrt(2.0) * std::cos(pi / 50),
              1e-6);                                          // 50 rows a period, crest between two
  EXPECT_LT(r.plate_departure_block, r.plate_departure_row);  // a period is one block long
  EXPECT_NEAR(r.dilation_end, 8e-4, 1e-9);
  EXPECT_NEAR(r.inertial_number, 0.05 / 10 * std::sqrt(1375 / 19620.0), 1e-3 * r.inertial_number);
  EXPECT_NEAR(r.force_imbalance, 0, 1e-9);
}

TEST(ShearResult, MarksARecordThatIsNotToBeTrusted) {
  Synthetic drifting, lossy, deep;
  drifting.drift = 0.02;
  lossy.lost = 2;
  deep.overlap = 0.06;
  const ShearResult d = drifting.result();
  EXPECT_FALSE(d.is_steady);
  EXPECT_TRUE(warns(d, "not steady"));
  EXPECT_NEAR(d.drift, 0.02, 0.004);
  EXPECT_TRUE(warns(lossy.result(), "lost grains"));
  EXPECT_TRUE(warns(deep.result(), "greatest overlap"));
}

TEST(ShearResult, RefusesABrokenRecord) {
  Synthetic s;
  s.rows = 200;
  const std::string good = s.text();
  expect_refused(good.substr(0, good.size() - 20), "cut off");
  expect_refused(good.substr(0, good.find("\n200,") + 1), "fewer than 40");
  expect_refused(good.substr(0, good.find("\n10,") + 1), "holds no row");
  std::string gap = good;
  gap.erase(gap.find("\n500,"), gap.find("\n510,") - gap.find("\n500,"));
  expect_refused(gap, "where 500 follows");
  for (const char* key : {"normal_stress", "area", "plate_mass", "shear_velocity"}) {
    s.key = key;
    expect_refused(s.text(), fmt::format("lacks the key '{}'", key));
    s.value = "-1";
    expect_refused(s.text(), fmt::format("key '{}' has the value '-1'", key));
    s.value.clear();
  }
}

// Through the program: the kind of record is found by its key; bad input leaves nothing behind and exits 2.
TEST(PostCommand, TellsRigsApartByTheirKey) {
  const std::string folder = own_path("shear_post");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const auto post = [&](const std::string& text, const std::string& options = "") {
    std::ofstream(folder + "/shear.csv") << text;
    const int code = std::system(
        fmt::format("'{}/vielto' post '{}' {} > '{}/out.txt' 2>&1", VIELTO_BIN_DIR, folder, options, folder).c_str());
    return WEXITSTATUS(code);
  };
  Synthetic s;
  s.key = "rig", s.value = "press";
  EXPECT_EQ(post(s.text()), 2);
  s.value = "shearbox";
  EXPECT_EQ(post(s.text(), "--idle x"), 2);
  EXPECT_EQ(post(s.text().substr(0, 5000)), 2);
  EXPECT_FALSE(std::filesystem::exists(folder + "/post"));
  EXPECT_EQ(post(s.text()), 0);
  for (const char* file : {"shear.json", "table.txt", "curve.csv", "observations.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder + "/post/" + file)) << file;
  std::filesystem::remove_all(folder);
}

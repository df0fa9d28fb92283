// SPDX-License-Identifier: GPL-2.0-or-later
// Fits of tables longer than memory: the same numbers as in memory, and memory that does not grow with the table.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "child_memory.h"
#include "core/bad_input.h"
#include "equation/power_fit.h"

namespace {

namespace fs = std::filesystem;
using namespace vielto;

constexpr const char* kHeader =
    "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material\n";

// Power in W by the definitions of physics and nothing else: N_PC = 15.68 l^1.04 N_C^0.1 Fr_M^-0.25.
double power_of(double l, double n, double rho, double c) {
  const double lever = 0.114, cohesion = lever * lever * n * n * rho / c, froude = lever * n * n / 9.81;
  return 15.68 * std::pow(l, 1.04) * std::pow(cohesion, 0.1) * std::pow(froude, -0.25) * c * std::pow(lever, 3) * n;
}

BulkMaterial grain(const std::string& name, double rho, double c) {
  BulkMaterial m;
  m.name = name;
  m.bulk_density = rho;
  m.bulk_cohesion = c;
  return m;
}
const std::vector<BulkMaterial> kMaterials = {grain("millet", 825, 6175), grain("corn", 740, 2100)};

class Stream : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("vielto_stream_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
  }
  // Random settings, 3 % of noise and as much u; every tenth row is held out, every fifth states loaded and idling
  // power.
  std::string table(const std::string& name, long rows, int materials = 2) {
    FILE* out = std::fopen((folder / name).c_str(), "w");
    std::fputs(kHeader, out);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> fill(0.1, 0.25), speed(0.48, 1.58);
    for (long i = 0; i < rows; ++i) {
      const BulkMaterial& m = kMaterials[static_cast<std::size_t>(i % materials)];
      const double l = fill(random), n = speed(random), truth = power_of(l, n, *m.bulk_density, *m.bulk_cohesion);
      const double p = truth * (1 + 0.03 * normal(random)), u = 0.03 * truth;
      const char* role = i % 10 == 9 ? "check" : "fit";
      const auto line = [&](const char* observable, double value, double own_u) {
        std::fprintf(out, "t%ld,%s,mixer,%s,%.10g,%.10g,W,%.10g,%.10g,,,,,,%s\n", i, role, observable, value, own_u, n,
                     l, m.name.c_str());
      };
      if (i % 5 == 0) {
        line("power_loaded", p + 6, 0.8 * u);
        line("power_idle", 6, 0.6 * u);
      } else {
        line("power", p, u);
      }
    }
    std::fclose(out);
    return (folder / name).string();
  }
  std::string refusal(const std::string& path) {
    try {
      PowerStream({path}, {MixerDimensions()}, {kMaterials[0]});
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder;
};

void expect_near(double a, double b, double tolerance, const std::string& what) {
  EXPECT_NEAR(a, b, tolerance * std::fabs(b)) << what;
}

// The sums over rows and the certified least squares in memory (regression_nist_test) minimise the same chi2: they
// agree to what a relative offset of 1e-7 leaves.
TEST_F(Stream, GivesWhatTheFitInMemoryGives) {
  const std::string path = table("t.csv", 500), one = table("one.csv", 300, 1);
  for (const Objective objective : {Objective::absolute, Objective::log, Objective::relative})
    for (const bool weighted : {true, false})
      for (const bool fixed : {false, true})
        for (const std::string& file : {path, one}) {
          PowerFitRequest request;
          request.objective = objective;
          request.weighted = weighted;
          if (fixed) request.fixed["B3"] = -0.25;
          const PowerFit a =
              fit_power(request, power_data({read_reduced_table(file)}, {MixerDimensions()}, kMaterials));
          const PowerFit b = fit_power(request, PowerStream({file}, {MixerDimensions()}, kMaterials));
          const std::string which = file + " objective " + std::to_string(static_cast<int>(objective)) +
                                    (weighted ? " weighted" : "") + (fixed ? " fixed" : "");
          EXPECT_EQ(a.law.rows, b.law.rows) << which;
          EXPECT_EQ(a.law.undetermined, b.law.undetermined) << which;
          ASSERT_EQ(a.law.coefficients.size(), b.law.coefficients.size()) << which;
          ASSERT_EQ(a.law.combinations.size(), b.law.combinations.size()) << which;
          for (std::size_t i = 0; i < a.law.coefficients.size(); ++i) {
            expect_near(b.law.coefficients[i].value, a.law.coefficients[i].value, 1e-7, which);
            expect_near(b.law.coefficients[i].high95, a.law.coefficients[i].high95, 1e-6, which);
          }
          for (std::size_t i = 0; i < a.law.combinations.size(); ++i)
            expect_near(b.law.combinations[i].low95, a.law.combinations[i].low95, 1e-6, which);
          expect_near(b.law.chi2, a.law.chi2, 1e-8, which);
          expect_near(b.law.r2, a.law.r2, 1e-8, which);
          expect_near(b.law.leave_one_out_rmse, a.law.leave_one_out_rmse, 1e-7, which);
          expect_near(b.law.errors.maximum, a.law.errors.maximum, 1e-6, which);
          expect_near(b.law.leave_one_out_errors.maximum, a.law.leave_one_out_errors.maximum, 1e-6, which);
          expect_near(b.check_errors.root_mean_square, a.check_errors.root_mean_square, 1e-6, which);
          expect_near(b.booklet_errors.mean, a.booklet_errors.mean, 1e-9, which);
        }
}

TEST_F(Stream, RefusesWhatATableInMemoryIsRefusedFor) {
  const std::string row = "fit,mixer,power,20,1,W,1,0.15,,,,,,millet\n",
                    loaded = "fit,mixer,power_loaded,20,1,W,1,0.15,,,,,,millet\n";
  EXPECT_NE(refusal(write("a.csv", kHeader + ("a," + row) + "b," + row + "a," + row))
                .find("a.csv, line 4, column test: 'a' stands in line 2 too"),
            std::string::npos);
  EXPECT_NE(refusal(write("b.csv", kHeader + ("a," + row) + "a," + row)).find("b.csv, line 3, column observable"),
            std::string::npos);
  EXPECT_NE(refusal(write("c.csv", kHeader + ("a," + loaded)))
                .find("c.csv, line 2, column observable: power_loaded stands without power_idle"),
            std::string::npos);
  EXPECT_NE(refusal(write("d.csv", kHeader + ("a," + row) + "b,fit,mixer,power,nan,1,W,1,0.15,,,,,,millet\n"))
                .find("d.csv, line 3, column value"),
            std::string::npos);
  EXPECT_NE(refusal(write("e.csv", kHeader + ("a," + row) + "b,fit,mixer,power,20,1,W,1,0.15,,,,,,corn\n"))
                .find("e.csv, line 3, column material: no card of 'corn'"),
            std::string::npos);
  EXPECT_NE(refusal(write("f.csv", kHeader + std::string("a,fit,mixer,power,20,1,W,,0.15,,,,,,millet\n")))
                .find("f.csv, line 2, column speed"),
            std::string::npos);
  EXPECT_EQ(refusal(write("g.csv", kHeader + ("a," + row) + "b," + row)), "");
}

double memory_of_fit(const fs::path& table, const fs::path& out) {
  return vielto_test::memory_of({"fit", table.string(), "--material", (table.parent_path() / "millet.par").string(),
                                 "--material", (table.parent_path() / "corn.par").string(), "--out", out.string()});
}

// In memory a row took 1.8 kB; here 8 bytes a test: ten times the rows may cost 4 MB, and some for the allocator.
TEST_F(Stream, MemoryDoesNotGrowWithTheTable) {
  for (const BulkMaterial& m : kMaterials)
    write(m.name + ".par", "variable bulkDensity index " + std::to_string(*m.bulk_density) +
                               " # kg/m3 | 1 | test\nvariable bulkCohesion index " + std::to_string(*m.bulk_cohesion) +
                               " # Pa | 1 | test\n");
  const double short_one = memory_of_fit(table("short.csv", 50000), folder / "short.json");
  const double long_one = memory_of_fit(table("long.csv", 500000), folder / "long.json");
  EXPECT_LT(long_one, short_one + 25) << short_one << " MB and " << long_one << " MB";
  const auto fit = nlohmann::json::parse(std::ifstream(folder / "long.json"));
  EXPECT_EQ(fit["statistics"]["rows"], 450000);
  const auto within = [&](const char* name, double truth) {
    const auto& c = fit["coefficients"][name];
    EXPECT_NEAR(c["value"].get<double>(), truth, 4 * c["standard_error"].get<double>()) << name;
  };
  // `log` would be without bias; `absolute` with u from the truth is too.
  within("B1", 1.04);
  within("B2", 0.1);
  within("B3", -0.25);
}

}  // namespace

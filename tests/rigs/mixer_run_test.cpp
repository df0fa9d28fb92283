// SPDX-License-Identifier: GPL-2.0-or-later
// The mixer's run from filling to run folder: mass and sizes of the grain, where it comes in, the idling record, slices
// and the whole drum, dumps, and that a run is decided by its seed.
#include <vtkCellLocator.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSTLReader.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "mixer_runner.h"

using namespace vielto_test;
namespace fs = std::filesystem;

namespace {

const double density = 1375, diameter = 0.016, spread = 0.0556;  // hulled_millet.par, mixer_runner.h, mixer.par

double sphere_mass(double radius) { return density * 4.0 / 3.0 * pi * std::pow(radius, 3); }

vtkNew<vtkPolyData> read_vtk(const fs::path& path) {
  vtkNew<vtkPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->ReadAllFieldsOn();
  reader->Update();
  vtkNew<vtkPolyData> data;
  data->ShallowCopy(reader->GetOutput());
  return data;
}

vtkNew<vtkPolyData> read_stl(const fs::path& path) {
  vtkNew<vtkSTLReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkNew<vtkPolyData> data;
  data->ShallowCopy(reader->GetOutput());
  return data;
}

std::set<std::string> files_in(const fs::path& folder, const std::string& extension) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension && entry.path().string().find("boundingBox") == std::string::npos)
      names.insert(entry.path().filename().string());
  return names;
}

std::string last_grains(const Mixer& mixer, const std::string& name) {
  const Table rows = mixer.csv(name + "/torque.csv");
  return name + fmt::format("/vtk/grains_{:.0f}.vtk", rows.at(rows.rows.size() - 1, "step"));
}

}  // namespace

// Mass asked for: fill times the booklet's 47.4 dm3 times 825 kg/m3, of which the slice has 2 of 22 paddles' share.
// Sizes: three with weights 1/6, 2/3, 1/6 at d and d (1 +- sqrt(3) spread), whose mean and standard deviation are d and
// d spread.
TEST(MixerFilling, HasTheMassAskedForAndTheSizesOfTheNormalDistribution) {
  Mixer mixer;
  mixer.must("run", two, "-var turns 0.02 -var fill 0.2");
  const double asked = 0.2 * 0.0474 * 825 * 2 / 22;
  EXPECT_NEAR(std::stod(mixer.header("run", "mass_target_kg")), asked, 1e-6 * asked);
  const auto grains = read_vtk(mixer.folder / last_grains(mixer, "run"));
  vtkDataArray* radius = grains->GetPointData()->GetArray("radius");
  ASSERT_NE(radius, nullptr);
  double mass = 0, mean = 0, square = 0;
  const double n = static_cast<double>(radius->GetNumberOfTuples());
  for (vtkIdType i = 0; i < radius->GetNumberOfTuples(); i++) {
    const double r = radius->GetTuple1(i);
    mass += sphere_mass(r);
    mean += 2 * r / n;
    square += 4 * r * r / n;
  }
  const double largest = sphere_mass(0.5 * diameter * (1 + std::sqrt(3) * spread));
  EXPECT_NEAR(mass, asked, 0.5 * largest);
  EXPECT_NEAR(std::stod(mixer.header("run", "mass_kg")), mass, 1e-5 * mass);  // the dump prints 6 digits
  const Table rows = mixer.csv("run/torque.csv");
  EXPECT_EQ(rows.at(0, "grains"), n);
  // counts are whole: a sixth is met within one grain of n
  EXPECT_NEAR(mean, diameter, 2 / n * diameter * spread);
  EXPECT_NEAR(std::sqrt(square - mean * mean), diameter * spread, 2 / n * diameter);
}

// The mixer's case, to be changed, in the folder of the test.
void copy_case(const Mixer& mixer) {
  fs::copy(fs::path(VIELTO_SOURCE_DIR "/cases/mixer"), mixer.folder / "mixer");
  for (const auto& shared : fs::directory_iterator(VIELTO_SOURCE_DIR "/cases"))
    if (shared.is_regular_file()) fs::copy(shared, mixer.folder);
}

// Runs the changed case to the run folder `run` beside it.
Outcome run_case(Mixer& mixer, const std::string& script, const std::string& more) {
  mixer.write("mixer/in.mixer", script);
  return mixer.shell(
      fmt::format("cd '{}/mixer' && PATH='{}':$PATH {} -in in.mixer -var run ../run -var materials '{}/materials' {}",
                  mixer.folder.string(), VIELTO_BIN_DIR, Mixer::command(), VIELTO_SOURCE_DIR, more));
}

// Our wall loop and LIGGGHTS', which stored contact forces ask for: faces, edges and corners of seven meshes, to the
// last digit.
TEST(MixerWalls, OurLoopGivesTheNumbersOfLiggghts) {
  Mixer mixer;
  mixer.must("ours", four, "-var turns 0.3");
  copy_case(mixer);
  std::string script = mixer.read("mixer/in.mixer");
  const std::string walls = "stems shaft drum ${settings}";
  const std::size_t at = script.find(walls);
  ASSERT_NE(at, std::string::npos);
  script.replace(at, walls.size(), "stems shaft drum store_force_contact yes ${settings}");
  const Outcome outcome = run_case(mixer, script, std::string(four) + " -var turns 0.3");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const Table ours = mixer.csv("ours/torque.csv"), liggghts = mixer.csv("run/torque.csv");
  EXPECT_EQ(ours.rows, liggghts.rows);
  EXPECT_EQ(ours.rows.size(), 108u);
}

// The state right after insertion: the script up to its first step. Triangles of a slice repeat with its length.
TEST(MixerFilling, ComesInWithoutTouchingRotorOrDrum) {
  Mixer mixer;
  copy_case(mixer);
  // each file up to and with a line, the rest of it left out
  const auto cut = [&](const std::string& file, const std::string& line, const std::string& more) {
    const std::string text = mixer.read(file);
    const std::size_t at = text.find("\n" + line);
    EXPECT_NE(at, std::string::npos) << file;
    mixer.write(file, text.substr(0, text.find('\n', at + 1) + 1) + more);
  };
  cut("filling.in", "run 1\n", "write_dump all custom/vtk ../in.vtk id type x y z vx vy vz radius\n");
  cut("mixer/bed.in", "include ${fillingFile}", "");
  cut("mixer/in.mixer", "vielto include bed.in", "");
  const Outcome outcome = run_case(mixer, mixer.read("mixer/in.mixer"), std::string("-var fill 0.25 ") + four);
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const auto grains = read_vtk(mixer.folder / "in.vtk");
  vtkDataArray* radius = grains->GetPointData()->GetArray("radius");
  ASSERT_GT(grains->GetNumberOfPoints(), 500);
  const double length = 4 * 0.765 / 22;
  double nearest = 1;
  for (const std::string& name : files_in(mixer.folder / "run.partial/mesh", ".stl")) {
    const auto mesh = read_stl(mixer.folder / "run.partial/mesh" / name);
    vtkNew<vtkCellLocator> locator;
    locator->SetDataSet(mesh);
    locator->BuildLocator();
    vtkNew<vtkGenericCell> cell;
    for (vtkIdType i = 0; i < grains->GetNumberOfPoints(); i++)
      for (const double shift : {-length, 0.0, length}) {
        double x[3], closest[3], square;
        vtkIdType id;
        int sub;
        grains->GetPoint(i, x);
        x[0] += shift;
        locator->FindClosestPoint(x, closest, cell, id, sub, square);
        nearest = std::min(nearest, std::sqrt(square) - radius->GetTuple1(i));
      }
  }
  EXPECT_GT(nearest, 0);
  EXPECT_LT(nearest, 0.05);  // the triangles looked at are near
}

// The line is the mixer's own: what the other rigs would change is no parameter of it.
TEST(MixerFilling, SaysWhatToDoWhereGrainFindsNoRoom) {
  Mixer mixer;
  copy_case(mixer);
  std::string script = mixer.read("mixer/in.mixer");
  const std::string room = "${density}*0.2*";
  ASSERT_NE(script.find(room), std::string::npos);
  script.replace(script.find(room), room.size(), "${density}*9*");
  const Outcome outcome = run_case(mixer, script, std::string("-var fill 0.25 ") + four);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.text.find("found room; lower fill or grainDiameter"), std::string::npos) << outcome.text;
  EXPECT_FALSE(fs::exists(mixer.folder / "run"));
}

// Without grain the record holds the idling model: mean T0 + Ta n^2 with a relative noise of 3 % a row, and no grain
// torque.
TEST(MixerIdling, RecordsTheModelsMeanAndNoise) {
  Mixer mixer;
  mixer.must("idle", two, "-var fill 0 -var turns 4");
  const Table rows = mixer.csv("idle/torque.csv");
  ASSERT_EQ(rows.rows.size(), 1440u);
  double mean = 0, square = 0;
  for (std::size_t k = 0; k < 1440; k++) {
    const double idle = rows.at(k, "idle_Nm");
    mean += idle / 1440;
    square += idle * idle / 1440;
    for (const char* part : {"paddles_Nm", "stems_Nm", "shaft_Nm", "drum_Nm", "grains", "gravity_Nm"})
      ASSERT_EQ(rows.at(k, part), 0) << part << " in row " << k;
  }
  const double model = 1.0 + 0.00093 * 1.58 * 1.58;
  EXPECT_NEAR(mean, model, 4 * 0.03 * model / std::sqrt(1440));
  EXPECT_NEAR(std::sqrt(square - mean * mean), 0.03 * model, 4 * 0.03 * model / std::sqrt(2 * 1440));
  EXPECT_NEAR(rows.at(1439, "time_s"), 4 / 1.58, 1e-6);
  EXPECT_EQ(mixer.header("idle", "fill"), "0");
}

// Coarse grain is wedged beside outer paddles that leave it less than two diameters: said before the run is paid for.
TEST(MixerWholeDrum, WarnsOfLessThanTwoGrainsBesideItsOuterPaddles) {
  Mixer mixer;
  const std::string brief = "-var fill 0 -var turns 3 -var grainDiameter 0.012 ";
  const auto text = [&](const std::string& name, const std::string& options) {
    const Outcome outcome = mixer.rig(name, brief + options);
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return outcome.text;
  };
  const std::string near = text("near", "-var slicePaddles 0 -var paddlePitch 0.033");
  EXPECT_NE(near.find("Warning: the outer paddles leave 0.93"), std::string::npos) << near;  // 11.206 mm over 12 mm
  EXPECT_NE(near.find("paddlePitch"), std::string::npos) << near;
  for (const std::string& quiet :
       {text("far", "-var slicePaddles 0 -var paddlePitch 0.031"), text("slice", "-var slicePaddles 4")})
    EXPECT_EQ(quiet.find("Warning: the outer paddles"), std::string::npos) << quiet;
}

// End walls hold the grain: all stay between them for some hundred steps, and the ends push along the axis.
TEST(MixerWholeDrum, KeepsEveryGrainBetweenItsEndWalls) {
  Mixer mixer;
  mixer.must("drum", four, "-var slicePaddles 0 -var grainDiameter 0.02 -var turns 0.05 -var restartTurns 0");
  EXPECT_EQ(mixer.header("drum", "slice"), "0");
  const double asked = 0.15 * 0.0474 * 825;
  EXPECT_NEAR(std::stod(mixer.header("drum", "mass_kg")), asked, 0.5 * sphere_mass(0.01 * (1 + std::sqrt(3) * spread)));
  const auto grains = read_vtk(mixer.folder / last_grains(mixer, "drum"));
  const Table rows = mixer.csv("drum/torque.csv");
  ASSERT_EQ(rows.rows.size(), 18u);
  EXPECT_EQ(rows.at(17, "grains"), static_cast<double>(grains->GetNumberOfPoints()));
  EXPECT_GT(rows.at(17, "step"), 300);
  double low = 1, high = 0;
  for (vtkIdType i = 0; i < grains->GetNumberOfPoints(); i++) {
    low = std::min(low, grains->GetPoint(i)[0]);
    high = std::max(high, grains->GetPoint(i)[0]);
  }
  EXPECT_GT(low, 0);
  EXPECT_LT(low, 0.03);
  EXPECT_LT(high, 0.765);
  EXPECT_GT(high, 0.765 - 0.03);
}

TEST(MixerSlice, OfTwoPaddlesRecordsEachOfThem) {
  Mixer mixer;
  mixer.must("run", two, "-var turns 0.1");
  EXPECT_EQ(mixer.header("run", "slice"), "2");
  EXPECT_EQ(mixer.header("run", "paddle_angles_deg"), "0 90");
  const Table rows = mixer.csv("run/torque.csv");
  double most = 0;
  for (std::size_t k = 0; k < rows.rows.size(); k++) {
    EXPECT_NEAR(rows.at(k, "paddle1_Nm") + rows.at(k, "paddle2_Nm"), rows.at(k, "paddles_Nm"), 1e-7);
    most = std::max(most, rows.at(k, "paddles_Nm"));
  }
  EXPECT_GT(most, 0.1);
}

// ParaView's files: a series where asked for, and the last state always; rotor in the place it has then.
TEST(MixerDumps, OpenWithGrainsAndTheRotorWhereItStands) {
  Mixer mixer;
  mixer.must("run", two, "-var turns 0.25 -var vtkPerTurn 20");
  const Table rows = mixer.csv("run/torque.csv");
  const double every = 18 * rows.at(0, "step"), last = rows.at(89, "step");
  std::set<std::string> series, rotors;
  for (int k = 0; k <= 5; k++) {
    series.insert(fmt::format("grains_{:.0f}.vtk", k * every));
    rotors.insert(fmt::format("rotor_{:.0f}.stl", k * every));
  }
  EXPECT_EQ(last, 5 * every);
  EXPECT_EQ(files_in(mixer.folder / "run/vtk", ".vtk"), series);
  EXPECT_EQ(files_in(mixer.folder / "run/vtk", ".stl"), rotors);
  const auto grains = read_vtk(mixer.folder / last_grains(mixer, "run"));
  ASSERT_EQ(static_cast<double>(grains->GetNumberOfPoints()), rows.at(89, "grains"));
  vtkDataArray *v = grains->GetPointData()->GetArray("v"), *radius = grains->GetPointData()->GetArray("radius");
  ASSERT_NE(v, nullptr);
  ASSERT_NE(radius, nullptr);
  ASSERT_NE(grains->GetPointData()->GetArray("omega"), nullptr);
  ASSERT_EQ(v->GetNumberOfComponents(), 3);
  double kinetic = 0;  // of translation, less than the record's with rotation
  for (vtkIdType i = 0; i < grains->GetNumberOfPoints(); i++) {
    const double* u = v->GetTuple3(i);
    kinetic += 0.5 * sphere_mass(radius->GetTuple1(i)) * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  }
  EXPECT_LT(kinetic, rows.at(89, "kinetic_J"));
  EXPECT_GT(kinetic, 0.5 * rows.at(89, "kinetic_J"));
  // a quarter turn about x carries y to z and z to -y
  double at_start[6], at_end[6];
  read_stl(mixer.folder / "run/vtk/rotor_0.stl")->GetBounds(at_start);
  read_stl(mixer.folder / fmt::format("run/vtk/rotor_{:.0f}.stl", last))->GetBounds(at_end);
  EXPECT_NEAR(at_end[5], at_start[3], 1e-6);
  EXPECT_NEAR(at_end[4], at_start[2], 1e-6);
  EXPECT_NEAR(at_end[2], -at_start[5], 1e-6);
  EXPECT_NEAR(at_end[3], -at_start[4], 1e-6);
  EXPECT_GT(std::fabs(at_end[3] - at_start[3]), 0.01);  // two paddles at 0 and 90 deg: the bounds tell the turn
}

TEST(MixerRun, IsDecidedByItsSeedAndSameWithTheStockProgram) {
  Mixer mixer;
  const std::string brief = "-var turns 0.1 ";
  mixer.must("a", two, brief);
  mixer.must("b", two, brief);
  mixer.must("stock", two, brief, 1, Program::stock);
  mixer.must("other", two, brief + "-var seed 2");
  const std::string a = mixer.read("a/torque.csv");
  EXPECT_EQ(a, mixer.read("b/torque.csv"));
  EXPECT_EQ(a, mixer.read("stock/torque.csv"));
  const Table rows = mixer.csv("a/torque.csv"), other = mixer.csv("other/torque.csv");
  for (const char* column : {"paddles_Nm", "drum_Nm", "idle_Nm"})
    EXPECT_NE(rows.at(0, column), other.at(0, column)) << column;
}

TEST(MixerRun, FillsAndTurnsOnTwoRanks) {
  Mixer mixer;
  mixer.must("run", four, "-var turns 0.05", 2);
  const double asked = 0.15 * 0.0474 * 825 * 4 / 22;
  EXPECT_NEAR(std::stod(mixer.header("run", "mass_kg")), asked,
              0.5 * sphere_mass(0.5 * diameter * (1 + std::sqrt(3) * spread)));
  const Table rows = mixer.csv("run/torque.csv");
  ASSERT_EQ(rows.rows.size(), 18u);
  EXPECT_EQ(rows.at(17, "grains"), rows.at(0, "grains"));
  EXPECT_EQ(static_cast<double>(read_vtk(mixer.folder / last_grains(mixer, "run"))->GetNumberOfPoints()),
            rows.at(0, "grains"));
}

// run.json tells how to repeat the run.
TEST(MixerRun, FolderStatesParametersAndInputs) {
  Mixer mixer;
  mixer.must("run", two, "-var turns 0.02");
  const nlohmann::json run = nlohmann::json::parse(mixer.read("run/run.json"));
  EXPECT_EQ(run["status"], "complete");
  EXPECT_EQ(run["parameters"]["grainDiameter"], "0.016");
  EXPECT_EQ(run["parameters"]["youngsModulus"], "2e5");
  EXPECT_EQ(run["parameters"]["wall_youngsModulus"], "2e5");
  // what no -var changes is the card's
  std::ifstream card(VIELTO_SOURCE_DIR "/materials/steel.par");
  const std::string steel((std::istreambuf_iterator<char>(card)), std::istreambuf_iterator<char>());
  EXPECT_NE(
      steel.find("variable frictionAngle index " + run["parameters"]["wall_frictionAngle"].get<std::string>() + " "),
      std::string::npos);
  EXPECT_EQ(run["parameters"]["seed"], "1");
  for (const char* file :
       {"in.mixer", "bed.in", "mixer.par", "../law.par", "../card.par", "../engine.in", "../law.in", "../drag.in",
        "../filling.in", "../../materials/hulled_millet.par", "../../materials/steel.par"})
    EXPECT_EQ(run["hashes"].value(file, "").size(), 64u) << file;
  EXPECT_EQ(run["hashes"].size(), 11u) << run["hashes"];
  EXPECT_NE(run["command"].get<std::string>().find("-in in.mixer"), std::string::npos);
  EXPECT_EQ(run["versions"].size(), 2u);
}

// SPDX-License-Identifier: GPL-2.0-or-later
// The geometry of a machine of a user's own, through `vielto geometry`: volumes, areas and clearances of bodies from
// formulas, what is mended, what is refused.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "machine_shapes.h"

namespace fs = std::filesystem;
using namespace machine_shapes;

namespace {

struct Outcome {
  int status;
  std::string text;
};

Outcome run(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.text.append(buffer, n);
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class MachineGeometry : public testing::Test {
 protected:
  MachineGeometry() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::temp_directory_path() / (std::string("machine_geometry_") + info->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~MachineGeometry() override { fs::remove_all(folder); }

  Outcome make(const std::string& settings = "") const {
    return run(std::string(VIELTO_BIN_DIR) +
               "/vielto geometry " VIELTO_SOURCE_DIR "/cases/machine/machine.par --out '" + (folder / "mesh").string() +
               "' --set parts='" + (folder / "machine.toml").string() + "' " + settings);
  }
  nlohmann::json must(const std::string& settings = "") const {
    const Outcome done = make(settings);
    EXPECT_EQ(done.status, 0) << done.text;
    return nlohmann::json::parse(std::ifstream(folder / "mesh/machine.json"));
  }
  // Demands one line with all of `words`, and no mesh.
  void refused(const std::vector<std::string>& words, const std::string& settings = "") const {
    fs::remove_all(folder / "mesh");
    const Outcome done = make(settings);
    EXPECT_EQ(done.status, 2) << done.text;
    for (const std::string& word : words)
      EXPECT_NE(done.text.find(word), std::string::npos) << word << "\n" << done.text;
    EXPECT_EQ(std::count(done.text.begin(), done.text.end(), '\n'), 1) << done.text;
    EXPECT_FALSE(fs::exists(folder / "mesh/geometry.par"));
  }
  std::vector<Vertex> places() const {
    std::ifstream in(folder / "mesh/places.csv");
    std::string line;
    std::getline(in, line);
    std::vector<Vertex> list;
    for (Vertex p; std::getline(in, line) && std::sscanf(line.c_str(), "%lf,%lf,%lf", &p[0], &p[1], &p[2]) == 3;)
      list.push_back(p);
    return list;
  }

  fs::path folder;
  RibbonMixer mixer;
};

}  // namespace

TEST_F(MachineGeometry, VolumesAreasAndClearanceOfARibbonMixer) {
  mixer.write_to(folder);
  const nlohmann::json told = must();
  // The surface integral is exact but for pieces at the drum's edges; the faces there are upright and add nothing.
  EXPECT_NEAR(told["vessel_volume_m3"], mixer.drum_volume(), 1e-3 * mixer.drum_volume());
  EXPECT_TRUE(told["rim_m"].is_null());
  const auto& blade = told["parts"]["helix"];
  EXPECT_NEAR(blade["volume_m3"], mixer.blade_volume(), 1e-9 * mixer.blade_volume());
  // walls and ends exactly; the helicoids in 36 segments are within the relative error (2 pi / 36)^2 / 6 of a sagitta
  const double chord = 2 * std::sin(pi / mixer.segments) * mixer.segments;
  const double flat = mixer.t * (chord * (mixer.r0 + mixer.r1) + 2 * (mixer.r1 - mixer.r0));
  const double area = flat + helicoids_area(mixer.r0, mixer.r1, mixer.pitch, 2 * pi);
  EXPECT_NEAR(blade["area_m2"], area, std::pow(2 * pi / 36, 2) / 6 * area);
  EXPECT_NEAR(told["rotor_radius_m"], mixer.r1, 1e-12);
  EXPECT_NEAR(told["clearance_m"], mixer.clearance(), told["clearance_tolerance_m"]);
  EXPECT_LE(told["clearance_tolerance_m"], 5.01e-5);
  EXPECT_NEAR(told["parts"]["drum"]["high_m"][0], mixer.L, 1e-12);
}

// The same machine in another frame and unit: mm, up along y, the axis along -z through (5, 7, 9) mm, as binary STL
// whose header begins with "solid", text with CRLF, and one written inside out.
TEST_F(MachineGeometry, FrameUnitAndFormatDoNotMatter) {
  const auto moved = [](const Facets& facets) {
    Facets out = facets;
    for (Facet& f : out)
      for (Vertex& v : f) v = {-v[1] + 0.005, v[2] + 0.007, -v[0] + 0.009};
    return out;
  };
  write(folder / "drum.stl", binary_stl(moved(mixer.drum()), 1000, "solid drum by CAD"));
  write(folder / "helix.stl", text_stl(turned_round(moved(mixer.blade())), 1000, "\r\n"));
  write(folder / "axle.stl", binary_stl(moved(mixer.axle()), 1000));
  std::string parts = RibbonMixer::parts_file("mm");
  parts.replace(parts.find("up = [0, 0, 1]"), 14, "up = [0, 1, 0]");
  parts.replace(parts.find("origin = [0, 0, 0]"), 18, "origin = [5, 7, 9]");
  parts.replace(parts.find("direction = [1, 0, 0]"), 21, "direction = [0, 0, -1]");
  write(folder / "machine.toml", parts);
  const nlohmann::json told = must();
  // single precision of the files: 1e-7 of 160 mm at a vertex
  EXPECT_NEAR(told["vessel_volume_m3"], mixer.drum_volume(), 1e-3 * mixer.drum_volume());
  EXPECT_NEAR(told["parts"]["helix"]["volume_m3"], mixer.blade_volume(), 1e-5 * mixer.blade_volume());
  EXPECT_NEAR(told["clearance_m"], mixer.clearance(), told["clearance_tolerance_m"].get<double>() + 1e-7);
  EXPECT_NEAR(told["parts"]["drum"]["low_m"][0], 0, 1e-7);
  EXPECT_NEAR(told["parts"]["drum"]["high_m"][0], mixer.L, 1e-7);
  EXPECT_EQ(told["parts"]["helix"]["mended"].dump(),
            "[\"" + std::to_string(mixer.blade().size()) + " triangles turned round\"]");
}

TEST_F(MachineGeometry, OpenTroughHoldsGrainUpToItsRim) {
  mixer.write_to(folder);
  const double top = 0.12;
  write(folder / "drum.stl", text_stl(trough(0, mixer.L, mixer.R, top, 24)));
  refused({"drum.stl: is not closed: ", "open = true for part drum"});
  std::string parts = RibbonMixer::parts_file();
  parts.replace(parts.find("\"stands\""), 8, "\"stands\"\nopen = true");
  write(folder / "machine.toml", parts);
  const nlohmann::json told = must("--set grainDiameter=0.01 --set fill=0.5");
  const double volume = mixer.L * (24 / 2.0 * mixer.R * mixer.R * std::sin(pi / 24) + 2 * mixer.R * top);
  EXPECT_NEAR(told["rim_m"], top, 1e-12);
  EXPECT_NEAR(told["vessel_volume_m3"], volume, 2e-3 * volume);
  // every place has room for the largest grain: off all walls and below the rim, and off the others
  const double r = 0.5 * 0.01 * (1 + 0.0556 * std::sqrt(3.0));
  const std::vector<Vertex> grains = places();
  ASSERT_GT(grains.size(), 500u);
  double before = -1;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Vertex& p = grains[i];
    EXPECT_GE(p[2], before);  // from the lowest up
    before = p[2];
    EXPECT_GE(p[0], r - 1e-9);
    EXPECT_LE(p[0], mixer.L - r + 1e-9);
    EXPECT_LE(p[2], top - r + 1e-9);
    const double reach = p[2] < 0 ? std::hypot(p[1], p[2]) : std::fabs(p[1]);
    EXPECT_LE(reach, mixer.R - r + 1e-9);
    const double from_axis = std::hypot(p[1], p[2]);
    EXPECT_GE(from_axis, mixer.shaft * std::cos(pi / 24) + r - 1e-9);
    for (std::size_t j = 0; j < i; ++j) {
      const double d = std::hypot(p[0] - grains[j][0], p[1] - grains[j][1], p[2] - grains[j][2]);
      ASSERT_GE(d, 2 * r * (1 - 1e-7));
    }
  }
}

// A shell of sheet 2 mm thick, thinner than a cube of the lattice, holds what its inside holds.
TEST_F(MachineGeometry, ThinSheetIsNoRoom) {
  mixer.write_to(folder);
  Facets shell = mixer.drum();
  for (const Facet& f : cylinder(-0.002, mixer.L + 0.002, mixer.R + 0.002, mixer.chords)) shell.push_back(f);
  write(folder / "drum.stl", text_stl(shell));
  EXPECT_NEAR(must()["vessel_volume_m3"], mixer.drum_volume(), 1e-3 * mixer.drum_volume());
}

TEST_F(MachineGeometry, SliversZeroAreasAndDoublesAreMended) {
  mixer.write_to(folder);
  Facets axle = mixer.axle();
  const Facet first = axle.front();
  axle.push_back({first[0], first[0], first[1]});  // no area
  axle.push_back(first);                           // twice
  write(folder / "axle.stl", text_stl(axle));
  // a drum of 300 chords, whose strips have an angle of 0.75 degrees
  mixer.chords = 300;
  write(folder / "drum.stl", text_stl(mixer.drum()));
  const nlohmann::json told = must();
  EXPECT_NE(told["parts"]["axle"]["mended"].dump().find("1 triangles without area dropped"), std::string::npos);
  EXPECT_NE(told["parts"]["axle"]["mended"].dump().find("1 triangles that were there twice dropped"),
            std::string::npos);
  EXPECT_NE(told["parts"]["drum"]["mended"].dump().find("slivers cut anew"), std::string::npos);
  EXPECT_NEAR(told["parts"]["drum"]["volume_m3"], mixer.drum_volume(), 1e-9 * mixer.drum_volume());
  EXPECT_NEAR(told["vessel_volume_m3"], mixer.drum_volume(), 1e-3 * mixer.drum_volume());
}

TEST_F(MachineGeometry, RefusesFilesThatAreNone) {
  mixer.write_to(folder);
  const std::string text = text_stl(mixer.blade()), binary = binary_stl(mixer.blade());
  const auto helix = [&](const std::string& content) { write(folder / "helix.stl", content); };
  helix(text.substr(0, text.size() / 2));
  refused({"helix.stl, line ", "export it again"});
  helix(text.substr(0, text.rfind("endsolid")));
  refused({"helix.stl, line ", "ends before 'endsolid': the file is cut off"});
  helix(binary.substr(0, binary.size() - 7));
  refused({"helix.stl: is no STL file, or cut off", "triangles take"});
  helix("");
  refused({"helix.stl: is empty"});
  helix("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\nendfacet\nendsolid x\n");
  refused({"helix.stl, line 4: is no vertex of three numbers"});
  helix("solid x\nendsolid x\n");
  refused({"helix.stl: holds no triangle"});
  helix("ISO-10303-21;\nHEADER;\n");
  refused({"helix.stl: is no STL file"});
  helix(
      "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 "
      "0\nendloop\nendfacet\nendsolid\n");
  refused({"helix.stl: holds no triangle wider than"});
  fs::remove(folder / "helix.stl");
  refused({"helix.stl: cannot be read"});
}

TEST_F(MachineGeometry, RefusesPartsThatDoNotFit) {
  mixer.write_to(folder);
  const auto stl = [&](const std::string& part, const Facets& facets) {
    write(folder / (part + ".stl"), text_stl(facets));
  };
  Facets torn = mixer.blade();
  torn.pop_back();
  stl("helix", torn);
  refused(
      {"helix.stl: is not closed: 3 edges have one triangle only", "close it in CAD", "open = true for part helix"});

  RibbonMixer wide = mixer;
  wide.r1 = mixer.R + 0.001;
  stl("helix", wide.blade());
  refused({"machine.toml: what turns meets what stands within a turn", "through = true"});
  // it only meets the drum when it has turned: a nose in the drum's wall
  stl("helix", mixer.blade());
  Facets nosed = mixer.drum();
  for (const Facet& f : cylinder(0.07, 0.08, 0.01, 8)) {
    Facet up = f;
    for (Vertex& v : up) v[2] += mixer.R - 0.008;
    nosed.push_back(up);
  }
  stl("drum", nosed);
  refused({"what turns meets what stands"});

  stl("drum", mixer.drum());
  Facets outside = mixer.blade();
  for (Facet& f : outside)
    for (Vertex& v : f) v[0] += 1;
  stl("helix", outside);
  refused({"what turns does not lie in a vessel that holds grain"});
  stl("helix", mixer.blade());
  // a drum without its lower end, upright: it holds nothing
  std::string parts = RibbonMixer::parts_file();
  parts.replace(parts.find("up = [0, 0, 1]"), 14, "up = [1, 0, 0]");
  parts.replace(parts.find("\"stands\""), 8, "\"stands\"\nopen = true");
  write(folder / "machine.toml", parts);
  stl("drum", turned_round(cylinder(0, mixer.L, mixer.R, mixer.chords, false, true)));
  refused({"does not lie in a vessel that holds grain", "hole in the vessel's bottom"});
  // open above instead it holds all, but the ribbon must not stand out of it
  stl("drum", turned_round(cylinder(0, 0.1, mixer.R, mixer.chords, true, false)));
  refused({"helix.stl: part helix rises ", "over the rim of the vessel"});

  mixer.write_to(folder);
  refused({"'vesselVolume' 0.004: the meshes hold 0.00501"}, "--set vesselVolume=0.004");
  refused({"'fill' 0.99: the rotor leaves "}, "--set fill=0.99 --set vesselVolume=0");
}

TEST_F(MachineGeometry, RefusesPartsFilesThatContradict) {
  mixer.write_to(folder);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string parts = RibbonMixer::parts_file();
    const auto at = parts.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(folder / "machine.toml", parts.replace(at, from.size(), to));
  };
  with("unit = \"m\"", "unit = \"mm\"");
  refused({"machine.toml, line 1", "unit", "is 'mm', with which the machine is 0.0002 m long"});
  with("unit = \"m\"", "unit = \"yard\"");
  refused({"machine.toml, line 1", "is no unit of length here"});
  with("motion = \"turns\"", "motion = \"spins\"");
  refused({"motion", "write turns or stands"});
  with("\"helix\"", "\"the helix\"");
  refused({"'the helix' is no name of a part"});
  with("\"helix\"", "\"drum\"");
  refused({"has the name 'drum' twice"});
  with("direction = [1, 0, 0]", "direction = [0, 0, 0]");
  refused({"direction", "has no length"});
  with("up = [0, 0, 1]", "up = [0, 1]");
  refused({"up", "is not three numbers"});
  with("motion = \"stands\"", "motion = \"turns\"");
  refused({"has none that stands"});
  with("through = true", "thorough = true");
  refused({"thorough"});
  write(folder / "machine.toml", "unit = \n");
  refused({"machine.toml, line 1"});
  fs::remove(folder / "machine.toml");
  refused({"machine.toml: cannot be read"});
}

// What is made must not be written over what it was made from.
TEST_F(MachineGeometry, RefusesToOverwriteItsInput) {
  mixer.write_to(folder);
  const std::string before = text_stl(mixer.drum());
  const Outcome done =
      run(std::string(VIELTO_BIN_DIR) + "/vielto geometry " VIELTO_SOURCE_DIR "/cases/machine/machine.par --out '" +
          folder.string() + "' --set parts='" + (folder / "machine.toml").string() + "'");
  EXPECT_EQ(done.status, 2) << done.text;
  EXPECT_NE(done.text.find("would be overwritten by part drum"), std::string::npos) << done.text;
  std::ifstream in(folder / "drum.stl");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), before);
}

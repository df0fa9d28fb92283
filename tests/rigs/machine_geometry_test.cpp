// SPDX-License-Identifier: GPL-2.0-or-later
// The geometry of a machine of a user's own, through `vielto geometry`: volumes, areas and clearances of bodies from
// formulas, what is mended, what is refused.
#include <nlohmann/json.hpp>

#include "machine_shapes.h"
#include "tests/cli/command_test.h"

namespace fs = std::filesystem;
using namespace machine_shapes;

namespace {

class MachineGeometry : public vielto_test::CommandTest {
 protected:
  int make(const std::string& settings = "") {
    return vielto("geometry " VIELTO_SOURCE_DIR "/cases/machine/machine.par --out mesh --set parts='" +
                  (folder_ / "machine.toml").string() + "' " + settings);
  }
  nlohmann::json must(const std::string& settings = "") {
    EXPECT_EQ(make(settings), 0) << err_;
    return nlohmann::json::parse(std::ifstream(folder_ / "mesh/machine.json"));
  }
  // Demands one line with all of `words`, and no mesh.
  void refused(const std::vector<std::string>& words, const std::string& settings = "") {
    fs::remove_all(folder_ / "mesh");
    EXPECT_EQ(make(settings), 2) << err_;
    for (const std::string& word : words) EXPECT_NE(err_.find(word), std::string::npos) << word << "\n" << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
    EXPECT_FALSE(fs::exists(folder_ / "mesh"));
  }
  std::vector<Vertex> places() const {
    std::ifstream in(folder_ / "mesh/places.csv");
    std::string line;
    std::getline(in, line);
    std::vector<Vertex> list;
    for (Vertex p; std::getline(in, line) && std::sscanf(line.c_str(), "%lf,%lf,%lf", &p[0], &p[1], &p[2]) == 3;)
      list.push_back(p);
    return list;
  }

  RibbonMixer mixer;
};

}  // namespace

TEST_F(MachineGeometry, VolumesAreasAndClearanceOfARibbonMixer) {
  mixer.write_to(folder_);
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
  write(folder_ / "drum.stl", binary_stl(moved(mixer.drum()), 1000, "solid drum by CAD"));
  write(folder_ / "helix.stl", text_stl(turned_round(moved(mixer.blade())), 1000, "\r\n"));
  write(folder_ / "axle.stl", binary_stl(moved(mixer.axle()), 1000));
  std::string parts = RibbonMixer::parts_file("mm");
  parts.replace(parts.find("up = [0, 0, 1]"), 14, "up = [0, 1, 0]");
  parts.replace(parts.find("origin = [0, 0, 0]"), 18, "origin = [5, 7, 9]");
  parts.replace(parts.find("direction = [1, 0, 0]"), 21, "direction = [0, 0, -1]");
  write(folder_ / "machine.toml", parts);
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
  mixer.shaft = 0.04;  // a grain has room inside it
  mixer.write_to(folder_);
  const double top = 0.12;
  write(folder_ / "drum.stl", text_stl(trough(0, mixer.L, mixer.R, top, 24)));
  refused({"drum.stl: is not closed: ", "open = true for part drum"});
  std::string parts = RibbonMixer::parts_file();
  parts.replace(parts.find("\"stands\""), 8, "\"stands\"\nopen = true");
  write(folder_ / "machine.toml", parts);
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

// Bodies of one file may run into one another: two hubs about a shaft, each with room for grains, as is what they
// share.
TEST_F(MachineGeometry, NoGrainInsideBodiesThatOverlap) {
  mixer.write_to(folder_);
  Facets hubs = cylinder(0.02, 0.1, 0.06, 24);
  for (const Facet& f : cylinder(0.06, 0.14, 0.06, 24)) hubs.push_back(f);
  write("helix.stl", text_stl(hubs));
  must("--set grainDiameter=0.01 --set fill=0.5");
  const double r = 0.5 * 0.01 * (1 + 0.0556 * std::sqrt(3.0));
  const std::vector<Vertex> grains = places();
  ASSERT_GT(grains.size(), 500u);
  for (const Vertex& p : grains)
    if (p[0] > 0.02 && p[0] < 0.14) {
      EXPECT_GE(std::hypot(p[1], p[2]), 0.06 * std::cos(pi / 24) + r - 1e-9);
    }
}

// A shell of sheet 2 mm thick, thinner than a cube of the lattice, holds what its inside holds.
TEST_F(MachineGeometry, ThinSheetIsNoRoom) {
  mixer.write_to(folder_);
  Facets shell = mixer.drum();
  for (const Facet& f : cylinder(-0.002, mixer.L + 0.002, mixer.R + 0.002, mixer.chords)) shell.push_back(f);
  write(folder_ / "drum.stl", text_stl(shell));
  EXPECT_NEAR(must()["vessel_volume_m3"], mixer.drum_volume(), 1e-3 * mixer.drum_volume());
}

TEST_F(MachineGeometry, SliversZeroAreasAndDoublesAreMended) {
  mixer.write_to(folder_);
  Facets axle = mixer.axle();
  const Facet first = axle.front();
  axle.push_back({first[0], first[0], first[1]});  // no area
  axle.push_back(first);                           // twice
  write(folder_ / "axle.stl", text_stl(axle));
  // a drum of 300 chords, whose strips have an angle of 0.75 degrees
  mixer.chords = 300;
  write(folder_ / "drum.stl", text_stl(mixer.drum()));
  const nlohmann::json told = must();
  EXPECT_NE(told["parts"]["axle"]["mended"].dump().find("1 triangles without area dropped"), std::string::npos);
  EXPECT_NE(told["parts"]["axle"]["mended"].dump().find("1 triangles that were there twice dropped"),
            std::string::npos);
  EXPECT_NE(told["parts"]["drum"]["mended"].dump().find("slivers cut anew"), std::string::npos);
  EXPECT_NEAR(told["parts"]["drum"]["volume_m3"], mixer.drum_volume(), 1e-9 * mixer.drum_volume());
  EXPECT_NEAR(told["vessel_volume_m3"], mixer.drum_volume(), 1e-3 * mixer.drum_volume());
}

// Ends of a drum as fans about a corner of the rim, as CAD programs cut plane faces: an apex of 180/n degrees each. And
// a crack along an edge closed by a triangle without area.
TEST_F(MachineGeometry, FansAndCracksAreCutAnew) {
  const int n = 400;
  const auto rim = [&](double x, int i) { return around_x(x, mixer.R, 2 * pi * i / n); };
  Facets drum = cylinder(0, mixer.L, mixer.R, n, false, false);
  for (int i = 1; i + 1 < n; ++i) {
    drum.push_back({rim(0, 0), rim(0, i + 1), rim(0, i)});
    if (i > 1) drum.push_back({rim(mixer.L, 0), rim(mixer.L, i), rim(mixer.L, i + 1)});
  }
  const Vertex a = rim(mixer.L, 0), b = rim(mixer.L, 1), c = rim(mixer.L, 2);
  const Vertex middle = {(a[0] + c[0]) / 2, (a[1] + c[1]) / 2, (a[2] + c[2]) / 2};
  drum.push_back({a, b, middle});
  drum.push_back({middle, b, c});
  drum.push_back({a, middle, c});  // no area
  mixer.write_to(folder_);
  write("drum.stl", text_stl(turned_round(drum)));
  const nlohmann::json told = must();
  const double volume = mixer.L * n / 2.0 * mixer.R * mixer.R * std::sin(2 * pi / n);
  EXPECT_NEAR(told["parts"]["drum"]["volume_m3"], volume, 1e-9 * volume);
  ASSERT_EQ(vielto("geometry --check mesh/drum.stl --closed"), 0) << err_;
  const auto at = out_.find("smallest angle ");
  ASSERT_NE(at, std::string::npos) << out_;
  EXPECT_GE(std::stod(out_.substr(at + 15)), 1.0) << out_;
}

TEST_F(MachineGeometry, RefusesFilesThatAreNone) {
  mixer.write_to(folder_);
  const std::string text = text_stl(mixer.blade()), binary = binary_stl(mixer.blade());
  const auto helix = [&](const std::string& content) { write(folder_ / "helix.stl", content); };
  helix(text.substr(0, text.size() / 2));
  refused({"helix.stl, line ", "export it again"});
  helix(text.substr(0, text.rfind("endsolid")));
  refused({"helix.stl, line ", "ends before 'endsolid': the file is cut off"});
  helix(binary.substr(0, binary.size() - 7));
  refused({"helix.stl: is no STL file, or cut off: its length is not that of its number of triangles"});
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
  fs::remove(folder_ / "helix.stl");
  refused({"helix.stl: cannot be read"});
}

TEST_F(MachineGeometry, RefusesPartsThatDoNotFit) {
  mixer.write_to(folder_);
  const auto stl = [&](const std::string& part, const Facets& facets) {
    write(folder_ / (part + ".stl"), text_stl(facets));
  };
  Facets torn = mixer.blade();
  torn.pop_back();
  stl("helix", torn);
  refused(
      {"helix.stl: is not closed: 3 edges have one triangle only", "close it in CAD", "open = true for part helix"});

  RibbonMixer wide = mixer;
  wide.r1 = mixer.R + 0.001;
  stl("helix", wide.blade());
  refused({"machine.toml: part helix meets drum within a turn, ", "through = true"});
  // it only meets the drum when it has turned: a nose in the drum's wall
  stl("helix", mixer.blade());
  Facets nosed = mixer.drum();
  for (const Facet& f : cylinder(0.07, 0.08, 0.01, 8)) {
    Facet up = f;
    for (Vertex& v : up) v[2] += mixer.R - 0.008;
    nosed.push_back(up);
  }
  stl("drum", nosed);
  refused({"part helix meets drum within a turn"});

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
  write(folder_ / "machine.toml", parts);
  stl("drum", turned_round(cylinder(0, mixer.L, mixer.R, mixer.chords, false, true)));
  refused({"does not lie in a vessel that holds grain", "hole in the vessel's bottom"});
  // open above instead it holds all, but the ribbon must not stand out of it
  stl("drum", turned_round(cylinder(0, 0.1, mixer.R, mixer.chords, true, false)));
  refused({"helix.stl: part helix rises ", "over the rim of the vessel"});

  mixer.write_to(folder_);
  refused({"'vesselVolume' 0.004: the meshes hold 0.00501"}, "--set vesselVolume=0.004");
  refused({"'fill' 0.99: the rotor leaves "}, "--set fill=0.99 --set vesselVolume=0");
}

TEST_F(MachineGeometry, RefusesPartsFilesThatContradict) {
  mixer.write_to(folder_);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string parts = RibbonMixer::parts_file();
    const auto at = parts.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(folder_ / "machine.toml", parts.replace(at, from.size(), to));
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
  write(folder_ / "machine.toml", "unit = \n");
  refused({"machine.toml, line 1"});
  fs::remove(folder_ / "machine.toml");
  refused({"machine.toml: cannot be read"});
}

// What is made must not be written over what it was made from.
TEST_F(MachineGeometry, RefusesToOverwriteItsInput) {
  mixer.write_to(folder_);
  EXPECT_EQ(vielto("geometry " VIELTO_SOURCE_DIR "/cases/machine/machine.par --out . --set parts='" +
                   (folder_ / "machine.toml").string() + "'"),
            2);
  EXPECT_NE(err_.find("would be overwritten by part drum"), std::string::npos) << err_;
  EXPECT_EQ(vielto_test::content(folder_ / "drum.stl"), text_stl(mixer.drum()));
}

// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto geometry` through its real command line, and what LIGGGHTS makes of its files.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace {

const std::string kVielto = VIELTO_BIN_DIR "/vielto";
const std::string kCases = VIELTO_SOURCE_DIR "/cases";
const std::string kMixer = kCases + "/mixer/mixer.par";

struct Outcome {
  int status;
  std::string text;  // both streams
};

// Open MPI's session folder of a single process is shared by all of them and may vanish at a start: own one for this
// test.
struct SessionFolder {
  SessionFolder() {
    std::string name = (fs::temp_directory_path() / "vielto-mpi-XXXXXX").string();
    path = mkdtemp(&name[0]);
    setenv("OMPI_MCA_orte_tmpdir_base", path.c_str(), 1);
  }
  ~SessionFolder() { fs::remove_all(path); }
  fs::path path;
};

Outcome run(const std::string& command) {
  static const SessionFolder session;
  Outcome outcome;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.text.append(buffer, n);
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class GeometryCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() /
             ("vielto_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
              std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  Outcome make(const std::string& arguments) {
    return run(kVielto + " geometry " + arguments + " --out " + (folder / "mesh").string());
  }
  Outcome check(const std::string& name, const std::string& more = "") {
    return run(kVielto + " geometry --check " + (folder / name).string() + " " + more);
  }
  void expect_refusal(const Outcome& outcome, const std::string& word) {
    EXPECT_EQ(outcome.status, 2) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << outcome.text;
  }
  std::set<std::string> files() {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder / "mesh")) names.insert(entry.path().filename().string());
    return names;
  }
  fs::path folder;
};

using LiggghtsReads = GeometryCommand;

const std::string kLiggghts = VIELTO_LIGGGHTS;

}  // namespace

TEST_F(GeometryCommand, WritesOneFileAPaddleForASlice) {
  ASSERT_EQ(make(kMixer).status, 0);
  EXPECT_EQ(files(), (std::set<std::string>{"drum.stl", "shaft.stl", "stems.stl", "paddle_1.stl", "paddle_2.stl",
                                            "paddle_3.stl", "paddle_4.stl", "geometry.par", "rotor.vtp", "drum.vtp"}));
}

TEST_F(GeometryCommand, LeavesNoPaddleOfALargerMeshBehind) {
  ASSERT_EQ(make(kMixer).status, 0);
  ASSERT_EQ(make(kMixer + " --set slicePaddles=2").status, 0);
  EXPECT_EQ(files().count("paddle_2.stl"), 1u);
  EXPECT_EQ(files().count("paddle_3.stl"), 0u);
  ASSERT_EQ(make(kMixer + " --set slicePaddles=0").status, 0);
  EXPECT_EQ(files().count("paddle_2.stl"), 0u);
}

TEST_F(GeometryCommand, WritesTheMeshesOfEveryRig) {
  const std::map<std::string, std::set<std::string>> rigs = {{"shearbox", {"lower.stl", "upper.stl", "plate.stl"}},
                                                             {"repose", {"base.stl", "cylinder.stl"}},
                                                             {"drum", {"drum.stl", "ends.stl"}}};
  for (const auto& [rig, meshes] : rigs) {
    fs::remove_all(folder / "mesh");
    const Outcome outcome = make(kCases + "/" + rig + "/" + rig + ".par");
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    for (const std::string& mesh : meshes) EXPECT_EQ(files().count(mesh), 1u) << rig << " " << mesh;
    EXPECT_EQ(files().count("geometry.par"), 1u);
  }
}

TEST_F(GeometryCommand, RefusesBadInputWithOneLineAndLeavesNoFolder) {
  expect_refusal(make((folder / "none.par").string()), "none.par");
  expect_refusal(make(kMixer + " --set clearence=0.002"), "clearence");
  expect_refusal(make(kMixer + " --set clearance"), "NAME=VALUE");
  expect_refusal(make(kMixer + " --set clearance=wide"), "wide");
  expect_refusal(make(kMixer + " --set drumSegments=12"), "drumSegments");
  expect_refusal(run("env -u DISPLAY " + kVielto + " geometry " + kMixer + " --out " + (folder / "mesh").string() +
                     " --picture x.png"),
                 "display");
  EXPECT_FALSE(fs::exists(folder / "mesh"));
  EXPECT_EQ(run(kVielto + " geometry " + kMixer).status, 2);  // where to?
  EXPECT_EQ(run(kVielto + " geometry").status, 2);
}

TEST_F(GeometryCommand, ThatFailsKeepsTheMeshOfBefore) {
  ASSERT_EQ(make(kMixer).status, 0);
  const std::string before = content(folder / "mesh" / "geometry.par");
  EXPECT_EQ(make(kMixer + " --set slicePaddles=1").status, 2);
  EXPECT_EQ(content(folder / "mesh" / "geometry.par"), before);
}

TEST_F(GeometryCommand, RefusesARigOfKilometres) {
  for (const char* length : {"1e308", "1e5", "-101"}) {
    expect_refusal(make(kMixer + " --set slicePaddles=0 --set drumLength=" + length), "over 100 m");
    EXPECT_FALSE(fs::exists(folder / "mesh"));
  }
}

TEST_F(GeometryCommand, ChecksAGoodMesh) {
  ASSERT_EQ(make(kMixer).status, 0);
  const Outcome good = check("mesh/paddle_2.stl", "--closed");
  EXPECT_EQ(good.status, 0);
  EXPECT_NE(good.text.find("12 triangles, 0 open edges"), std::string::npos) << good.text;
  EXPECT_NE(good.text.find("2e-06 m3"), std::string::npos) << good.text;
  EXPECT_EQ(check("mesh/drum.stl").status, 0);
}

TEST_F(GeometryCommand, RefusesAMissingEmptyCorruptOrOpenMesh) {
  ASSERT_EQ(make(kMixer).status, 0);
  const std::string good = content(folder / "mesh" / "paddle_2.stl");
  write("empty.stl", "");
  write("text.stl", "this is no mesh\n");
  write("half.stl", good.substr(0, good.size() / 2));
  // found by fuzzing: 1.85e9 triangles were asked for
  write("mixed.stl", std::string("solid tetra\nfacet normal 0 0 -1\n outer loop\n") + '\x11' + "\nendsolid tetra\n");
  expect_refusal(check("mixed.stl"), "line 4: begins as text, but holds bytes that are no text");
  write("bare.stl", "solid nothing\nendsolid nothing\n");
  write("garbled.stl", std::regex_replace(good, std::regex("vertex [^ ]+"), "vertex x"));
  const auto first = good.find("facet normal");
  const auto second = good.find("facet normal", first + 1);
  write("open.stl", good.substr(0, first) + good.substr(second));
  expect_refusal(check("none.stl"), "cannot be read");
  expect_refusal(check("empty.stl"), "empty");
  expect_refusal(check("text.stl"), "no");
  expect_refusal(check("half.stl"), "endsolid");
  expect_refusal(check("bare.stl"), "no triangle");
  expect_refusal(check("garbled.stl"), "garbled.stl");
  expect_refusal(check("open.stl", "--closed"), "not closed: 3 open edges");
  EXPECT_EQ(check("open.stl").status, 0);
}

// What CAD programs write, and LIGGGHTS tells apart by the first five letters alone. A tetrahedron's volume is 1/6.
TEST_F(GeometryCommand, CheckTellsBinaryFilesThatBeginAsText) {
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const auto binary = [&](std::string header, float size = 1) {
    header.resize(80, ' ');
    header += std::string("\4\0\0\0", 4);
    for (const auto& face : faces) {
      header += std::string(12, '\0');  // the normal, which nobody reads
      for (const int i : face)
        for (const float x : corners[i]) {
          const float scaled = size * x;
          header.append(reinterpret_cast<const char*>(&scaled), 4);
        }
      header += std::string(2, '\0');
    }
    return header;
  };
  write("binary.stl", binary("made by CAD"));
  Outcome outcome = check("binary.stl", "--closed");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("volume 0.166667 m3 (normals outward)"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("extents 1 x 1 x 1 m, from 0 0 0"), std::string::npos) << outcome.text;
  EXPECT_EQ(outcome.text.find("note:"), std::string::npos) << outcome.text;
  write("mm.stl", binary("made by CAD", 300));
  outcome = check("mm.stl");
  EXPECT_NE(outcome.text.find("note: that is 300 m long; are its lengths in mm?"), std::string::npos) << outcome.text;
  write("solid.stl", binary("solid made by CAD"));
  outcome = check("solid.stl", "--closed");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.text.find("volume 0.166667 m3 (normals outward)"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("is binary, but begins with 'solid'"), std::string::npos) << outcome.text;
  ASSERT_EQ(make(kMixer).status, 0);
  std::string upper = content(folder / "mesh" / "paddle_2.stl");
  upper.replace(upper.find("solid"), 5, "Solid");
  write("upper.stl", upper);
  outcome = check("upper.stl");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.text.find("is text, but does not begin with 'solid'"), std::string::npos) << outcome.text;
}

TEST_F(LiggghtsReads, EveryMeshInAPeriodicBoxWithoutAComplaint) {
  for (const char* slice : {"2", "4", "6"}) {
    ASSERT_EQ(make(kMixer + " --set slicePaddles=" + slice).status, 0);
    std::string script =
        "atom_style granular\natom_modify map array\nboundary p f f\nnewton off\ncommunicate single vel yes\nunits si\n"
        "include mesh/geometry.par\nregion box block 0 ${sliceLength} -0.13 0.13 -0.13 0.15 units box\ncreate_box 1 "
        "box\n"
        "neighbor 0.001 bin\nneigh_modify delay 0\npair_style gran model hooke\npair_coeff * *\ntimestep 1e-4\n"
        "fix m1 all property/global youngsModulus peratomtype 5.e6\nfix m2 all property/global poissonsRatio "
        "peratomtype 0.45\n"
        "fix m3 all property/global coefficientRestitution peratomtypepair 1 0.3\n"
        "fix m4 all property/global coefficientFriction peratomtypepair 1 0.5\n"
        "fix m5 all property/global characteristicVelocity scalar 1.0\n";
    int meshes = 0;
    std::string names;
    for (const std::string& file : files()) {
      if (file.find(".stl") == std::string::npos) continue;
      const std::string name = file.substr(0, file.size() - 4);
      script += "fix " + name + " all mesh/surface/stress file mesh/" + file + " type 1 verbose yes\n";
      names += " " + name;
      ++meshes;
    }
    script += "fix wall all wall/gran model hooke mesh n_meshes " + std::to_string(meshes) + " meshes" + names + "\n";
    for (const std::string name : {"shaft", "stems", "paddle_1", "paddle_2"})
      script += "fix move_" + name + " all move/mesh mesh " + name + " rotate origin 0 0 0 axis 1 0 0 period 0.04\n";
    script +=
        "create_atoms 1 single 0.03 0 0.14 units box\nset group all density 1375 diameter 0.004\n"  // some grain there
                                                                                                    // must be
        "fix integrate all nve/sphere\nrun 400\n";
    write("load.in", script);
    const Outcome outcome = run("cd " + folder.string() + " && " + kLiggghts + " -in load.in -log none");
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    for (const char* complaint :
         {"ERROR", "aspect ratio", "duplicate", "overlap", "Not all nodes", "but only", "skewed"})
      EXPECT_EQ(outcome.text.find(complaint), std::string::npos) << outcome.text;
    std::size_t imported = 0;
    for (std::size_t at = 0; (at = outcome.text.find("parallelization of mesh", at)) != std::string::npos; ++at)
      ++imported;
    EXPECT_EQ(imported, static_cast<std::size_t>(meshes));
  }
}

TEST_F(LiggghtsReads, TheRunsOwnValuesAndStopsAtOneThatContradictsTheMesh) {
  ASSERT_EQ(make(kMixer + " --set clearance=0.002").status, 0);
  write("read.in", "include mesh/geometry.par\nprint \"read ${paddleAngles} with ${clearance}\"\n");
  const auto read = [this](const std::string& arguments) {
    return run("cd " + folder.string() + " && " + kLiggghts + " -in read.in -log none " + arguments);
  };
  EXPECT_NE(read("").text.find("read 0 90 180 270 with 0.002"), std::string::npos) << read("").text;
  EXPECT_EQ(read("-var clearance 2e-3 -var paddleHanding uniform").status, 0);
  for (const std::string contradiction : {"clearance 0.001", "paddleHanding mirrored", "paddleHanding crooked",
                                          "slicePaddles 0", "rig drum", "drumSegments 47"}) {
    const Outcome refused = read("-var " + contradiction);
    const std::string name = contradiction.substr(0, contradiction.find(' '));
    EXPECT_NE(refused.status, 0) << contradiction;
    // our program says it; the stock one, without the library, quotes the line that it does not know
    EXPECT_NE(refused.text.find(name + " is "), std::string::npos) << refused.text;
  }
}

// A grain settled on the flat lowest chord (47 chords put one there) presses with its weight, and its overlap is weight
// over stiffness: in mid-slice, on the diagonal, on the periodic seam and next to it. Were the seam counted twice, the
// overlap would be half. On a concave chord edge (48 chords) both chords carry it: k d 2 cos(half the angle between
// them) = weight.
TEST_F(LiggghtsReads, SettledGrainPressesWithItsWeightAtEverySeam) {
  const auto settle = [this](int chords, const std::string& x) {
    EXPECT_EQ(make(kMixer + " --set drumSegments=" + std::to_string(chords)).status, 0);
    std::ostringstream script;
    script << "atom_style granular\natom_modify map array\nboundary p f f\nnewton off\ncommunicate single vel "
              "yes\nunits si\n"
              "include mesh/geometry.par\nregion box block 0 ${sliceLength} -0.13 0.13 -0.13 0.15 units "
              "box\ncreate_box 1 box\n"
              "neighbor 0.001 bin\nneigh_modify delay 0\npair_style gran model hooke tangential no_history\npair_coeff "
              "* *\n"
              "timestep 2e-5\nfix m1 all property/global youngsModulus peratomtype 5.e6\n"
              "fix m2 all property/global poissonsRatio peratomtype 0.45\n"
              "fix m3 all property/global coefficientRestitution peratomtypepair 1 0.06\n"
              "fix m4 all property/global coefficientFriction peratomtypepair 1 0\n"
              "fix m5 all property/global characteristicVelocity scalar 1.0\n"
              "fix drum all mesh/surface/stress file mesh/drum.stl type 1\n"
              "fix wall all wall/gran model hooke tangential no_history mesh n_meshes 1 meshes drum\n"
              "create_atoms 1 single "
           << x << " 0 " << -0.125 * std::cos(chords % 2 ? 3.14159265358979 / 94 : 0.0) + 0.00399
           << " units box\nset group all density 1375 diameter 0.008\nfix gravity all gravity 9.81 vector 0 0 -1\n"
              "fix integrate all nve/sphere\nvariable z equal z[1]\nvariable force equal f_drum[3]\nvariable m equal "
              "mass[1]\n"
              "run 20000\nprint \"SETTLED $(v_z) $(v_force) $(v_m)\"\n";
    write("settle.in", script.str());
    const Outcome outcome = run("cd " + folder.string() + " && " + kLiggghts + " -in settle.in -log none");
    std::smatch found;
    EXPECT_TRUE(std::regex_search(outcome.text, found, std::regex("SETTLED (\\S+) (\\S+) (\\S+)"))) << outcome.text;
    return std::array<double, 3>{std::stod(found[1]), std::stod(found[2]), std::stod(found[3]) * 9.81};
  };
  const double flat =
      -0.125 * std::cos(3.14159265358979 / 94) + 0.004;  // z of a grain that just touches the flat chord
  const auto reference = settle(47, "0.03");
  const double overlap = flat - reference[0];
  EXPECT_GT(overlap, 1e-7);
  EXPECT_NEAR(-reference[1] / reference[2], 1, 1e-4);
  for (const char* x : {"0.0695454545454545", "0", "1e-6", "0.139089"}) {
    const auto settled = settle(47, x);
    EXPECT_NEAR(-settled[1] / settled[2], 1, 1e-4) << x;
    EXPECT_NEAR((flat - settled[0]) / overlap, 1, 1e-3) << x;
  }
  const double half = 3.14159265358979 / 96;
  const auto edge = settle(48, "0.03");
  EXPECT_NEAR(-edge[1] / edge[2], 1, 1e-4);
  // distance of the centre from both chords is (0.125 + z) cos(half)
  EXPECT_NEAR((0.004 - (0.125 + edge[0]) * std::cos(half)) / overlap, 1 / (2 * std::cos(half)), 1e-3);
}

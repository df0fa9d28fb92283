// SPDX-License-Identifier: GPL-2.0-or-later
// A machine of a user's own from STL files to its power: the paddle mixer's own meshes give the paddle mixer's torque;
// a ribbon mixer from formulas keeps energy and torque; ranks, a break, the diagnosis, refusals.
#include <nlohmann/json.hpp>

#include "core/sha256.h"
#include "machine_shapes.h"
#include "rig_runner.h"

using namespace vielto_test;
using machine_shapes::RibbonMixer;

namespace {

// Grains of 18 mm as soft as the coarse mixer's (mixer_runner.h).
const std::string coarse =
    "-var grainDiameter 0.018 -var youngsModulus 2e5 -var wall_youngsModulus 2e5 -var speed 1.58 -var maxOverlap 0.5 "
    "-var maxTorque 0 ";

class Machine : public testing::Test {
 protected:
  Machine() : rig("machine") {}

  // It ends two and a half grains before the drum's ends: nearer, it would press grain against them until it jams.
  std::string ribbon() {
    RibbonMixer mixer;
    mixer.r0 = 0.06, mixer.start = 0.045, mixer.pitch = 0.064;
    mixer.write_to(own);
    return "-var parts '" + (own / "machine.toml").string() + "' ";
  }
  nlohmann::json posted(const std::string& run) {
    const Outcome done = rig.vielto("post " + run + " --json");
    EXPECT_EQ(done.status, 0) << done.text;
    return nlohmann::json::parse(rig.read(run + "/post/power.json"));
  }
  std::string header(const std::string& run, const std::string& key) {
    std::istringstream in(rig.read(run + "/torque.csv"));
    for (std::string line; std::getline(in, line);)
      if (line.rfind("# " + key + "=", 0) == 0) return line.substr(key.size() + 3);
    ADD_FAILURE() << run << " has no line # " << key << "=";
    return "";
  }

  Rig rig;
  const std::filesystem::path own = rig.folder / "mein Rührer";
};

}  // namespace

/* Four paddles in a short drum with end walls: the meshes that in.mixer runs with, given to in.machine as STL in mm,
   with the same mass. Grain is rained in there and placed here, so that only the steady torque is the same. The mean of
   some turns is known to its u; that of a run of few coarse grains differs from seed to seed by no more
   (cases/mixer/reference.csv), so that two runs differ by less than three times the u of their difference. */
TEST_F(Machine, PaddleMixerAsStlGivesThePaddleMixersTorque) {
  Rig mixer("mixer");
  const std::string lengths = "drumLength 0.22 paddleCount 4 slicePaddles 0 drumVolume 0.01337";
  std::istringstream words(lengths);
  std::string settings, options;
  for (std::string name, value; words >> name >> value;) {
    settings += " --set " + name + "=" + value;
    options += "-var " + name + " " + value + " ";
  }
  mixer.must("its_own", coarse, options + "-var fill 0.15 -var settleTime 0.35 -var turns 14 ");
  const Outcome evaluated = mixer.vielto("post its_own");
  ASSERT_EQ(evaluated.status, 0) << evaluated.text;
  const auto expected = nlohmann::json::parse(mixer.read("its_own/post/power.json"));

  const std::filesystem::path stl = rig.folder / "stl";
  const Outcome meshed =
      rig.vielto("geometry '" VIELTO_SOURCE_DIR "/cases/mixer/mixer.par' --out '" + stl.string() + "'" + settings);
  ASSERT_EQ(meshed.status, 0) << meshed.text;
  machine_shapes::write(stl / "mixer.toml",
                        "unit = \"m\"\nup = [0, 0, 1]\n[axis]\norigin = [0, 0, 0]\ndirection = [1, 0, 0]\n"
                        "[[part]]\nname = \"shell\"\nfile = \"drum.stl\"\nmotion = \"stands\"\nopen = true\n"
                        "[[part]]\nname = \"blades\"\nfile = \"paddle_1.stl\"\nmotion = \"turns\"\n"
                        "[[part]]\nname = \"arms\"\nfile = \"stems.stl\"\nmotion = \"turns\"\n"
                        "[[part]]\nname = \"axle\"\nfile = \"shaft.stl\"\nmotion = \"turns\"\nopen = true\n"
                        "through = true\n");
  rig.must("as_stl", coarse,
           fmt::format("-var parts '{}' -var mass {:.9g} -var powerLever 0.114 -var turns 14 ",
                       (stl / "mixer.toml").string(), 0.15 * 0.01337 * 825));
  const auto told = posted("as_stl");
  const auto of = [](const nlohmann::json& power, const char* key) { return power[key].get<double>(); };
  const double difference = of(told, "torque_Nm") - of(expected, "torque_Nm");
  const double u = std::hypot(of(told, "torque_u_Nm"), of(expected, "torque_u_Nm"));
  EXPECT_LT(std::fabs(difference), 3 * u) << of(told, "torque_Nm") << " and " << of(expected, "torque_Nm");
  // the test means something only if the torque is known that well: to 5 %
  EXPECT_LT(u, 0.05 * of(expected, "torque_Nm"));
  EXPECT_NEAR(of(told, "N_P") / of(expected, "N_P"), of(told, "power_W") / of(expected, "power_W"), 1e-9);
  EXPECT_TRUE(told["thesis_power_W"].is_null());  // the published equation is of another machine
  // the same mesh: the volume up to the rim is the drum's, without that of its 48 chords less than 1e-3
  EXPECT_NEAR(std::stod(header("as_stl", "vessel_volume")), 0.01337, 3e-3 * 0.01337);
  EXPECT_NEAR(std::stod(header("as_stl", "fill")), 0.15, 3e-3 * 0.15);
}

// Runs of one fill may share a bed, which is mixed as if it had been filled for the run.
TEST_F(Machine, TakesTheBedOfAnotherRun) {
  const std::string options = ribbon() + coarse + "-var fill 0.2 -var turns 0.2 ";
  rig.must("first", options);
  const std::string bed = fmt::format("-var bed '{}' ", (rig.folder / "first").string());
  rig.must("again", options, bed);
  EXPECT_EQ(rig.read("first/torque.csv"), rig.read("again/torque.csv"));
  rig.must("slower", options, bed + "-var speed 0.85 ");
  EXPECT_EQ(header("slower", "mass_kg"), header("first", "mass_kg"));
  EXPECT_NE(rig.rig("other", options, bed + "-var seed 2 ").text.find("it was started with seed 1, not 2"),
            std::string::npos);
}

/* Torque about the axis: rotor, drum and gravity leave nothing on the mean; work goes into what is lost and kept. Grain
   of mass m in a drum of radius R is lifted with a torque below m g R, and drum and rotor rub each other's grain with
   no more than that again times tan(phi): the weight is all that presses at one turn a second, where the drum's radius
   has a centripetal acceleration of 0.4 g. */
TEST_F(Machine, RibbonTurnsGrainAndBalances) {
  rig.must("ribbon_run", coarse,
           ribbon() + "-var speed 1 -var fill 0.35 -var turns 5 -var energyBalance on -var powerLever 0.09 ");
  const auto told = posted("ribbon_run");
  const double torque = told["torque_Nm"], power = told["power_W"], mass = told["quality"]["mass_kg"];
  const double weight = mass * 9.81 * 0.1;
  EXPECT_GT(torque, 0);
  EXPECT_LT(torque, weight * 2);
  EXPECT_LT(std::fabs(told["quality"]["energy_closure_relative"].get<double>()), 0.01);
  EXPECT_LT(std::fabs(told["quality"]["torque_balance_Nm"].get<double>()),
            3 * told["quality"]["torque_balance_u_Nm"].get<double>());
  EXPECT_EQ(told["quality"]["lost_grains"], 0);
  // P = 2 pi n T; N_P = P/(rho n^3 L^5) with the lever stated; the parts that turn make the rotor
  EXPECT_NEAR(power, 2 * pi * torque, 1e-6 * power);
  EXPECT_NEAR(told["N_P"], power / (825 * std::pow(0.09, 5)), 1e-6 * told["N_P"].get<double>());
  double rotor = 0;
  for (const char* part : {"helix", "axle"}) rotor += told["parts"][part]["torque_Nm"].get<double>();
  EXPECT_NEAR(rotor, torque, 1e-9 * torque);
  EXPECT_EQ(header("ribbon_run", "fill"), "0.35");  // as a measurement states it, not as whole grains make it
  EXPECT_EQ(header("ribbon_run", "turning"), "helix axle");
  EXPECT_EQ(header("ribbon_run", "standing"), "drum");
  // the mass is that of the fill: 0.35 of the closed form's volume, to half a grain
  EXPECT_NEAR(mass, 0.35 * RibbonMixer().drum_volume() * 825, 2e-3 * mass);
  const std::string rows = rig.read("ribbon_run/post/observations.csv");
  EXPECT_NE(rows.find(",machine,power,"), std::string::npos) << rows;
  EXPECT_NE(rows.find(",machine,torque_ripple,"), std::string::npos) << rows;

  // run.json tells how to make it again, and from which files
  const auto made = nlohmann::json::parse(rig.read("ribbon_run/run.json"));
  EXPECT_NE(made["command"].get<std::string>().find("-var parts '" + (own / "machine.toml").string() + "' "),
            std::string::npos);
  for (const char* file : {"machine.toml", "drum.stl", "helix.stl", "axle.stl"})
    EXPECT_EQ(made["hashes"].value((own / file).string(), ""), vielto::sha256_of_file((own / file).string())) << file;

  const Outcome report = rig.vielto("report ribbon_run --out page --no-plots 2>&1");
  EXPECT_EQ(report.status, 0) << report.text;
  const std::string page = rig.read("page/report.html");
  EXPECT_NE(page.find("of the helix"), std::string::npos);
  EXPECT_EQ(page.find("Published equation"), std::string::npos);
}

// The empty machine, with the idling model of a user's own.
TEST_F(Machine, EmptyMachineIdles) {
  const std::string idle = "-var idleTorque 0.5 -var idleNoise 0.02 ";
  rig.must("idle", coarse, ribbon() + "-var fill 0 -var turns 5 " + idle);
  EXPECT_EQ(header("idle", "mass_kg"), "0");
  rig.must("loaded", coarse, ribbon() + "-var fill 0.3 -var turns 4 " + idle);
  const Outcome done = rig.vielto("post loaded --idle idle");
  ASSERT_EQ(done.status, 0) << done.text;
  const auto told = nlohmann::json::parse(rig.read("loaded/post/power.json"));
  EXPECT_NEAR(told["power_idle_W"], 2 * pi * 1.58 * 0.5, 0.01 * 2 * pi * 1.58 * 0.5);
  EXPECT_NEAR(told["power_loaded_W"].get<double>() - told["power_idle_W"].get<double>(), told["power_W"],
              0.02 * told["power_W"].get<double>());
  EXPECT_NE(rig.read("loaded/post/observations.csv").find(",machine,power_loaded,"), std::string::npos);
}

// Two ranks start from the same grains at the same places, and a run broken off goes on to the same rows.
TEST_F(Machine, RanksAndABreakLeaveTheRun) {
  const std::string options = ribbon() + "-var fill 0.3 -var settleTime 0.02 -var turns 1 -var restartTurns 0.1 ";
  rig.must("one", coarse, options);
  rig.must("two", coarse, options, 2);
  EXPECT_EQ(header("one", "mass_kg"), header("two", "mass_kg"));
  // grain that has hardly fallen has met few others: the same to what sums in another order leave
  const Table one = rig.csv("one/torque.csv"), two = rig.csv("two/torque.csv");
  ASSERT_EQ(one.rows.size(), two.rows.size());
  EXPECT_EQ(one.at(0, "contacts"), two.at(0, "contacts"));
  EXPECT_NEAR(one.at(0, "kinetic_J"), two.at(0, "kinetic_J"), 1e-6 * one.at(0, "kinetic_J"));

  const std::string wait =
      "step() { ls $d/restart 2>/dev/null | sort -n | head -1 | cut -d. -f1; }; "
      "last() { tail -n 1 $d/torque.csv | cut -d, -f1; }; "
      "until [ -n \"$(step)\" ] && [ $(last) -gt $(step) ]; do kill -0 $p || exit 99; sleep 0.02; done; ";
  const Outcome broken =
      rig.shell(fmt::format("d='{}.partial'; {} & p=$!; {} kill -KILL $p; wait $p", (rig.folder / "taken_up").string(),
                            rig.command_of("taken_up", coarse, options), wait));
  ASSERT_EQ(broken.status, 128 + 9) << broken.text;
  rig.must("taken_up", coarse, options + "-var resume yes ");
  const Table again = rig.csv("taken_up/torque.csv");
  ASSERT_EQ(again.rows.size(), one.rows.size());
  for (std::size_t k = 0; k < one.rows.size(); ++k) EXPECT_EQ(again.at(k, "step"), one.at(k, "step"));
  EXPECT_EQ(again.at(again.rows.size() - 1, "grains"), one.at(0, "grains"));
}

// Effects of grain, wall and measurement that name the mixer act here too, and the plan is a campaign's study.
TEST_F(Machine, IsPlannedForALibrary) {
  std::filesystem::create_directories(rig.folder / "lib/own");
  const std::string source = VIELTO_SOURCE_DIR;
  std::filesystem::copy(source + "/libraries/effects", rig.folder / "lib/effects");
  std::filesystem::copy(source + "/libraries/diagnosis.toml", rig.folder / "lib/diagnosis.toml");
  rig.write("lib/own/plan.toml",
            "seeds = 6\n[[rig]]\nname = \"machine\"\nsettings = {parts = \"plough/machine.toml\", grainDiameter = "
            "\"0.012\"}\nconditions = [{speed = 1, fill = 0.3}]\n"
            "[[rig.effect]]\nname = \"wall_friction\"\nstrengths = [4]\nat = [1]\n");
  const Outcome done = rig.vielto(fmt::format("gap plan lib/own/plan.toml --root '{}' --out study.csv 2>&1", source));
  ASSERT_EQ(done.status, 0) << done.text;
  const std::string study = rig.read("study.csv");
  EXPECT_NE(study.find("machine,6,"), std::string::npos) << study;
  EXPECT_NE(study.find("plough/machine.toml"), std::string::npos) << study;
  EXPECT_NE(study.find("wall_friction4"), std::string::npos) << study;
}

TEST_F(Machine, RefusesARunThatCannotBe) {
  // what is refused before anything was recorded leaves no folder
  const auto refused = [&](const std::string& options, const std::string& why) {
    const Outcome done = rig.rig("bad", coarse, options);
    EXPECT_NE(done.status, 0) << options;
    EXPECT_NE(done.text.find(why), std::string::npos) << options << "\n" << done.text;
    EXPECT_FALSE(std::filesystem::exists(rig.folder / "bad"));
    EXPECT_FALSE(std::filesystem::exists(rig.folder / "bad.partial")) << options;
  };
  const std::string parts = ribbon();
  refused(parts + "-var mass 9 ", "mass that cannot be placed: asked for ");
  refused(parts + "-var mass 1e-4 ", "is less than half a grain");
  refused(parts + "-var fill 0.95 ", "fill is 0.95");
  refused(parts + "-var vesselVolume 0.5 ", "'vesselVolume' 0.5: the meshes hold ");
  refused(parts + "-var paddleCount 4 ", "paddleCount");
  refused("-var parts nowhere.toml ", "nowhere.toml");
  machine_shapes::write(own / "helix.stl", "solid cut\nfacet normal 0 0 1\n");
  refused(parts, "helix.stl, line 2: ends before 'endsolid': the file is cut off");
}

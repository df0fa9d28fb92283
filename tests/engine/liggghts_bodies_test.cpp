// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies that are more than two free spheres, and cohesion, through `liggghts`: frozen grains, clumps of fix
// multisphere, and stock cohesion models on grains, meshes and primitive walls, whose force is added to ViElTo's and
// never enters its caps.
#include "contact_reference.h"

namespace {

using namespace vielto_test;

const double R = 0.005;

double restitution(double zeta) { return std::exp(-pi * zeta / std::sqrt(1 - zeta * zeta)); }

/* A frozen grain is a body of infinite mass but of its own radius: m_eff = m_1, k_n = 4 E R_1R_2/(R_1 + R_2) for one E.
   Tolerance of ln e as for head-on impacts: 2 zeta x + pi zeta^2 x/2, x = omega_0 dt. */
TEST(FrozenGrain, IsAWallOfItsOwnRadius) {
  const double R2 = 0.008, v = 0.3, zeta = 0.3, kn = 4 * 1e6 * R * R2 / (R + R2);
  const Sphere moving{1, R, 1375, {0, 0, R + R2 + 1e-7}, {0, 0, -v}, Vec::Zero()},
      frozen{1, R2, 1375, Vec::Zero(), Vec::Zero(), Vec::Zero()};
  const double omega = std::sqrt(4 * kn / moving.mass()), x = pi / 400, dt = x / omega;
  Material m;
  m.normalDamping = 2 * zeta;  // c_n = 4
  Liggghts run;
  run.script =
      head(run, {moving, frozen}, {m}, 0.05) +
      fmt::format(
          "group still id 2\ngroup free id 1\nfix freeze still freeze\ntimestep {:.17g}\nfix move free nve/sphere\n",
          dt) +
      dump_grains("states", 1) + "run 500\n";
  run.must();
  const std::vector<Table> frames = run.dump("states");
  double overlap = 0;
  for (const Table& f : frames) overlap = std::max(overlap, R + R2 - f.x(0)[2]);
  const double root = std::sqrt(1 - zeta * zeta);
  EXPECT_NEAR(std::log(frames.back().v(0)[2] / v), std::log(restitution(zeta)),
              2 * zeta * x + pi * zeta * zeta * x / 2);
  EXPECT_NEAR(overlap / (v / omega * std::exp(-zeta / root * std::acos(zeta))), 1, zeta * x + x * x);
  EXPECT_EQ(frames.back().x(1).norm(), 0);
}

/* A clump of two spheres side by side falls flat on a plane: two contacts, each with the mass M of the whole clump in
   its dashpot, so

     omega_0^2 = 2 c_n k_n/M,   zeta = 2 * 2 sqrt(k_n M) beta/(2 M omega_0) = sqrt(2) beta/sqrt(c_n)

   On its end it has one contact and zeta = beta/sqrt(c_n). With the mass of one sphere zeta would be less by sqrt(2).
 */
class Clump : public testing::TestWithParam<std::tuple<bool, const char*>> {};

TEST_P(Clump, HasItsWholeMassInTheDashpot) {
  const auto [flat, wall] = GetParam();
  const double beta = 0.5, v = 0.3, M = 0.001, kn = 4 * 1e6 * R * 2 / 3, contacts = flat ? 2 : 1;
  const double omega = std::sqrt(contacts * 4 * kn / M), zeta = std::sqrt(contacts) * beta / 2, x = pi / 400,
               dt = x / omega;
  Material m;
  m.normalDamping = beta;
  m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  Liggghts run;
  run.write("plate.stl", plate_stl(0.04));
  const double height = (flat ? R : 2 * R) + 1e-7;
  const std::string two =
      flat ? fmt::format("{} 0 0 {} {} 0 0 {}", -R, R, R, R) : fmt::format("0 0 {} {} 0 0 {} {}", -R, R, R, R);
  run.script = settings_head() +
               "region box block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box\ncreate_box 1 box\nneighbor 0.002 "
               "bin\nneigh_modify delay 0\n" +
               properties({m}) +
               fmt::format("pair_style gran {}\npair_coeff * *\ntimestep {:.17g}\n", vielto_models, dt);
  if (std::string(wall) == "mesh")
    run.script += fmt::format(
        "fix plate all mesh/surface file plate.stl type 1\nfix wall all wall/gran {} mesh n_meshes 1 meshes plate\n",
        vielto_models);
  else
    run.script += fmt::format("fix wall all wall/gran {} primitive type 1 zplane 0.0\n", vielto_models);
  run.script += fmt::format(
      "fix shape all particletemplate/multisphere 15485863 atom_type 1 density constant 1375 nspheres 2 ntry 100000 "
      "spheres {} "
      "mass {} inertia_tensor 3e-8 0 0 3e-8 0 3e-8 use_density type 1\n"
      "fix shapes all particledistribution/discrete 32452843 1 shape 1.0\n"
      "region start block -1e-9 1e-9 -1e-9 1e-9 {:.17g} {:.17g} units box volume_limit 1e-30\n"
      "fix clumps all multisphere\n"
      "fix drop all insert/pack seed 49979687 distributiontemplate shapes maxattempt 100 insert_every once "
      "overlapcheck no all_in no "
      "orientation constant 1 0 0 0 vel constant 0 0 {} region start particles_in_region 1\n",
      two, M, height, height + 1e-9, -v);
  run.script += dump_grains("states", 1) + "run 560\n";
  run.must();
  const std::vector<Table> frames = run.dump("states");
  ASSERT_EQ(frames.back().rows.size(), 2u);
  const Vec after = 0.5 * (frames.back().v(0) + frames.back().v(1));
  const double tolerance = 2 * zeta * x + pi * zeta * zeta * x / (2 * std::pow(1 - zeta * zeta, 1.5)) + x * x;
  EXPECT_NEAR(std::log(after[2] / v), std::log(restitution(zeta)), tolerance);
}

INSTANTIATE_TEST_SUITE_P(Falls, Clump, testing::Combine(testing::Bool(), testing::Values("mesh", "primitive")));

// Two clumps fly at each other end on: m_eff = M/2. As above.
TEST(ClumpPair, HasItsWholeMassInTheDashpot) {
  const double beta = 0.5, v = 0.4, M = 0.001, kn = 2 * 1e6 * R, zeta = beta / 2, x = pi / 400;
  const double dt = x / std::sqrt(4 * kn / (M / 2));
  Material m;
  m.normalDamping = beta;
  m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  Liggghts run;
  run.script = settings_head() +
               "region box block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box\ncreate_box 1 box\nneighbor 0.002 "
               "bin\nneigh_modify delay 0\n" +
               properties({m}) +
               fmt::format("pair_style gran {}\npair_coeff * *\ntimestep {:.17g}\n", vielto_models, dt) +
               fmt::format(
                   "fix shape all particletemplate/multisphere 15485863 atom_type 1 density constant 1375 nspheres 2 "
                   "ntry 100000 spheres "
                   "0 0 {} {} 0 0 {} {} mass {} inertia_tensor 3e-8 0 0 3e-8 0 3e-8 use_density type 1\n"
                   "fix shapes all particledistribution/discrete 32452843 1 shape 1.0\nfix clumps all multisphere\n",
                   -R, R, R, R, M);
  for (const int side : {-1, 1}) {
    const double low = side > 0 ? 2 * R + 5e-8 : -2 * R - 5e-8 - 1e-9;
    run.script += fmt::format(
        "region start{0} block -1e-9 1e-9 -1e-9 1e-9 {1:.17g} {2:.17g} units box volume_limit 1e-30\n"
        "fix drop{0} all insert/pack seed {3} distributiontemplate shapes maxattempt 100 insert_every once "
        "overlapcheck no all_in no "
        "orientation constant 1 0 0 0 vel constant 0 0 {4} region start{0} particles_in_region 1\n",
        side + 1, low, low + 1e-9, side > 0 ? 49979687 : 67867967, -side * v / 2);
  }
  run.script += dump_grains("states", 560) + "run 560\n";
  run.must();
  const Table last = run.dump("states").back();
  ASSERT_EQ(last.rows.size(), 4u);
  double up = 0;
  for (std::size_t i = 0; i < 4; i++) up += last.x(i)[2] > 0 ? last.v(i)[2] / 2 : -last.v(i)[2] / 2;
  EXPECT_NEAR(std::log(up / v), std::log(restitution(zeta)),
              2 * zeta * x + pi * zeta * zeta * x / (2 * std::pow(1 - zeta * zeta, 1.5)) + x * x);
}

// ---- cohesion ----

enum class Partner { sphere, mesh, primitive };

const char* partner_name(Partner p) { return p == Partner::sphere ? "sphere" : p == Partner::mesh ? "mesh" : "plane"; }

struct Cohesion {
  const char* name;
  const char* properties;
};

const char* const capillary =
    "fix c1 all property/global minSeparationDistanceRatio scalar 1.01\nfix c2 all property/global "
    "maxSeparationDistanceRatio scalar 1.1\n"
    "fix c3 all property/global surfaceLiquidContentInitial scalar 5\nfix c4 all property/global surfaceTension scalar "
    "0.072\n"
    "fix c5 all property/global fluidViscosity scalar 0.05\nfix c6 all property/global contactAngle peratomtype 0.5\n";

/* Grains moved along a given path (no integration): overlap, then apart, with slip and spin. Forces and torques of
   every 10th step. `stock`: LIGGGHTS' own hooke/stiffness without history instead of ViElTo. */
std::vector<Table> forces_on_a_path(Partner partner, const Cohesion* cohesion, bool stock, double friction) {
  Material m;
  m.frictionAngle = friction;
  m.tangentialDamping = 0;
  const double u = 5e-5;
  std::vector<Sphere> spheres = {{1, R, 1375, {0, 0, R - u}, {0.2, 0.1, 0.05}, {10, 20, 30}}};
  if (partner == Partner::sphere) {
    spheres[0].x = {0, 0, 2 * R - u};
    spheres.push_back({1, R, 1375, Vec::Zero(), Vec::Zero(), {-5, 8, 3}});
  }
  Liggghts run;
  run.write("plate.stl", plate_stl(0.04));
  const std::string models =
      fmt::format("{}{}", stock ? "model hooke/stiffness tangential no_history" : "model vielto tangential vielto",
                  cohesion ? fmt::format(" cohesion {}", cohesion->name) : "") +
      (stock ? "" : " rolling_friction vielto");
  run.script = settings_head() + grains(run, spheres, 0.1) + "neighbor 0.002 bin\nneigh_modify delay 0\n" +
               (cohesion ? cohesion->properties : "");
  run.script +=
      stock
          ? "fix k1 all property/global kn peratomtypepair 1 2e4\nfix k2 all property/global kt peratomtypepair 1 1e4\n"
            "fix k3 all property/global gamman peratomtypepair 1 0\nfix k4 all property/global gammat peratomtypepair "
            "1 0\n"
            "fix k5 all property/global coefficientFriction peratomtypepair 1 0.3\n"
          : properties({m});
  run.script += fmt::format("pair_style gran {}\npair_coeff * *\ntimestep 1e-6\n", models);
  if (partner == Partner::mesh)
    run.script += fmt::format(
        "fix plate all mesh/surface file plate.stl type 1\nfix wall all wall/gran {} mesh n_meshes 1 meshes plate\n",
        models);
  if (partner == Partner::primitive)
    run.script += fmt::format("fix wall all wall/gran {} primitive type 1 zplane 0.0\n", models);
  // 1500 steps of 5e-8 m: parts after 1000, then a gap up to 2.5e-5 m; stock easo/capillary/viscous takes the velocity
  // of a grain for a wall's once its bridge is apart, and reads outside all arrays for a primitive wall: there the path
  // ends before
  const bool apart = partner == Partner::sphere || !cohesion || std::string(cohesion->name) != "easo/capillary/viscous";
  run.script += "group one id 1\nfix path one move linear 0.2 0.1 0.05 units box\n" + dump_grains("states", 10) +
                fmt::format("run {}\n", apart ? 1500 : 980);
  run.must();
  return run.dump("states");
}

class CohesionModel : public testing::TestWithParam<std::tuple<Cohesion, Partner>> {};

/* Cohesion is what the stock model alone adds: (ViElTo with cohesion) - (ViElTo) = (stock with cohesion) - (stock),
   force and torque, step by step on one path: overlapping and, for a liquid bridge, apart. ViElTo slides on this path,
   so a cap that saw cohesion would show. Tolerance: round-off of forces up to 4 N. */
TEST_P(CohesionModel, AddsTheStockForceAndLeavesTheCapsAlone) {
  const auto& [cohesion, partner] = GetParam();
  const std::vector<Table> with = forces_on_a_path(partner, &cohesion, false, 5),
                           without = forces_on_a_path(partner, nullptr, false, 5),
                           stockWith = forces_on_a_path(partner, &cohesion, true, 5),
                           stock = forces_on_a_path(partner, nullptr, true, 5);
  ASSERT_EQ(with.size(), stockWith.size());
  double greatest = 0;
  for (std::size_t k = 0; k < with.size(); k++)
    for (std::size_t i = 0; i < with[k].rows.size(); i++) {
      const Vec added = with[k].f(i) - without[k].f(i), turned = with[k].torque(i) - without[k].torque(i);
      EXPECT_LT((added - (stockWith[k].f(i) - stock[k].f(i))).norm(), 1e-13) << "step " << with[k].step;
      EXPECT_LT((turned - (stockWith[k].torque(i) - stock[k].torque(i))).norm(), 1e-15) << "step " << with[k].step;
      greatest = std::max(greatest, added.norm());
    }
  EXPECT_GT(greatest, 1e-4);
}

std::string cohesion_name(const testing::TestParamInfo<std::tuple<Cohesion, Partner>>& tested) {
  std::string name = std::get<0>(tested.param).name;
  std::replace(name.begin(), name.end(), '/', '_');
  return name + "_" + partner_name(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(
    Stock, CohesionModel,
    testing::Combine(
        testing::Values(Cohesion{"sjkr", "fix c all property/global cohesionEnergyDensity peratomtypepair 1 1e5\n"},
                        Cohesion{"sjkr2", "fix c all property/global cohesionEnergyDensity peratomtypepair 1 1e5\n"},
                        Cohesion{"easo/capillary/viscous", capillary},
                        Cohesion{"washino/capillary/viscous", capillary}),
        testing::Values(Partner::sphere, Partner::mesh, Partner::primitive)),
    cohesion_name);

/* SJKR by its formula: F = k A, for equal spheres at distance d A = pi/4 (4 R^2 - d^2), on a wall pi (R^2 - d^2). The
   friction that goes with it is tan(phi') times spring plus dashpot, though cohesion cancels part of them. */
TEST(Sjkr, ForceIsEnergyDensityTimesContactArea) {
  const Cohesion sjkr = {"sjkr", "fix c all property/global cohesionEnergyDensity peratomtypepair 1 1e5\n"};
  for (const Partner partner : {Partner::sphere, Partner::mesh, Partner::primitive}) {
    const bool wall = partner != Partner::sphere;
    const std::vector<Table> frames = forces_on_a_path(partner, &sjkr, false, 5);
    const double kn = wall ? 4e6 * R * 2 / 3 : 2e6 * R, mass = Sphere{1, R}.mass();
    const double gamma = 2 * std::sqrt(kn * (wall ? mass : mass / 2)) * 0.3;
    int compared = 0;
    for (const Table& f : frames) {
      if (f.step == 0) continue;
      const Vec apart = wall ? Vec(0, 0, f.x(0)[2]) : Vec(f.x(0) - f.x(1));
      const double d = apart.norm(), overlap = (wall ? R : 2 * R) - d;
      if (overlap <= 0) continue;
      const Vec n = apart / d, v = f.v(0) - (wall ? Vec(Vec::Zero()) : f.v(1));
      const double pushing = 4 * kn * overlap - gamma * v.dot(n),
                   area = wall ? pi * (R * R - d * d) : pi / 4 * (4 * R * R - d * d);
      const Vec F = f.f(0);
      EXPECT_NEAR(F.dot(n), pushing - 1e5 * area, 1e-11) << f.step;
      if (f.step < 200) continue;  // slides from the first steps on
      EXPECT_NEAR((F - F.dot(n) * n).norm(), std::max(pushing, 0.0) * std::tan(5 * pi / 180), 1e-12) << f.step;
      compared++;
    }
    EXPECT_GT(compared, 50);
  }
}

/* Adhesion by its formula, F = 2/3 sigma_t d_1 d_2 (porosity 0.4), on the same path: constant while the surfaces
   overlap, nothing apart; the friction is tan(phi') times spring plus dashpot. */
TEST(Adhesion, IsAConstantPullWhileTheyTouch) {
  const Cohesion adhesion = {"adhesion", "fix c all property/global adhesionStrength scalar 500\n"};
  const double pull = 2.0 / 3 * 500 * (2 * R) * (2 * R);
  for (const Partner partner : {Partner::sphere, Partner::mesh, Partner::primitive}) {
    const std::vector<Table> with = forces_on_a_path(partner, &adhesion, false, 5),
                             without = forces_on_a_path(partner, nullptr, false, 5);
    ASSERT_EQ(with.size(), without.size());
    int touching = 0, apart = 0;
    for (std::size_t k = 1; k < with.size(); k++) {
      const bool wall = partner != Partner::sphere;
      const Vec away = wall ? Vec(0, 0, with[k].x(0)[2]) : Vec(with[k].x(0) - with[k].x(1));
      const double gap = away.norm() - (wall ? R : 2 * R);
      if (std::fabs(gap) < 1e-12) continue;  // the step that parts them: round-off decides
      const bool touch = gap < 0;
      const Vec expected = touch ? Vec(-pull * away / away.norm()) : Vec(Vec::Zero());
      EXPECT_LT((with[k].f(0) - without[k].f(0) - expected).norm(), 1e-12) << with[k].step;
      EXPECT_LT((with[k].torque(0) - without[k].torque(0)).norm(), 1e-15) << with[k].step;
      touching += touch, apart += !touch;
    }
    EXPECT_GT(touching, 50);
    EXPECT_GT(apart, 20);
  }
}

/* Two grains let go at an overlap where the pull wins stay together; as sjkr2 has it, whatever its energy density below
   8 E/(2 pi), they part. */
TEST(Adhesion, HoldsGrainsTogetherWhereSjkrDoesNot) {
  const auto distance = [](const std::string& models, const std::string& property) {
    Material m;
    Liggghts run;
    // pulled apart at 2 mm/s: half of m_eff v^2 is 1e-3 of what the pull of 33 mN stores over 1 um
    const std::vector<Sphere> spheres = {{1, R, 1375, {0, 0, 0}, Vec::Zero(), Vec::Zero()},
                                         {1, R, 1375, {0, 0, 2 * R - 1e-6}, {0, 0, 2e-3}, Vec::Zero()}};
    run.script = settings_head() + grains(run, spheres, 0.1) + "neighbor 0.002 bin\nneigh_modify delay 0\n" + property +
                 properties({m}) + fmt::format("pair_style gran model vielto tangential vielto {}\n", models) +
                 "pair_coeff * *\ntimestep 1e-6\nfix integrate all nve/sphere\n" + dump_grains("states", 5000) +
                 "run 20000\n";
    run.must();
    const Table last = run.dump("states").back();
    return (last.x(0) - last.x(1)).norm();
  };
  EXPECT_LT(
      distance("cohesion adhesion rolling_friction vielto", "fix c all property/global adhesionStrength scalar 500\n"),
      2 * R);
  EXPECT_GT(distance("cohesion sjkr2 rolling_friction vielto",
                     "fix c all property/global cohesionEnergyDensity peratomtypepair 1 1e5\n"),
            2 * R + 1e-5);
}

}  // namespace

// SPDX-License-Identifier: GPL-2.0-or-later
/* Clumps (fix multisphere) under ViElTo, through the real command line.

   What LIGGGHTS hands over: each sphere of a clump carries the mass of the whole body, so that the effective mass of a
   contact is that of the bodies; k_n, k_s and the levers take the sphere's radius; v and omega are those of the body.
   A body that lies on n spheres of equal radius at once has n springs and n dashpots:

     m z'' + n 2 sqrt(k_n m) beta_n z' + n c_n k_n z = 0,   zeta = sqrt(n) beta_n/sqrt(c_n),
     e = exp(-pi zeta/sqrt(1 - zeta^2)),   omega_0^2 = n c_n k_n/m */
#include <cstdio>
#include <cstring>

#include "liggghts_runner.h"

namespace {

using namespace vielto_test;

// Three spheres of one radius on the x axis, the middle one at the centre of mass.
const double R = 0.003, reach = 0.004, mass = 2e-4, about_axis = 8e-10, across = 3e-9;

struct Body {
  std::string spheres = fmt::format("{0} 0 0 {1}\n0 0 0 {1}\n-{0} 0 0 {1}\n", reach, R);
  int count = 3;
  double m = mass, axial = about_axis, transverse = across;
};

// One body at x, not turned unless `turn` (a quaternion) says so.
std::string insert(const Liggghts& run, const Body& b, const std::string& name, const Vec& x, const Vec& v,
                   const Vec& w, const std::string& turn, int number) {
  run.write(name + ".clump", b.spheres);
  const char* seeds[] = {"15485863 32452843 49979687", "67867967 86028121 104395301"};
  std::istringstream words(seeds[number - 1]);
  std::string s1, s2, s3;
  words >> s1 >> s2 >> s3;
  return fmt::format(
      "fix {0} all particletemplate/multisphere {1} atom_type 1 density constant 1375 nspheres {2} ntry 100000 spheres "
      "file "
      "{0}.clump scale 1 mass {3:.17g} inertia_tensor {4:.17g} 0 0 {5:.17g} 0 {5:.17g} use_density type {6}\n"
      "fix one_{0} all particledistribution/discrete {7} 1 {0} 1\n"
      "region at_{0} sphere {8:.17g} {9:.17g} {10:.17g} 1e-6 units box volume_limit 1e-20\n"
      "fix put_{0} all insert/pack seed {11} distributiontemplate one_{0} maxattempt 10 insert_every once overlapcheck "
      "no "
      "all_in no orientation {12} vel constant {13:.17g} {14:.17g} {15:.17g} omega constant {16:.17g} {17:.17g} "
      "{18:.17g} "
      "region at_{0} particles_in_region 1\n",
      name, s1, b.count, b.m, b.axial, b.transverse, number, s2, x[0], x[1], x[2], s3, turn, v[0], v[1], v[2], w[0],
      w[1], w[2]);
}

std::string box(const Material& m, int types = 2) {
  return settings_head() +
         fmt::format(
             "region box block -0.1 0.1 -0.1 0.1 -0.1 0.1 units box\ncreate_box {} box\nneighbor 0.001 bin\n"
             "neigh_modify delay 0\n",
             types) +
         properties(std::vector<Material>(static_cast<std::size_t>(types), m)) +
         fmt::format("pair_style gran {}\npair_coeff * *\nfix body all multisphere\n", vielto_models);
}

std::string plate(const Liggghts& run) {
  run.write("plate.stl", plate_stl(0.05));
  return fmt::format(
      "fix plate all mesh/surface file plate.stl type 2\n"
      "fix wall all wall/gran {} mesh n_meshes 1 meshes plate\n",
      vielto_models);
}

// Direction of the three spheres' axis.
Vec axis(const Table& t) { return (t.x(0) - t.x(2)).normalized(); }
Vec spin_momentum(const Table& t) {
  const Vec u = axis(t), w = t.w(0);
  return across * w + (about_axis - across) * w.dot(u) * u;
}
double energy(const Table& t) { return 0.5 * mass * t.v(1).squaredNorm() + 0.5 * t.w(0).dot(spin_momentum(t)); }

const double kn = 2 * (2 * 1e6 * R) * (2 * 1e6 * 2 * R) / (2 * 1e6 * 3 * R);  // on a wall, R_2 = 2 R, equal materials

/* Free of forces: a clump's own spheres overlap and do not feel each other. The integrator turns the body with the
   angular momentum itself, which leaves round-off; omega, and with it the energy, follows the turn to second order. */
TEST(Clump, InFlightKeepsMomentumAngularMomentumAndEnergy) {
  Liggghts run;
  const Vec v(0.1, 0.2, -0.3), w(200, 50, -80);
  const double dt = 1e-5;
  run.script = box(Material()) + insert(run, Body(), "clump", Vec::Zero(), v, w, "template", 1) +
               fmt::format("timestep {}\n{}run 2000\n", dt, dump_grains("states", 100));
  run.must();
  const std::vector<Table> frames = run.dump("states");
  const Table &first = frames[1], &last = frames.back();
  ASSERT_EQ(first.rows.size(), 3u);
  const Vec L = spin_momentum(first);
  EXPECT_GT((axis(first) - axis(last)).norm(), 0.1) << "it has turned";
  for (std::size_t k = 1; k < frames.size(); k++) {
    for (std::size_t s = 0; s < 3; s++) EXPECT_EQ(frames[k].f(s).norm(), 0);
    EXPECT_LT((frames[k].v(1) - v).norm(), 1e-12);
    EXPECT_LT((spin_momentum(frames[k]) - L).norm(), 1e-10 * L.norm());
    EXPECT_NEAR(energy(frames[k]), energy(first), w.squaredNorm() * dt * dt * energy(first));
  }
}

// Flat on three spheres: restitution with the mass of the body in every contact. Tolerance as in
// liggghts_normal_impact_test.
TEST(Clump, LandsFlatWithTheBodysMassInEachContact) {
  Material m;
  m.normalDamping = 0.3;
  const double n = 3, x = pi / 400, omega = std::sqrt(n * 4 * kn / mass), dt = x / omega, v0 = 0.4;
  const double zeta = std::sqrt(n) * m.normalDamping / 2;
  Liggghts run;
  run.script = box(m) + plate(run) +
               insert(run, Body(), "clump", {0, 0, R + 2e-5}, {0, 0, -v0}, Vec::Zero(), "template", 1) +
               fmt::format("timestep {:.17g}\n{}run {}\n", dt, dump_grains("states", 100), 1000);
  run.must();
  const Table end = run.dump("states").back();
  ASSERT_GT(end.x(1)[2], R);
  const double tolerance = pi * zeta * zeta * x / (2 * std::pow(1 - zeta * zeta, 1.5)) + 2 * zeta * x + x * x;
  EXPECT_NEAR(std::log(end.v(1)[2] / v0), -pi * zeta / std::sqrt(1 - zeta * zeta), tolerance);
  EXPECT_LT(end.w(1).norm() * reach, 1e-9 * v0) << "no turn out of nothing";
}

/* On one end first, at 30 degrees, without friction and damping: what is lost in flight is found in the turn.
   Tolerance: the leapfrog's second order at the stiffest, (omega_0 dt)^2, with the mass an end feels, 1/m + reach^2
   cos^2/I. */
TEST(Clump, BouncesOnOneEndWithoutLossOfEnergy) {
  Material m;
  m.normalDamping = m.tangentialDamping = m.frictionAngle = m.rollingResistance = m.twistingResistance = 0;
  const double end_mass = 1 / (1 / mass + reach * reach * 0.75 / across);
  const double x = pi / 400, dt = x / std::sqrt(4 * kn / end_mass), v0 = 0.4;
  Liggghts run;
  run.script = box(m) + plate(run) +
               insert(run, Body(), "clump", {0, 0, R + 0.5 * reach + 2e-5}, {0, 0, -v0}, Vec::Zero(),
                      fmt::format("constant {:.17g} 0 {:.17g} 0", std::cos(pi / 12), std::sin(pi / 12)), 1) +
               fmt::format("timestep {:.17g}\n{}run 6000\n", dt, dump_grains("states", 1000));
  run.must();
  const std::vector<Table> frames = run.dump("states");
  const Table& last = frames.back();
  for (std::size_t s = 0; s < 3; s++) ASSERT_EQ(last.f(s).norm(), 0) << "in flight again";
  EXPECT_GT(last.w(1).norm() * reach, 0.1 * v0) << "it turns";
  EXPECT_NEAR(energy(last) / (0.5 * mass * v0 * v0), 1, x * x);
}

// A sphere as a clump (LIGGGHTS wants two spheres: one hides in the other) against the sphere itself.
struct OneSphere {
  Sphere sphere;
  Body body() const {
    return {fmt::format("0 0 0 {:.17g}\n0 0 0 {:.17g}\n", sphere.radius, 0.5 * sphere.radius), 2, sphere.mass(),
            sphere.inertia(), sphere.inertia()};
  }
};

/* With friction, damping, rolling and twisting, obliquely on a mesh and on another clump. Tolerance: round-off, grown
   in one bounce. */
TEST(Clump, OfOneSphereIsThatSphere) {
  const Vec v(0.2, 0.1, -0.4), w(20, -10, 30);
  for (const bool pair : {false, true}) {
    Liggghts clumps, spheres;
    OneSphere one;
    one.sphere.radius = 0.004;
    const double R1 = one.sphere.radius;
    const std::string go = fmt::format("timestep 1e-6\n{}run 3000\n", dump_grains("states", 1000));
    clumps.script =
        box(Material()) + (pair ? "" : plate(clumps)) +
        insert(clumps, one.body(), "a", {0, 0, R1 + 2e-5}, v, w, "template", 1) +
        (pair ? insert(clumps, one.body(), "b", {0.001, 0, -R1}, Vec::Zero(), Vec::Zero(), "template", 2) : "") +
        "run 1\nreset_timestep 0\n" + go;
    clumps.must();
    const Table first = clumps.dump("states")[0], end = clumps.dump("states").back();
    std::vector<Sphere> start = {one.sphere};
    start[0].x = first.x(0), start[0].v = first.v(0), start[0].w = first.w(0);
    if (pair) start.push_back(one.sphere), start[1].x = first.x(2);
    spheres.script = head(spheres, start, {Material(), Material()}, 0.1) + (pair ? "" : plate(spheres)) +
                     "fix move all nve/sphere\n" + go;
    spheres.must();
    const Table plain = spheres.dump("states").back();
    ASSERT_GT(plain.v(0)[2], pair ? -0.2 : 0.1) << "it has bounced";
    for (std::size_t k = 0; k < (pair ? 2u : 1u); k++) {
      EXPECT_LT((end.x(2 * k) - plain.x(k)).norm(), 1e-9 * R1);
      EXPECT_LT((end.v(2 * k) - plain.v(k)).norm(), 1e-9 * v.norm());
      EXPECT_LT((end.w(2 * k) - plain.w(k)).norm(), 1e-9 * w.norm());
    }
  }
}

/* Twelve clumps thrown into a tray, through our loop over pairs and through LIGGGHTS' own (a stress in every row of the
   log makes it ask for the virial, which ours leaves to it). */
TEST(Clump, InOurPairLoopHasTheNumbersOfLiggghts) {
  std::string states[2];
  for (const bool general : {false, true}) {
    Liggghts run;
    std::string put = insert(run, Body(), "clump", {0, 0, 0.02}, {0, 0, -0.5}, Vec::Zero(), "random", 1);
    put.replace(put.find("1e-6 units"), 4, "0.012");
    put.replace(put.find("overlapcheck no"), 15, "overlapcheck yes");
    put.replace(put.find("in_region 1\n"), 12, "in_region 12\n");
    put.replace(put.find("maxattempt 10 "), 14, "maxattempt 1000 ");
    const std::string walls = plate(run);
    run.write("plate.stl", tray_stl(0.02));
    run.script =
        box(Material()) + walls + put + "fix down all gravity 9.81 vector 0 0 -1\n" +
        "timestep 5e-6\nrun 1\nreset_timestep 0\n" +
        (general ? "compute stress all stress/atom\ncompute sum all reduce sum c_stress[1]\nthermo_style custom step "
                   "c_sum\nthermo 1\n"
                 : "") +
        dump_grains("states", 500) + "run 10000\n";
    run.must();
    states[general] = run.read("states");
    const std::vector<Table> frames = run.dump("states");
    int touching = 0;
    for (const Table& frame : frames)
      for (std::size_t s = 0; s < frame.rows.size(); s++) touching += frame.f(s).norm() > 0;
    EXPECT_EQ(frames.back().rows.size(), 36u);
    EXPECT_GT(touching, 12);
  }
  EXPECT_EQ(states[0], states[1]);
}

/* `vielto clump` on two equal spheres r apart by d, against the solid of revolution: R(x)^2 = r^2 - (|x| - d/2)^2,
   I_axis = (pi/2) S R^4 dx, I_across = S (pi/4 R^4 + pi x^2 R^2) dx, S over its length. Tolerance of vielto_clump.h. */
TEST(ClumpCommand, GivesVolumeMassAndInertiaOfTheUnion) {
  const double r = 1, d = 1.2, D = 0.005, density = 1200;
  double volume = 0, axial = 0, transverse = 0;
  const int steps = 200000;
  for (int k = 0; k < steps; k++) {
    const double h = (d / 2 + r) / steps, x = (k + 0.5) * h, square = r * r - (x - d / 2) * (x - d / 2);
    volume += 2 * pi * square * h;
    axial += pi * square * square * h;
    transverse += 2 * (pi / 4 * square * square + pi * x * x * square) * h;
  }
  const double scale = D / std::cbrt(6 * volume / pi), m = density * pi / 6 * D * D * D;
  axial *= m / volume * scale * scale, transverse *= m / volume * scale * scale;
  Liggghts run;
  // along y, off the origin, in mm
  run.write("pair.clump", "# x y z r\n\n0.002 0.0004 -0.001 0.001\n0.002 0.0016 -0.001 0.001\n");
  run.script =
      settings_head() + fmt::format(
                            "vielto clump a pair.clump out.clump diameter {} density {}\nprint 'words ${{a}}'\nprint "
                            "'radius ${{aRadius}} of ${{aSpheres}}'\n",
                            D, density);
  const Outcome done = run.start();
  ASSERT_EQ(done.status, 0) << done.text;
  double M = 0, I[6] = {}, smallest = 0;
  int count = 0;
  const char* at = std::strstr(done.text.c_str(), "\nwords");
  ASSERT_TRUE(at) << done.text;
  ASSERT_EQ(std::sscanf(at,
                        "\nwords nspheres 2 ntry 100000 spheres file out.clump scale 1 mass %lf inertia_tensor %lf %lf "
                        "%lf %lf %lf %lf use_density",
                        &M, I, I + 1, I + 2, I + 3, I + 4, I + 5),
            7)
      << at;
  ASSERT_EQ(std::sscanf(std::strstr(done.text.c_str(), "\nradius"), "\nradius %lf of %d", &smallest, &count), 2);
  EXPECT_NEAR(M / m, 1, 1e-9);
  EXPECT_NEAR(I[3] / axial, 1, 1e-4);
  EXPECT_NEAR(I[0] / transverse, 1, 1e-4);
  EXPECT_NEAR(I[5] / transverse, 1, 1e-4);
  for (const int k : {1, 2, 4}) EXPECT_LT(std::fabs(I[k]), 1e-9 * axial);
  EXPECT_NEAR(smallest / (scale * r), 1, 1e-4);
  EXPECT_EQ(count, 2);
  std::istringstream rows(run.read("out.clump"));
  double x, y, z, radius;
  rows >> x >> y >> z >> radius;
  EXPECT_NEAR(y, -scale * d / 2, 1e-4 * scale);
  EXPECT_LT(std::fabs(x) + std::fabs(z), 1e-9);
}

// The spheres of a shipped clump span the dimensions of its card, by the rule stated in the file.
struct Span {
  std::string grain;
  double length, width, thickness;  // m, of the spheres
};

TEST(ClumpFiles, SpanTheirCardsDimensions) {
  // corn: the wedge itself. barley: to the ends of the last spheres, at 0.8 sqrt(a^2 - b^2) with r = 0.6 b; the middle
  // pair's width; twice the radius of the spheres beside it, at half that distance.
  const double a = 0.00891 / 2, b = std::sqrt(0.00330 * 0.00258) / 2;
  for (const Span& span :
       {Span{"fodder_corn", 0.01054, 0.00726, 0.00457},
        Span{"hulled_barley", 2 * (0.8 * std::sqrt(a * a - b * b) + 0.6 * b), 0.00330, 2 * b * std::sqrt(1 - 0.16)}}) {
    std::ifstream in(fmt::format("{}/materials/{}.clump", VIELTO_SOURCE_DIR, span.grain));
    Vec low = Vec::Constant(1), high = -low;
    for (std::string line; std::getline(in, line);) {
      Vec x;
      double r;
      if (line[0] == '#' || std::sscanf(line.c_str(), "%lf %lf %lf %lf", &x[0], &x[1], &x[2], &r) != 4) continue;
      low = low.cwiseMin(x - Vec::Constant(r)), high = high.cwiseMax(x + Vec::Constant(r));
    }
    // digits of the file
    EXPECT_LT((high - low - Vec(span.length, span.width, span.thickness)).norm(), 2e-7) << span.grain;
  }
}

struct Fault {
  std::string name, file;
  std::vector<std::string> words;
};
void PrintTo(const Fault& f, std::ostream* out) { *out << f.name; }
class ClumpFile : public testing::TestWithParam<Fault> {};

TEST_P(ClumpFile, IsRefusedWithOneLine) {
  Liggghts run;
  if (!GetParam().file.empty()) run.write("grain.clump", GetParam().file);
  run.script = settings_head() + "vielto clump a grain.clump out.clump diameter 0.005 density 1200\n";
  expect_refusal(run.folder / "out.clump", run.start(), GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, ClumpFile,
    testing::Values(
        Fault{"Missing", "", {"grain.clump", "cannot be read", "clump no"}},
        Fault{"ThreeNumbers", "0 0 0 0.001\n0 0 0.001\n", {"grain.clump, line 2", "not four numbers", "x y z r"}},
        Fault{"AWord", "0 0 0 0.001\n# grain\n0 x 0 0.001\n", {"grain.clump, line 3", "not four numbers"}},
        Fault{"FiveNumbers", "0 0 0 0.001 1\n", {"grain.clump, line 1", "not four numbers"}},
        Fault{"NoRadius", "0 0 0 0.001\n0 0 0.001 0\n", {"grain.clump, line 2", "radius <= 0"}},
        Fault{"Millimetres", "0 0 0 2.3\n0 0 1 2.3\n", {"grain.clump, line 1", "metres"}},
        Fault{"OneSphere", "0 0 0 0.001\n", {"grain.clump", "two spheres"}},
        Fault{"InPieces", "0 0 0 0.001\n0 0 0.003 0.001\n", {"grain.clump", "hang together"}}),
    [](const auto& one) { return one.param.name; });

}  // namespace

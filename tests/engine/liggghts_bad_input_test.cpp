// SPDX-License-Identifier: GPL-2.0-or-later
// Bad input of the contact law through `liggghts`: each ends the run with status 1 and one line that names what is
// wrong. And what is no error although LIGGGHTS' own models refuse it.
#include "contact_reference.h"

namespace {

using namespace vielto_test;

// Two grains of two types in contact; `properties` and the models' line are the test's.
std::string script(const Liggghts& run, const std::string& given, const std::string& models) {
  std::vector<Sphere> two(2);
  two[1].type = 2;
  two[1].x[0] = 0.00999;
  return settings_head() + grains(run, two, 0.05, 2) + "neighbor 0.002 bin\nneigh_modify delay 0\n" + given +
         fmt::format("pair_style gran {}\npair_coeff * *\ntimestep 1e-6\nfix move all nve/sphere\nrun 2\n", models);
}

// Properties of two types with one line replaced (or dropped, with an empty one).
std::string with(const std::string& name, const std::string& line) {
  std::istringstream in(properties({Material(), Material()}));
  std::string text;
  for (std::string given; std::getline(in, given);) {
    const bool it = given.rfind("fix " + name + " ", 0) == 0;
    text += it ? (line.empty() ? "" : line + "\n") : given + "\n";
  }
  return text;
}

void expect_error(Liggghts& run, const std::vector<std::string>& words, int ranks = 1) {
  const Outcome outcome = run.start(ranks);
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  std::istringstream in(outcome.text);
  std::vector<std::string> errors;
  for (std::string line; std::getline(in, line);)
    if (line.find("ERROR") != std::string::npos) errors.push_back(line);
  ASSERT_EQ(errors.size(), 1u) << outcome.text;
  for (const std::string& word : words)
    EXPECT_NE(errors[0].find(word), std::string::npos) << word << " in: " << errors[0];
}

// name, value below its range, value above it (empty: none)
struct Property {
  const char* name;
  const char* low;
  const char* high;
};

void PrintTo(const Property& p, std::ostream* out) { *out << p.name; }

std::string property_name(const testing::TestParamInfo<Property>& tested) { return tested.param.name; }

class BadProperty : public testing::TestWithParam<Property> {};

TEST_P(BadProperty, MissingIsNamed) {
  const std::string name = GetParam().name;
  Liggghts run;
  run.script = script(run, with(name, ""), vielto_models);
  expect_error(run, {"vielto", "property " + name + " is missing", "peratomtype"});
}

TEST_P(BadProperty, OfWrongLengthIsNamed) {
  const std::string name = GetParam().name;
  for (const std::string values : {"0.5", "0.5 0.5 0.5"}) {
    Liggghts run;
    run.script = script(run, with(name, fmt::format("fix {0} all property/global {0} peratomtype {1}", name, values)),
                        vielto_models);
    expect_error(run, {"vielto", "property " + name, "2 types"});
  }
}

TEST_P(BadProperty, GivenAsOneScalarIsNamed) {
  const std::string name = GetParam().name;
  Liggghts run;
  run.script = script(run, with(name, fmt::format("fix {0} all property/global {0} scalar 0.5", name)), vielto_models);
  expect_error(run, {"vielto", "property " + name});
}

TEST_P(BadProperty, OutOfItsRangeIsNamedWithItsTypeAndRange) {
  const Property& p = GetParam();
  for (const std::string value : {p.low, p.high}) {
    if (value.empty()) continue;
    Liggghts run;
    run.script =
        script(run, with(p.name, fmt::format("fix {0} all property/global {0} peratomtype 0.5 {1}", p.name, value)),
               vielto_models);
    expect_error(run, {"vielto", fmt::format("property {} of type 2", p.name), "out of its range"});
  }
}

// LIGGGHTS itself reads no such number, and says so before it knows the property.
TEST_P(BadProperty, NotANumberIsRefused) {
  for (const char* value : {"nan", "inf", "soft"}) {
    Liggghts run;
    run.script = script(run,
                        with(GetParam().name, fmt::format("fix {0} all property/global {0} peratomtype 0.5 {1}",
                                                          GetParam().name, value)),
                        vielto_models);
    expect_error(run, {"Expected floating point parameter"});
  }
}

INSTANTIATE_TEST_SUITE_P(
    Properties, BadProperty,
    testing::Values(Property{"youngsModulus", "0", ""}, Property{"stiffnessRatio", "0", "1.0001"},
                    Property{"frictionAngle", "-0.001", "90"}, Property{"normalDamping", "-0.001", ""},
                    Property{"tangentialDamping", "-0.001", ""}, Property{"rollingStiffnessFactor", "-0.001", ""},
                    Property{"twistingStiffnessFactor", "-0.001", ""}, Property{"rollingResistance", "-0.001", ""},
                    Property{"twistingResistance", "-0.001", ""}),
    property_name);

// The ends of the ranges are allowed, and the limits of LIGGGHTS' own models (E >= 5 MPa, nu <= 0.5) are not ViElTo's.
TEST(GoodProperty, SoftStiffAndLimitingValuesRun) {
  for (const char* line : {"youngsModulus|1", "youngsModulus|1e15", "stiffnessRatio|1", "stiffnessRatio|1e-6",
                           "frictionAngle|0", "frictionAngle|89.9", "normalDamping|0", "normalDamping|5",
                           "rollingStiffnessFactor|0", "rollingResistance|0", "twistingResistance|100"}) {
    const std::string text = line, name = text.substr(0, text.find('|')), value = text.substr(text.find('|') + 1);
    Liggghts run;
    run.script =
        script(run, with(name, fmt::format("fix {0} all property/global {0} peratomtype {1} {1}", name, value)),
               vielto_models);
    const Outcome outcome = run.start();
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.text;
  }
}

// 27 degrees in radians; 2 degrees and no friction at all are left alone.
TEST(FrictionAngle, InRadiansIsAskedAbout) {
  const std::string question = "frictionAngle of type 2 is 0.4712 degrees; is that radians? (27 degrees";
  for (const char* values : {"27 0.4712", "27 2", "0 27"}) {
    Liggghts run;
    run.script = script(run,
                        with("frictionAngle",
                             fmt::format("fix frictionAngle all property/global frictionAngle peratomtype {}", values)),
                        vielto_models);
    const Outcome outcome = run.start();
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find(question) != std::string::npos, std::string(values) == "27 0.4712") << outcome.text;
  }
}

// Two spheres: half period pi sqrt(m/2 / (4 k_n)) with k_n = 2 E R (the other modes are slower). The warning is for
// steps over a tenth of it.
TEST(TimeStepOfAnOwnScript, OverATenthOfTheHalfPeriodIsWarnedOf) {
  Material m;
  m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  m.stiffnessRatio = 0.01;
  const Sphere one{1, 0.005, 1375, {0, 0, 0}, Vec::Zero(), Vec::Zero()};
  Sphere two = one;
  two.x.x() = 0.02;
  const double tc = pi * std::sqrt(one.mass() / 2 / (8 * m.youngsModulus * one.radius));
  for (const double fraction : {0.099, 0.101}) {
    Liggghts run;
    run.script = head(run, {one, two}, {m}, 0.1) +
                 fmt::format("timestep {:.17g}\nfix move all nve/sphere\nrun 5\nrun 5\n", fraction * tc);
    const Outcome outcome = run.start();
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    const std::string words = "of the shortest half period of a contact";
    EXPECT_EQ(outcome.text.find(words) != std::string::npos, fraction > 0.1) << outcome.text;
  }
}

TEST(GrainWatch, NamesAGrainWhoseVelocityIsNoNumber) {
  const Material m;
  const Sphere one{1, 0.005, 1375, {0.01, 0, 0}, Vec::Zero(), Vec::Zero()};
  Liggghts run;
  run.script = head(run, {one}, {m}, 0.1) +
               "variable bad equal exp(1000)-exp(1000)\ntimestep 1e-6\nfix move all nve/sphere\n"
               "fix watch all vielto/watch every 1\nrun 1\nvelocity all set v_bad 0 0\nrun 1\n";
  expect_error(run, {"step 1 (start of a run)", "velocity of grain 1 is no number", "it was at (0.01 ", "likely"});
}

struct Line {
  const char* name;
  const char* models;
  std::vector<std::string> words;
};

void PrintTo(const Line& l, std::ostream* out) { *out << l.name; }

std::string line_name(const testing::TestParamInfo<Line>& tested) { return tested.param.name; }

class BadSetting : public testing::TestWithParam<Line> {};

TEST_P(BadSetting, IsNamed) {
  Liggghts run;
  run.script = script(run, properties({Material(), Material()}), GetParam().models);
  expect_error(run, GetParam().words);
}

#define VIELTO "model vielto tangential vielto rolling_friction vielto "
INSTANTIATE_TEST_SUITE_P(
    Settings, BadSetting,
    testing::Values(
        Line{"spring_factor_zero", VIELTO "springFactor 0", {"springFactor must be > 0"}},
        Line{"spring_factor_negative", VIELTO "springFactor -4", {"springFactor must be > 0"}},
        Line{"spring_factor_nan", VIELTO "springFactor nan", {"springFactor takes a number", "'nan'"}},
        Line{"wall_rolling_infinite", VIELTO "wallRolling inf", {"wallRolling takes a number", "'inf'"}},
        Line{"wall_radius_factor_zero", VIELTO "wallRadiusFactor 0", {"wallRadiusFactor must be > 0"}},
        Line{"spring_factor_decimal_comma", VIELTO "springFactor 1,5", {"springFactor takes a number", "'1,5'"}},
        Line{"wall_rolling_decimal_comma", VIELTO "wallRolling 0,27", {"wallRolling takes a number", "'0,27'"}},
        Line{"wall_radius_factor_word", VIELTO "wallRadiusFactor two", {"wallRadiusFactor takes a number", "'two'"}},
        Line{"max_overlap_percent", VIELTO "maxOverlap 5%", {"maxOverlap takes a number", "'5%'"}},
        Line{"max_overlap_percent_of_hooke",
             "model hooke/watched tangential history rolling_friction epsd2 maxOverlap 5%",
             {"maxOverlap takes a number", "'5%'"}},
        Line{"max_overlap_negative", VIELTO "maxOverlap -0.1", {"maxOverlap must be from 0"}},
        Line{"max_overlap_as_a_percentage", VIELTO "maxOverlap 5", {"maxOverlap must be from 0", "part of"}},
        Line{"max_overlap_as_a_percentage_of_hooke",
             "model hooke/watched tangential history rolling_friction epsd2 maxOverlap 5",
             {"maxOverlap must be from 0", "part of"}},
        Line{"limit_force_maybe", VIELTO "limitForce maybe", {"limitForce"}},
        Line{"sliding_dashpot_number", VIELTO "slidingDashpot 1", {"slidingDashpot"}},
        Line{"unknown_setting", VIELTO "springfactor 4", {"springfactor"}},
        // a third of ViElTo has no meaning
        Line{"other_normal_model", "model hooke tangential vielto", {"go with a normal model of this package"}},
        Line{"other_tangential_model",
             "model vielto tangential history",
             {"vielto does not take these partners", "model vielto tangential vielto"}},
        Line{"normal_model_alone", "model vielto", {"does not take these partners"}},
        Line{"other_cohesion",
             "model hooke/watched tangential history cohesion adhesion rolling_friction epsd2",
             {"hooke/watched does not take these partners", "[cohesion sjkr|sjkr2]"}},
        Line{"rolling_without_its_normal_model",
             "model hooke tangential history rolling_friction vielto",
             {"go with a normal model of this package"}}),
    line_name);
#undef VIELTO

TEST(BadPropertyOnTwoRanks, IsNamedOnce) {
  Liggghts run;
  run.script = script(run, with("normalDamping", ""), vielto_models);
  expect_error(run, {"property normalDamping is missing"}, 2);
}

// ---- the script command ----

// The half period against its formula: normal mode of the stiffest pair, wall included; k_n = 2 E R for a pair, 8/3 E R
// on a wall, but m_eff = m/2 and m: the pair is the faster one. Rolling and twisting off, little tangential stiffness.
TEST(HalfPeriodCommand, SetsTheVariable) {
  Liggghts run;
  Material m;
  m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  m.stiffnessRatio = 0.01;
  run.script =
      head(run, {Sphere()}, {m}, 0.05) + "vielto half_period tc radius 0.003 density 1400\nprint \"tc=${tc}.\"\n";
  const Outcome outcome = run.start();
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const std::size_t at = outcome.text.rfind("tc=");
  ASSERT_NE(at, std::string::npos);
  const double mass = 1400 * 4.0 / 3 * pi * 2.7e-8;
  EXPECT_NEAR(std::stod(outcome.text.substr(at + 3)) / (pi * std::sqrt(mass / 2 / (4 * 2e6 * 0.003))), 1,
              1e-11);  // printed with 12 digits
}

TEST(ViEltoCommand, ErrorStopsWithItsWords) {
  Liggghts run;
  run.script = head(run, {Sphere()}, {Material()}, 0.05) + "vielto error speed is -1 1/s; give more\n";
  expect_error(run, {"speed is -1 1/s; give more"});
}

TEST(ViEltoCommand, UnknownFormIsAnError) {
  for (const char* form : {"vielto", "vielto nonsense", "vielto half_period tc radius 0.003",
                           "vielto half_period tc diameter 1 density 2", "vielto half_period tc radius -1 density 2"}) {
    Liggghts run;
    run.script = head(run, {Sphere()}, {Material()}, 0.05) + form + "\n";
    expect_error(run, {"vielto:"});
  }
}

TEST(ViEltoCommand, HalfPeriodBeforeThePairStyleIsAnError) {
  Liggghts run;
  run.script = settings_head() + grains(run, {Sphere()}, 0.05) + properties({Material()}) +
               "vielto half_period tc radius 0.003 density 2\n";
  expect_error(run, {"needs 'pair_style gran model vielto"});
}

TEST(ViEltoCommand, RepeatsUntilItsVariableIsNotZero) {
  Liggghts run;
  run.script = head(run, {Sphere()}, {Material()}, 0.05) +
               "variable k equal 0\nvariable enough equal v_k>2\n"
               "vielto repeat 9 \"variable k equal %\" \"print 'time ${k}, enough ${enough}'\" until enough\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  for (const char* line : {"\ntime 1, enough 0\n", "\ntime 2, enough 0\n", "\ntime 3, enough 1\n"})
    EXPECT_NE(outcome.text.find(line), std::string::npos) << line << outcome.text;
  EXPECT_EQ(outcome.text.find("\ntime 4"), std::string::npos);
}

// LIGGGHTS refuses include within its own `if`.
TEST(ViEltoCommand, IncludesAFileUnlessTheNumberIsZero) {
  Liggghts run;
  run.write("bed.in", "print 'a bed of ${k}'\n");
  run.script = head(run, {Sphere()}, {Material()}, 0.05) +
               "variable k equal 0\nvielto include bed.in if ${k}\n"
               "variable k equal 2\nvielto include bed.in if ${k}\nprint 'and on'\n";
  const Outcome outcome = run.start();
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("\na bed of 2\nand on\n"), std::string::npos) << outcome.text;
  EXPECT_EQ(outcome.text.find("\na bed of 0"), std::string::npos);
}

TEST(ViEltoCommand, IncludeWithoutIfIsAnError) {
  Liggghts run;
  run.script = head(run, {Sphere()}, {Material()}, 0.05) + "vielto include bed.in unless 1\n";
  expect_error(run, {"vielto include FILE if NUMBER"});
}

TEST(ViEltoCommand, RepeatUntilAnUnknownVariableIsAnError) {
  Liggghts run;
  run.script = head(run, {Sphere()}, {Material()}, 0.05) + "vielto repeat 9 \"run 1\" until nothing\n";
  expect_error(run, {"repeat until nothing", "no such equal-style variable"});
}

}  // namespace
